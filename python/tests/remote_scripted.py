"""A remote hand without a network: the test makes every State and every Answer, and reads every Target."""

import struct
import time
import types

import numpy
from remote_double import read_target, status

import sun2xp
import sun2xp.remote
from sun2xp.remote import _messages
from sun2xp.remote._owner import Sender

#: The server's clock at the beginning, ns.
BEGIN = 1_000_000_000_000

#: A set point, rad.
HOME = [0.0, 0.6, 0.9]

#: A millisecond and a second, ns.
MS, S = 1_000_000, 1_000_000_000


def holds(hand, finger=1, condition="applied"):
    """Returns whether a wait for the condition ends at once."""
    try:
        hand.wait(finger, condition, timeout=0)
    except sun2xp.TimedOut:
        return False
    return True


class _Timeless(Sender):
    """A Sender without the thread that repeats the Targets."""

    def add(self, owner):
        self._owners.append(owner)


class Scripted:
    """The network and the server of one hand."""

    forked = False

    def __init__(self):
        self.client, self.endpoint, self.sender = "planner", "nowhere", _Timeless()
        #: The server's clock, ns; the number of the newest State; and the number of the epoch in force.
        self.now, self.states, self.number = BEGIN, 0, 0
        #: The content of the Status, as arguments of `status`.
        self.status = {}
        #: The code of every Answer to a Request.
        self.code = 0
        #: `gets` has the action of every Request, and None for every get of the Status. `unanswered` is the number of
        #: further gets that will receive no reply.
        self.gets, self.unanswered = [], 0
        #: The sequence number and the parts of every Target.
        self.targets = []
        self.records = numpy.zeros(3, _messages.RECORD)
        self.records["finger"] = [1, 2, 3]
        self.records["stage"] = _messages.STAGES.index("running")
        self._subscribers = {}
        self.hand = sun2xp.remote.RemoteHand(self, "hand", stale=10.0)
        #: The time since the newest message, s. A test sets it instead of waiting.
        self.silence = 0.0
        self.hand._receiver.silence = lambda: self.silence
        self.hand.acquire()

    def get(self, key, payload, _timeout):
        self.gets.append(None if payload is None else key.split("/")[2])
        if self.unanswered:
            self.unanswered -= 1
            return []
        if payload is None:
            return [(key, status(**self.status))]
        if payload[2] == _messages.ACTIONS["acquire"]:
            self.number += 1
        return [(key, self.answer(self.code, self.number))]

    def put(self, _key, payload):
        _, _, sequence, _, _, parts = read_target(payload)
        self.targets.append((sequence, parts))

    def subscriber(self, key, take):
        self._subscribers[key.split("/")[2]] = take
        if key.endswith("/state"):
            self.state()
        return types.SimpleNamespace(undeclare=lambda: None)

    def forget(self, _hand):
        pass

    def answer(self, code, number, text=""):
        """The bytes of an Answer."""
        data = text.encode()
        return struct.pack("<BBHIQQQH", 6, 1, code, 100, 1000 + self.number, self.now, number, len(data)) + data

    def state(self, after=5 * MS, owner=None, fingers=(1, 2, 3)):
        """Publishes a State `after` ns later, with a new cycle of these fingers."""
        self.now += after
        self.states += 1
        owner = self.number if owner is None else owner
        fresh = numpy.isin(self.records["finger"], fingers)
        self.records["cycle"][fresh] += 1
        self.records["time"][fresh] = self.now
        # Every State contains the newest cycle of a finger that has stopped.
        sent = self.records[fresh | (self.records["stage"] == _messages.STAGES.index("faulted"))]
        head = struct.pack("<BBHIQQQ", 2, 1, len(sent), 0, self.states, self.now, owner)
        self._subscribers["state"](head + sent.tobytes())

    def refuse(self, sequence, text="out of reach"):
        """Refuses a Target."""
        self._subscribers["refused"](self.answer(6, sequence, text))

    def target(self):
        """Lets the owner send a Target. Returns its parts."""
        self.hand.owner.publish(time.monotonic_ns())
        return self.targets[-1][1]

    def command(self, finger=1):
        """Returns command number, place, bits and values of the only part for a finger in the newest Target."""
        [(_, command, place, bits, _, values)] = [part for part in self.targets[-1][1] if part[0] == finger]
        return command, place, bits, values

    def apply(self):
        """Applies the parts of the newest Target, and publishes a State."""
        for part in self.targets[-1][1]:
            self.records["command"][part[0] - 1] = part[1]
        self.state()

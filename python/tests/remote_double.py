"""A server without a hand, written from docs/remote-protocol.md. A test can make it refuse, fall silent, or give the
hand to somebody else. A real server rarely does these things."""

import json
import struct
import threading
import time

import numpy
import zenoh

from sun2xp.remote import _messages

STATUS = struct.Struct("<BBBxIIIQ3d8Q")
FINGER = struct.Struct("<BxHIQQQQ3d3dddB71s")
TARGET = struct.Struct("<BBBxIQQQQ")
#: The beginning of the text of a fault that a Status contains: 71 bytes, here cut in the middle of a word.
LOST = b"lost replies (17 ms): the board has sent no valid reply for too long; t"
PART = struct.Struct("<BBBBI3d9dd")


def answer(code, epoch, number=0, text=""):
    """The bytes of an Answer."""
    data = text.encode()
    return struct.pack("<BBHIQQQH", 6, 1, code, 100, epoch, time.monotonic_ns(), number, len(data)) + data


def status(turn=0.5, fault=0):
    """The bytes of the Status of a hand with three fingers. Joint 0 turns by at most `turn`, rad, to both sides. Finger
    2 has the fault with the number `fault`, or none if this number is 0."""
    head = STATUS.pack(4, 1, 7, 100, 10_000, 1, time.monotonic_ns(), 1000.0, 10.0, 1.0, *range(8))
    numbers = (5, 0, 0, 0, -turn, 0.0, 0.0, turn, 1.5, 1.5, 4.0, 0.0)
    finger = FINGER.pack(3, 0, 0, *numbers, 0, b"")
    second = FINGER.pack(6, fault, 0, *numbers, len(LOST), LOST) if fault else finger
    return head + finger + second + finger + b"\x07planner"


def read_target(data):
    """Returns validity, epoch, sequence number, time sent, time seen and parts of a Target."""
    _, _, count, validity, epoch, sequence, sent, seen = TARGET.unpack_from(data)
    parts, offset = [], TARGET.size
    for _ in range(count):
        finger, place, bits, poses, command, *values = PART.unpack_from(data, offset)
        offset += PART.size + 32 * poses
        parts.append((finger, command, place, bits, poses, values))
    assert offset == len(data)
    return validity, epoch, sequence, sent, seen, parts


class Double:
    """A hand with fingers 1 to 3 that takes every set point at once, or refuses it with `refusal`."""

    def __init__(self, endpoint, name="hand", settings=None):
        """Listens at the endpoint, or connects as `settings` say."""
        alone = {"mode": "router", "listen": {"endpoints": [endpoint]}, "scouting": {"multicast": {"enabled": False}}}
        settings = settings or alone
        self.session = zenoh.open(zenoh.Config.from_json5(json.dumps(settings)))
        self.prefix = f"sun2xp/{name}/"
        self.lock = threading.RLock()
        #: The epoch in force, or 0 if there is no owner; and the number of the newest epoch.
        self.epoch, self.number = 0, 0
        #: (sent, seen, validity, parts) of every Target with the epoch in force.
        self.targets = []
        #: (action, finger, bits) of every Request.
        self.requests = []
        #: The reason why set points are refused; None if they are not.
        self.refusal = None
        #: The code of every Answer to a permitted release, recover, calibrate, identify or stop.
        self.code = 0
        self.publishing = True
        self.records = numpy.zeros(3, _messages.RECORD)
        self.records["finger"] = [1, 2, 3]
        self.records["stage"] = _messages.STAGES.index("running")
        self._states = 0
        self._events = 0
        self._ends = threading.Event()
        declare = self.session.declare_queryable
        self.declared = [
            declare(f"{self.prefix}status", lambda query: query.reply(f"{self.prefix}status", status())),
            *[declare(f"{self.prefix}{action}/*", self._take_request) for action in _messages.ACTIONS],
            self.session.declare_subscriber(f"{self.prefix}target/*", self._take_target),
        ]
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._ends.set()
        self._thread.join()
        self.session.close()

    def put_event(self, finger, kind, cycle):
        """Publishes an Event."""
        self._events += 1
        numbers = (finger, 0, kind, self._events, cycle, time.monotonic_ns())
        self.session.put(f"{self.prefix}events", struct.pack("<BBBBHxxQQQ4d", 3, 1, *numbers, 0, 0, 0, 0))

    def put_state(self):
        """Publishes a State with the next cycle of every finger."""
        with self.lock:
            self._states += 1
            now = time.monotonic_ns()
            self.records["cycle"] += 1
            self.records["time"] = now
            head = struct.pack("<BBHIQQQ", 2, 1, 3, 0, self._states, now, self.number if self.epoch else 0)
            self.session.put(f"{self.prefix}state", head + self.records.tobytes())

    def _run(self):
        while not self._ends.wait(0.01):
            if self.publishing:
                self.put_state()

    def _take_request(self, query):
        _, _, action, finger, bits, epoch = struct.unpack("<BBBBB3xQ", bytes(query.payload))
        with self.lock:
            self.requests.append((action, finger, bits))
            number = 0
            if action == 1 and self.epoch and not bits & 1:
                reply = answer(4, 0, text="screen owns the hand")
            elif action == 1:
                self.number += 1
                self.epoch, number = self.number * 1000 + 7, self.number
                self.records["command"] = 0
                reply = answer(0, self.epoch, number)
            elif action != 6 and epoch != self.epoch:
                reply = answer(5, epoch, text="an old epoch")
            else:
                self.epoch = 0 if action == 2 else self.epoch
                reply = answer(self.code, epoch, text="a reason" if self.code else "")
        query.reply(query.key_expr, reply)

    def _take_target(self, sample):
        validity, epoch, sequence, sent, seen, parts = read_target(bytes(sample.payload))
        with self.lock:
            if epoch != self.epoch:
                return
            self.targets.append((sent, seen, validity, parts))
            fresh = [part for part in parts if self.records["command"][part[0] - 1] != part[1]]
            if fresh and self.refusal is not None:
                client = str(sample.key_expr).rsplit("/", 1)[1]
                self.session.put(f"{self.prefix}refused/{client}", answer(6, epoch, sequence, self.refusal))
                return
            for finger, command, place, _, _, values in fresh:
                self.records["command"][finger - 1] = command
                if place == 1:
                    self.records["joints"][finger - 1] = values[:3]
                    self.records["joint_set_point"][finger - 1] = values[:3]

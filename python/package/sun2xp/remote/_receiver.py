"""What a hand publishes: the newest state of every finger and the events of the hand. State, Event and Answer are
messages of docs/remote-protocol.md."""

from __future__ import annotations

import collections
import math
import threading
import time
from typing import Callable, Deque, Dict, List, Optional, Tuple

import numpy
import numpy.typing

from .._errors import ErrorNumber
from .._types import Event, EventKind
from . import _messages
from ._errors import Stale
from ._messages import STAGES, State

#: Number of States that are kept for `Receiver.take`: 5 s, because the server publishes a State every 5 ms.
_KEPT_STATES = 1000

#: Number of events that a queue keeps.
_KEPT_EVENTS = 4096

#: Largest relative difference between the rates of two clocks.
_DRIFT = 1e-3

#: If the time of an Answer is earlier than that of the newest State by more than this, ns, the server's machine was
#: started again. The Answer cannot have been on its way for so long.
_RESTARTED = 10_000_000_000

#: Number of values of an event of each kind (docs/events.md). The message Event always has four.
VALUES = {
    EventKind.TOUCH_MADE: 2,
    EventKind.TOUCH_LOST: 2,
    EventKind.TOUCH_SLIP: 2,
    EventKind.TOUCH_PRESSURE: 2,
    EventKind.CONTACT: 3,
    EventKind.CONTACT_LOST: 3,
    EventKind.SLIP: 3,
    EventKind.TENSION_BOUND: 2,
    EventKind.FORCE_BOUND: 4,
    EventKind.JOINT_AT_LIMIT: 2,
    EventKind.ARRIVED: 3,
    EventKind.SETTLED: 3,
    EventKind.FAULT: 2,
    EventKind.WARNING: 2,
    EventKind.REFLEX_FIRED: 1,
    EventKind.PATH_ENDED: 3,
    EventKind.EXPIRED: 1,
    EventKind.TOUCH_INVALID: 1,
}

#: The kind of part that a fault or warning concerns, if it does not concern the whole finger (docs/faults.md).
FAULT_PARTS = {
    1: "tendon",
    2: "tendon",
    3: "tendon",
    4: "gauge",
    5: "gauge",
    6: "gauge",
    7: "encoder",
    8: "motor",
    9: "motor",
    10: "joint",
    11: "joint",
    12: "tendon",
    45: "motor",
}

Records = numpy.typing.NDArray[numpy.void]


def _part(kind: EventKind, number: int, values: Tuple[float, ...]) -> str:
    parts = {EventKind.TENSION_BOUND: "tendon", EventKind.JOINT_AT_LIMIT: "joint"}
    part = parts.get(kind)
    if kind in (EventKind.FAULT, EventKind.WARNING):
        part = FAULT_PARTS.get(int(values[0])) if math.isfinite(values[0]) else None
    # The number 0 means joint 0 or the whole finger. The other parts are numbered from 1.
    if part == "joint" or (part and number):
        return f"{part} {number}"
    # A newer server may report a fault that FAULT_PARTS does not list.
    return f"part {number}" if number else "finger"


class Receiver:
    """The newest data of one hand. Its methods may be called from several threads."""

    def __init__(self) -> None:
        self.changed = threading.Condition()
        #: The newest time of the server's clock that has arrived, ns: *seen* of the protocol.
        self.seen = 0
        #: The local time at which the newest State or Answer has arrived, ns.
        self._heard = time.monotonic_ns()
        #: Number of times that the server's clock has started anew, because its machine was started again.
        self.restarts = 0
        #: Cycles that the server has not sent, and States that have not arrived.
        self.missing = [0, 0]
        self.closed = False
        #: Whether this process is a child of the one that receives.
        self.forked = False
        self._newest: Dict[int, numpy.void] = {}
        self._states: Deque[Records] = collections.deque(maxlen=_KEPT_STATES)
        self._queues: List[Deque[Event]] = []
        self._number = 0
        self._published = 0
        #: Smallest difference between the local time at which a State arrived and its time of publication, ns.
        self._offset: Optional[float] = None
        self._arrived = 0

    def state(self, data: bytes) -> Optional[State]:
        """Takes a State. Returns None if it is malformed. Call `notify` when the State is processed."""
        state = _messages.read_state(data)
        with self.changed:
            if state is None:
                return None
            # States arrive in the order of their times. If a time does not rise, the server's clock has started anew.
            if state.published <= self._published:
                self._restart()
            self._note_time(state.published)
            # A server that was started again counts its States from 1, so a lower number is not a gap.
            if 0 < self._number < state.number:
                self.missing[1] += state.number - self._number - 1
            self.missing[0] += state.missing
            self._number, self._published = state.number, state.published
            for finger in (1, 2, 3):
                self._note_finger(finger, state.records[state.records["finger"] == finger])
            self._states.append(state.records)
        return state

    def _note_finger(self, finger: int, records: Records) -> None:
        if len(records) == 0:
            return
        self._newest[finger] = records[-1]

    def notify(self) -> None:
        """Wakes the waiting threads, so that they check their conditions again."""
        with self.changed:
            self.changed.notify_all()

    def _restart(self) -> None:
        """Forgets what depends on the server's clock, which has started anew."""
        self.restarts += 1
        self._number = self._published = self.seen = 0
        self._offset = None
        self._newest.clear()

    def _note_time(self, published: int) -> None:
        now = time.monotonic_ns()
        offset: float = now - published
        if self._offset is not None:
            offset = min(offset, self._offset + _DRIFT * (now - self._arrived))
        self._offset, self._arrived, self._heard = offset, now, now
        self.seen = max(self.seen, published)

    def answered(self, published: int) -> None:
        """Takes the time of an Answer."""
        with self.changed:
            if published < self._published - _RESTARTED:
                self._restart()
            self._heard = time.monotonic_ns()
            self.seen = max(self.seen, published)

    def event(self, data: bytes) -> None:
        """Takes an Event. An Event of an unknown kind comes from a newer server, and is ignored."""
        message = _messages.read_event(data)
        if message is None:
            return
        try:
            kind = EventKind(message.kind)
        except ValueError:
            return
        part = _part(kind, message.part, message.values)
        text = f"finger {message.finger}, {part}: {kind.name.lower().replace('_', ' ')}"
        values = message.values[: VALUES[kind]]
        event = Event(message.finger, message.cycle, message.time, kind, part, values, text)
        with self.changed:
            for queue in self._queues:
                queue.append(event)
            self.changed.notify_all()

    def queue(self) -> Deque[Event]:
        """Returns a queue that gets every event from now on."""
        queue: Deque[Event] = collections.deque(maxlen=_KEPT_EVENTS)
        with self.changed:
            self._queues.append(queue)
        return queue

    def forget(self, queue: Deque[Event]) -> None:
        """Ends a queue."""
        with self.changed:
            self._queues = [other for other in self._queues if other is not queue]

    def leave(self) -> None:
        """Ends the waits in a child of `os.fork`. Replaces the lock, because a thread of the parent may have held it at
        the fork."""
        self.changed, self.closed, self.forked = threading.Condition(), True, True

    def close(self) -> None:
        """Ends the waits of other threads."""
        with self.changed:
            self.closed = True
            self.changed.notify_all()

    def silence(self) -> float:
        """Returns the time since the newest State or Answer has arrived, s. Does not lock `changed`, because a caller
        may hold the lock of the Sender, and a wait takes these two locks in the opposite order."""
        return (time.monotonic_ns() - self._heard) * 1e-9

    def age(self) -> float:
        """Returns a lower bound of the age of the newest State, s. The clock of the server has an unknown offset, so
        the State that arrived fastest counts as having arrived without delay."""
        with self.changed:
            if self._offset is None:
                return float("inf")
            return (time.monotonic_ns() - self._offset - self._published) * 1e-9

    def _age_of(self, record: numpy.void) -> float:
        # A finger that has faulted has no new cycles, but the server repeats the newest one.
        if STAGES[record["stage"]] == "faulted":
            return self.age()
        return self.age() + (self._published - int(record["time"])) * 1e-9

    def newest(self, finger: int, stale: float) -> numpy.void:
        """Returns the newest record of a finger.

        Raises:
            Stale: the record is older than `stale` s, or no record of the finger has arrived.
        """
        with self.changed:
            record = self._newest.get(finger)
            age = self.age() if record is None else self._age_of(record)
        if record is None or age > stale:
            remedy = "check the line and sun2xp serve"
            text = f"no state of finger {finger} has arrived yet: {remedy}"
            if record is not None:
                known = f"the state of finger {finger} is {age * 1e3:.0f} ms old, and {stale * 1e3:.0f} ms are allowed"
                text = f"{known}: {remedy}, or allow older data with the argument `stale`"
            raise Stale(text, number=ErrorNumber.TIMED_OUT)
        return record

    def faults(self) -> Dict[int, int]:
        """Returns the number of the fault in the newest record of each finger, or 0 if the finger has no fault."""
        with self.changed:
            return {finger: int(record["fault"]) for finger, record in self._newest.items()}

    def take(self) -> List[Records]:
        """Returns the records of the States that have arrived since the last call."""
        with self.changed:
            taken = list(self._states)
            self._states.clear()
        return taken

    def wait_for(self, holds: Callable[[], object], timeout: Optional[float]) -> bool:
        """Waits until `holds` returns a true value, the hand is closed, or `timeout` s have passed. Returns whether
        `holds` then returns a true value."""
        with self.changed:
            return bool(self.changed.wait_for(lambda: holds() or self.closed, timeout)) and bool(holds())

"""The part of a remote hand that reads. It needs no ownership. State, Status, Request and Answer are messages of
docs/remote-protocol.md."""

from __future__ import annotations

import time
from typing import Any, List, Optional, Tuple, Union, overload

import numpy

from .._errors import Closed, ErrorNumber, Refused
from .._types import Array
from . import _messages
from ._errors import NoAnswer, forked
from ._events import RemoteEvents
from ._messages import STAGES
from ._network import ANSWER_TIME, ATTEMPTS, NOBODY, PAUSE, Network
from ._receiver import Receiver, Records
from ._types import FingerState, FingerStatus, Status, Tip, status


class Reading:
    """The calls of RemoteHand that read."""

    def __init__(self, network: Network, name: str, *, stale: float) -> None:
        self._network = network
        self._stale = stale
        self._prefix = f"sun2xp/{name}/"
        self._receiver = Receiver()
        self._closed = False
        #: Name of the hand.
        self.name = name
        self._status = self._ask_status()

    @property
    def fingers(self) -> List[int]:
        """The numbers of the fingers that the hand has."""
        return sorted(self._status.fingers)

    @property
    def closed(self) -> bool:
        """Whether `close` was called, or this process was forked from the one that has opened the hand."""
        return self._closed or self._network.forked

    @property
    def missing(self) -> tuple:
        """The number of cycles that the server has not sent, because it was late, and the number of State messages that
        have not arrived."""
        return tuple(self._receiver.missing)

    def state(self, finger: int) -> FingerState:
        """Returns the newest cycle of a finger.

        Raises:
            Stale: the newest cycle is too old, or none has arrived.
        """
        record = self._record(finger)
        set_point = record["joint_set_point"].copy()
        return FingerState(
            finger=finger,
            cycle=int(record["cycle"]),
            time=int(record["time"]),
            stage=STAGES[record["stage"]],
            fault=int(record["fault"]),
            command=int(record["command"]),
            caught=bool(record["bits"] & _messages.CAUGHT),
            touching=bool(record["bits"] & _messages.TOUCHING),
            position=record["joints"].copy(),
            set_point=None if numpy.isnan(set_point).any() else set_point,
            tip=record["tip"].copy(),
            force=record["tip_force"].copy(),
            tensions=record["tensions"].copy(),
        )

    def position(self, finger: int) -> Array:
        """Returns the joint angles, rad: shape (3,). Errors are those of `state`."""
        return self._record(finger)["joints"].copy()

    def tip(self, finger: int) -> Tip:
        """Returns position, force and tensions of a fingertip. Errors are those of `state`."""
        state = self.state(finger)
        return Tip(state.tip, state.force, state.tensions, state.touching)

    def cycles(self) -> Records:
        """Returns the cycles that have arrived since the last call, in the order of their arrival: an array with the
        fields of a record of State (docs/remote-protocol.md). It has at most the cycles of the last 1000 States."""
        if self._network.forked:
            raise forked()
        taken = self._receiver.take()
        return numpy.concatenate(taken) if taken else numpy.zeros(0, _messages.RECORD)

    @overload
    def status(self, finger: None = None) -> Status: ...
    @overload
    def status(self, finger: int) -> FingerStatus: ...

    def status(self, finger: Optional[int] = None) -> Union[Status, FingerStatus]:
        """Asks the server for the status of the hand, or of one finger.

        Raises:
            NoAnswer: the server does not answer.
        """
        self._check(*([] if finger is None else [finger]))
        self._status = self._ask_status()
        return self._status if finger is None else self._status.fingers[finger]

    def events(self) -> RemoteEvents:
        """Returns a queue that gets the hand's events from now on. `for event in hand.events()` waits for each
        event."""
        self._check()
        return RemoteEvents(self._receiver)

    def _check(self, *fingers: int) -> None:
        if self._network.forked:
            raise forked()
        if self._closed:
            raise Closed("the hand is closed: open it again", number=ErrorNumber.NO_HAND)
        for finger in fingers:
            # A float can equal the number of a finger, but the messages need an integer.
            if not hasattr(finger, "__index__") or finger not in self._status.fingers:
                remedy = f'the hand "{self.name}" has the fingers {self.fingers}'
                raise Refused(f"there is no finger {finger!r}: {remedy}", number=ErrorNumber.ARGUMENT)

    def _record(self, finger: int) -> Any:
        self._check(finger)
        return self._receiver.newest(finger, self._stale)

    def _ask_status(self) -> Status:
        for _, payload in self._answers(f"{self._prefix}status", None, ANSWER_TIME):
            message = _messages.read_status(payload)
            if message is not None:
                return status(message)
        raise self._no_answer("status")

    def _fault_name(self, finger: int) -> str:
        """Returns the name of the fault of a finger, with the affected part and its value; empty if they are not
        known."""
        try:
            # The text of a fault begins with name, part and value, which end at the first colon. The Status contains
            # only the first 71 bytes of the text, so the colon may be missing.
            name, colon, _ = self._ask_status().fingers[finger].fault_text.partition(": ")
        except NoAnswer:
            # The caller knows the number of the fault from the State.
            return ""
        return name if colon else ""

    def _stopped(self, finger: int) -> Tuple[int, int]:
        """Returns the finger that an Answer with the code FAULTED concerns, and the number of its fault. `finger` is
        the finger of the Request; 0 stands for the first finger that has stopped. If the fault is not known, for
        example because the finger has been recovered since, returns `finger` and 0."""
        try:
            faults = {number: status.fault for number, status in self._ask_status().fingers.items()}
        except NoAnswer:
            faults = self._receiver.faults()
        stopped = [number for number in sorted(faults) if faults[number] and finger in (0, number)]
        return (stopped[0], faults[stopped[0]]) if stopped else (finger, 0)

    def _answers(self, key: str, payload: Optional[bytes], timeout: float) -> List[tuple]:
        """Sends a get (a query of Zenoh), and returns its answers. Repeats a get that has reached nobody: just after a
        client has connected, Zenoh may not know the way to the server yet."""
        for _ in range(ATTEMPTS - 1):
            begun = time.monotonic()
            answers = self._network.get(key, payload, timeout)
            if answers or time.monotonic() - begun > NOBODY:
                return answers
            time.sleep(PAUSE)
        return self._network.get(key, payload, timeout)

    def _no_answer(self, asked: str) -> NoAnswer:
        where = f"the client {self._network.client} over {self._network.endpoint}"
        remedy = "check that sun2xp serve runs, and check the names of the hand and the client, and [serve.clients]"
        text = f'the hand "{self.name}" has not answered the request `{asked}` of {where}: {remedy}'
        return NoAnswer(text, number=ErrorNumber.TIMED_OUT)

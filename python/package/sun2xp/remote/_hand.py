"""A hand on another machine. Target, State, Request and Answer are messages of docs/remote-protocol.md."""

from __future__ import annotations

import functools
import time
from typing import Iterable, List, Optional, Sequence, Union

import numpy.typing

from .._errors import Error, ErrorNumber, Fault, Refused, TimedOut
from .._types import SetPoint
from . import _messages, _parts
from ._errors import FAULTED, error_of, forked
from ._messages import STAGES, Answer, Part
from ._network import ANSWER_TIME, Network
from ._owner import Owner
from ._reading import Reading

#: If no State arrives for this time, s, or for `stale` if that is longer, a wait raises Stale.
_PAUSE = 1.0

#: Longest time of a recovery, s.
_RECOVERY_TIME = 30.0

#: Longest time of a calibration, s.
_CALIBRATION_TIME = 600.0

#: The bits that a finger's record must have for each condition of `wait`.
_CONDITIONS = {"applied": 0, "arrived": _messages.ARRIVED, "settled": _messages.SETTLED}


class RemoteHand(Reading):
    """A hand that `sun2xp serve` offers, from `sun2xp.remote.open` or `Network.open`.

    The calls have the names of `sun2xp.Hand`. Calls that send something do so without delay and return at once. A
    thread repeats the newest target, the message with the set points, every 20 ms. If the server refuses a set point,
    the next call that sends to the same finger or waits for it raises Refused with the reason. The fingers then keep
    the set points that they had before.

    If this process is killed, is stopped or loses the line, the server holds the fingers after 0.1 s and brings them to
    their end states after 1 s, unless it is configured otherwise. A process that ends normally closes the hand.

    All methods may be called from several threads. Leaving a `with` block closes the hand.
    """

    def __init__(self, network: Network, name: str, *, stale: float, owns_network: bool = False) -> None:
        super().__init__(network, name, stale=stale)
        self._owns_network = owns_network
        self._owner = Owner(functools.partial(network.put, f"{self._prefix}target/{network.client}"), self._receiver)
        self._declared = [
            network.subscriber(f"{self._prefix}state", self._take_state),
            network.subscriber(f"{self._prefix}events", self._receiver.event),
            network.subscriber(f"{self._prefix}refused/{network.client}", self._take_refusal),
        ]
        network.sender.add(self._owner)
        # The protocol requires a State at least every 10 ms.
        self._receiver.wait_for(lambda: self._receiver.age() < float("inf"), ANSWER_TIME)

    def __enter__(self) -> "RemoteHand":
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @property
    def owned(self) -> bool:
        """Whether this client commands the hand, as far as it knows."""
        return self._epoch() != 0

    def acquire(self, *, take_over: bool = False, recover: bool = False) -> None:
        """Makes this client the one that commands the hand.

        Args:
            take_over: whether to take the hand from another client that commands it. That client then gets NotOwner.
            recover: whether to recover the fingers that have stopped.

        Raises:
            NotOwner: another client commands the hand, or [serve.clients] of the server does not permit this client to
                command it. (If the server uses TLS, a client without this permission gets NoAnswer instead.)
            Fault: a finger has a fault whose cause is still there.
        """
        # The server may have been started again with other limits, so its status is read again.
        self.status()
        answer = self._request("acquire", 0, timeout=_RECOVERY_TIME, take_over=take_over, recover=recover)
        with self._network.sender.lock:
            self._owner.begin(answer, self._status.end)
            self._owner.publish(time.monotonic_ns())

    def release(self) -> None:
        """Gives the hand back. Every finger goes to its end state."""
        if self._network.forked:
            raise forked()
        with self._network.sender.lock:
            epoch = self._owner.epoch
            self._owner.end()
        if epoch:
            self._request("release", 0, epoch)

    def close(self) -> None:
        """Releases the hand if this client commands it, and stops receiving. Every finger of a released hand goes to
        its end state."""
        if self.closed:
            return
        self._closed = True
        try:
            self.release()
        except Error:
            # If the owner sends no more Targets, the server brings the fingers to their end states by itself.
            pass
        finally:
            # Ctrl-C ends the wait for the answer, but the hand is closed nevertheless.
            self._disconnect()

    def _disconnect(self) -> None:
        self._network.sender.remove(self._owner)
        self._receiver.close()
        self._network.forget(self)
        try:
            for declared in self._declared:
                declared.undeclare()
        finally:
            if self._owns_network:
                self._network.close()

    def send_position(self, finger: int, position: numpy.typing.ArrayLike) -> None:
        """Sends the joint angles at which the finger shall be, rad: shape (3,).

        Raises:
            Refused: the angles are outside the limits, or an earlier command of this finger was refused.
            NotOwner: this client does not command the hand.
        """
        self.send_group([SetPoint(finger, position=position)])

    def send_tip(self, finger: int, tip: numpy.typing.ArrayLike) -> None:
        """Sends the position of the tip in the finger's frame, cm: shape (3,). Errors are those of `send_position`."""
        self.send_group([SetPoint(finger, tip=tip)])

    def send_stiffness(self, finger: int, stiffness: numpy.typing.ArrayLike) -> None:
        """Sends Kx in the finger's frame, N/cm: shape (3, 3), symmetric. Errors are those of `send_position`."""
        self.send_group([SetPoint(finger, stiffness=stiffness)])

    def send_damping(self, finger: int, ratio: float) -> None:
        """Sends the damping relative to the one that the controller chooses. Errors are those of `send_position`."""
        self.send_group([SetPoint(finger, damping=ratio)])

    def send_group(self, set_points: Sequence[SetPoint]) -> None:
        """Sends set points of several fingers, which change in the same cycle. Errors are those of `send_position`."""
        self._send(self.parts(set_points))

    def send_path(self, finger: int, times: numpy.typing.ArrayLike, joints: numpy.typing.ArrayLike) -> None:
        """Sends a path of 1 to 32 poses. A Kx or damping that is sent right after a path waits until the server has
        taken the path. Errors are those of `send_position`.

        Args:
            times: times of the poses, counted from the moment at which the server takes the path, s: shape (n,).
            joints: joint angles, rad: shape (n, 3).
        """
        self._check(finger)
        self._send([_parts.path(finger, times, joints, self._status.fingers[finger])])

    def parts(self, set_points: Sequence[SetPoint]) -> List[Part]:
        """Returns checked set points in the form of the protocol, for `send_together`."""
        self._check(*(set_point.finger for set_point in set_points))
        return _parts.group(set_points, self._status.fingers)

    @property
    def owner(self) -> Owner:
        """The set points of this hand, to which `send_together` adds new ones."""
        return self._owner

    def wait(
        self,
        fingers: Union[int, Iterable[int], None] = None,
        condition: str = "arrived",
        timeout: Optional[float] = None,
    ) -> None:
        """Waits until the condition holds for the newest set point of each of these fingers.

        Args:
            fingers: a finger, or several. The default is all fingers to which this client has sent something.
            condition: "applied": the server has taken the set point. "arrived": since the set point was sent, there was
                a cycle in which every joint was at the set point. "settled": since it was sent, the joints have come to
                rest. Both "arrived" and "settled" still hold if the finger was pushed away afterwards.
            timeout: time limit, s. Without it, the wait has no limit.

        Raises:
            TimedOut: the time limit has expired.
            Stale, which is also a TimedOut: no State has arrived for a second, or for `stale` if that is longer.
            NotOwner: this client does not command the hand, or has lost it.
            Refused: the server has refused the set point.
            Fault: a finger is faulted.
        """
        if condition not in _CONDITIONS:
            text = f'there is no condition {condition!r} to wait for: pass "applied", "arrived" or "settled"'
            raise Refused(text, number=ErrorNumber.ARGUMENT)
        if fingers is None:
            with self._network.sender.lock:
                fingers = self._owner.commanded()
        wanted = list(fingers) if isinstance(fingers, Iterable) else [fingers]
        self._check(*wanted)
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            left = 0.1 if deadline is None else min(0.1, deadline - time.monotonic())
            holds = self._receiver.wait_for(lambda: self._hold(wanted, _CONDITIONS[condition]), max(left, 0))
            self._check()
            # After a refusal, the set point before the refused one counts as the newest one, and the condition may
            # hold for that set point. The refusal must be raised nevertheless.
            with self._network.sender.lock:
                self._owner.check(wanted)
            for finger in wanted:
                self._check_fault(finger)
            if holds:
                return
            if left <= 0:
                remedy = "check what keeps the fingers from moving, and the line to the server, or wait longer"
                text = f'the condition "{condition}" did not hold for fingers {wanted} within {timeout} s: {remedy}'
                raise TimedOut(text, number=ErrorNumber.TIMED_OUT)

    def recover(self, finger: int = 0) -> None:
        """Recovers a finger that has stopped: it becomes a spring again. Without an argument, recovers every such
        finger.

        Raises:
            Fault: the cause of the fault is still there.
        """
        self._request("recover", finger, self._epoch(), timeout=_RECOVERY_TIME)

    def stop(self, finger: Optional[int] = None) -> None:
        """Brings a finger, or every finger, to its end state at once, whoever commands the hand."""
        self._request("stop", finger or 0)

    def zero(self, finger: int) -> None:
        """Zeros gauges and encoders of a finger. Its joints may move between their stops. Waits up to ten minutes.

        Raises:
            Error: the calibration failed, or its results could not be stored. Results that could not be stored are in
                force. If the finger faulted after the results had been found, they are in force too.
        """
        self._check(finger)
        self._request("calibrate", finger, self._epoch(), timeout=_CALIBRATION_TIME)

    def identify(self, finger: int) -> None:
        """Measures gauge gains, friction, tendons and rotors of a finger. Errors are those of `zero`."""
        self._check(finger)
        self._request("identify", finger, self._epoch(), timeout=_CALIBRATION_TIME)

    def _epoch(self) -> int:
        with self._network.sender.lock:
            return self._owner.epoch

    def _hold(self, fingers: List[int], bits: int) -> bool:
        with self._network.sender.lock:
            return all(self._owner.holds(finger, bits) for finger in fingers)

    def _check_fault(self, finger: int) -> None:
        # A wait goes on during a short pause of the line.
        record = self._receiver.newest(finger, max(self._stale, _PAUSE))
        if STAGES[record["stage"]] == "faulted":
            number, name = int(record["fault"]), self._fault_name(finger)
            fault = f"finger {finger} is faulted (fault {number})" + (name and f": {name}")
            remedy = f"remove the cause (docs/faults.md), and call hand.recover({finger})"
            raise Fault(f"{fault}: {remedy}", number=ErrorNumber.FAULTED, finger=finger, fault=number)

    def _send(self, parts: List[Part]) -> None:
        self._network.sender.send([(self._owner, parts)])

    def _take_state(self, data: bytes) -> None:
        state = self._receiver.state(data)
        if state is not None:
            with self._network.sender.lock:
                self._owner.received(state)
            self._receiver.notify()

    def _take_refusal(self, data: bytes) -> None:
        answer = _messages.read_answer(data)
        if answer is not None:
            self._receiver.answered(answer.time)
            with self._network.sender.lock:
                self._owner.refused(answer)
            self._receiver.notify()

    def _request(
        self, action: str, finger: int, epoch: int = 0, timeout: float = ANSWER_TIME, **flags: bool
    ) -> Answer:
        if action != "release":
            self._check(*([finger] if finger else []))
        payload = _messages.write_request(action, finger, epoch, **flags)
        # A calibration is requested only once: a repeated request could start it again after it has ended.
        ask = self._network.get if action in ("calibrate", "identify") else self._answers
        for _, reply in ask(f"{self._prefix}{action}/{self._network.client}", payload, timeout):
            answer = _messages.read_answer(reply)
            if answer is not None:
                self._receiver.answered(answer.time)
                finger, fault = self._stopped(finger) if answer.code == FAULTED else (finger, 0)
                error = error_of(answer, action, finger, fault)
                if error is not None:
                    raise error
                return answer
        raise self._no_answer(action)

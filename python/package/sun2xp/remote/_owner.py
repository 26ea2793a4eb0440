"""The client's part of the ownership: what the client has sent to each finger, and the Targets that repeat this.
Target, State and Answer are messages of docs/remote-protocol.md."""

from __future__ import annotations

import threading
import time
import warnings
from typing import Callable, Dict, Iterable, List, Optional, Tuple

from .._errors import Closed, ErrorNumber, Refused
from . import _messages
from ._errors import NotOwner, refusal_of
from ._messages import Answer, Part, State, Target
from ._receiver import Receiver
from ._slot import Slot

#: Interval between two Targets, s. The protocol needs one every 25 ms.
PERIOD = 0.02

#: The largest command number. The command after it has the number 1.
_LAST_COMMAND = 2**32 - 1


class Owner:
    """The set points of one hand. The lock of the Sender protects this object."""

    def __init__(self, put: Callable[[bytes], None], receiver: Receiver) -> None:
        self._put = put
        self._receiver = receiver
        self._epoch = 0
        self._validity = 0
        self._end = float("inf")
        #: The number of the epoch, and the server's time from which every State contains this number.
        self._number = self._since = 0
        #: The value of `Receiver.restarts` when the epoch began.
        self._restarts = 0
        self._sequence = 0
        self._command = 0
        #: What is sent to the fingers that this client has commanded in this epoch.
        self._slots: Dict[int, Slot] = {}
        #: Bits of the newest record of each finger in this epoch.
        self._bits: Dict[int, int] = {}
        #: The refusals of each finger that no call has raised yet.
        self._refusals: Dict[int, Refused] = {}

    @property
    def epoch(self) -> int:
        """The epoch; 0 if this client is not the owner. If the server is silent for a long time, this client counts the
        epoch as ended."""
        self._notice_silence()
        return self._epoch

    def begin(self, answer: Answer, end: float) -> None:
        """Begins the new epoch that the server returned in its Answer to the Request `acquire`. The server ends the
        epoch when the newest Target is older than `end`, s."""
        self._epoch, self._validity, self._end = answer.epoch, answer.catch_ms, end
        self._number, self._since, self._sequence = answer.number, answer.time, 0
        self._restarts = self._receiver.restarts
        self._slots, self._bits, self._refusals = {}, {}, {}

    def end(self) -> None:
        """Ends the epoch: nothing more is sent."""
        self._epoch = 0

    def _notice_silence(self) -> None:
        """Ends the epoch if this client has received nothing from the server for so long that the server regards all
        Targets of this client as too old. A Target contains the newest time of the server that this client has
        received."""
        if self._receiver.silence() > self._end:
            self._epoch = 0

    def received(self, state: State) -> None:
        """Processes what a State has shown: the number of the owner's epoch, and the records of this epoch."""
        if self._receiver.restarts != self._restarts:
            self._epoch = 0
        # An earlier State belongs to another epoch, in which another client may have used the same command numbers.
        if self._epoch == 0 or state.published <= self._since:
            return
        if state.owner != self._number:
            self._epoch = 0
            return
        for record in state.records:
            finger, bits = int(record["finger"]), int(record["bits"])
            self._bits[finger] = bits
            if finger in self._slots:
                self._slots[finger].received(int(record["command"]), bits)

    def refused(self, answer: Answer) -> None:
        """Processes the refusal of a Target: drops those of its set points that no State has confirmed."""
        if answer.epoch != self._epoch:
            return
        for finger, slot in self._slots.items():
            if slot.refuse(answer.number):
                self._refusals[finger] = refusal_of(answer)

    def commanded(self) -> List[int]:
        """Returns the fingers to which this client has sent something in this epoch."""
        return sorted(self._slots)

    def holds(self, finger: int, bits: int) -> bool:
        """Returns whether the server has applied or refused every command of this client to this finger in this epoch,
        and the finger's newest record of this epoch has these bits."""
        slot = self._slots.get(finger)
        if slot is None:
            return finger in self._bits and self._bits[finger] & bits == bits
        return slot.holds(bits)

    def check(self, fingers: Iterable[int]) -> None:
        """Checks that this client owns the hand, and that the server has refused no command to these fingers.

        Raises:
            NotOwner: this client is not the owner.
            Refused: the server has refused what was sent before. Each refusal is raised once.
        """
        if self.epoch == 0:
            remedy = "call hand.acquire(), or hand.acquire(take_over=True) if another client owns the hand"
            raise NotOwner(f"this client does not command the hand: {remedy}", number=ErrorNumber.BUSY)
        refusals = [self._refusals.pop(finger) for finger in fingers if finger in self._refusals]
        texts = sorted({refusal.text for refusal in refusals})
        if texts:
            kept = "the hand has refused an earlier set point, and keeps the set point before it"
            again = "If this call has a set point, it was not sent: send it again"
            text = f"{kept}. {again}. Reason of the refusal: {'; '.join(texts)}"
            raise Refused(text, number=refusals[0].number)

    def command(self, changes: List[Part]) -> None:
        """Accepts new set points. Each contains only the values that shall change. All other values stay the same."""
        for change in changes:
            self._slots.setdefault(change.finger, Slot()).change(change)

    def _renew(self) -> None:
        """Puts the waiting changes into parts with new command numbers. While one finger's change must wait (see
        Slot.is_blocked), all changes wait, so that changes which were sent together stay together."""
        if any(slot.is_blocked for slot in self._slots.values()):
            return
        for slot in self._slots.values():
            if slot.waits:
                self._command = self._command % _LAST_COMMAND + 1
                slot.renew(self._command, self._sequence)

    def publish(self, sent: int) -> None:
        """Sends a Target with everything that is in force.

        Args:
            sent: time, ns of the local clock.
        """
        if self.epoch == 0:
            return
        self._sequence += 1
        self._renew()
        parts = [slot.part for slot in self._slots.values() if slot.part is not None]
        target = Target(self._validity, self._epoch, self._sequence, sent, self._receiver.seen, parts)
        self._put(_messages.write_target(target))


class Sender:
    """Repeats the Targets of several hands every 20 ms in a thread, with one time stamp for all of them."""

    def __init__(self) -> None:
        #: Protects the owners.
        self.lock = threading.RLock()
        self._owners: List[Owner] = []
        self._ends = threading.Event()
        self._thread: Optional[threading.Thread] = None

    def add(self, owner: Owner) -> None:
        """Begins to repeat the Targets of a hand."""
        with self.lock:
            self._owners.append(owner)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="sun2xp targets", daemon=True)
                self._thread.start()

    def remove(self, owner: Owner) -> None:
        """Ends the Targets of a hand."""
        with self.lock:
            owner.end()
            self._owners = [other for other in self._owners if other is not owner]

    def send(self, commands: List[Tuple[Owner, List[Part]]]) -> None:
        """Sends commands to one or several hands at once, with one time stamp.

        Raises:
            NotOwner, Refused: `Owner.check` raises this error for one of the hands. Then nothing is sent.
            Closed: one of the hands is closed.
        """
        with self.lock:
            if any(owner not in self._owners for owner, _ in commands):
                raise Closed("the hand is closed: open it again", number=ErrorNumber.NO_HAND)
            for owner, changes in commands:
                owner.check(change.finger for change in changes)
            for owner, changes in commands:
                owner.command(changes)
            sent = time.monotonic_ns()
            for owner, _ in commands:
                owner.publish(sent)

    def leave(self) -> None:
        """Ends all Targets in a child of `os.fork`. The child does not have the thread, which may have held the lock at
        the fork."""
        self.lock, self._thread = threading.RLock(), None
        for owner in self._owners:
            owner.end()
        self._owners = []

    def close(self) -> None:
        """Ends the thread."""
        self._ends.set()
        if self._thread is not None:
            self._thread.join()

    def _run(self) -> None:
        due = time.monotonic()
        while not self._ends.wait(max(0.0, due - time.monotonic())):
            with self.lock:
                sent = time.monotonic_ns()
                for owner in self._owners:
                    self._repeat(owner, sent)
            # After a pause of this thread, one Target follows at once. The other missed Targets are not sent.
            due = max(due + PERIOD, time.monotonic())

    @staticmethod
    def _repeat(owner: Owner, sent: int) -> None:
        try:
            owner.publish(sent)
        except Exception as error:  # The Targets of the other hands must go on.
            text = "the set points of a hand cannot be sent, and its fingers stop if no later attempt succeeds"
            warnings.warn(f"{text}: {error}: check the connection", RuntimeWarning, stacklevel=2)

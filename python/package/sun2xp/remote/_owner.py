"""The client's part of the ownership: what it has sent to each finger, and the Targets that repeat it."""

from __future__ import annotations

import collections
import dataclasses
import threading
import time
from typing import Callable, Deque, Dict, Iterable, List, Optional, Tuple

from .._errors import Closed, ErrorNumber, Refused
from . import _messages
from ._errors import NotOwner
from ._messages import NO_PLACE, Answer, Part, Target
from ._receiver import Receiver

#: Interval between two Targets, s. The protocol needs one every 25 ms.
PERIOD = 0.02

#: Number of Targets whose commands are remembered, for a refusal that arrives late.
_REMEMBERED = 500

#: The largest command number. The next command has the number 1.
_LAST_COMMAND = 2**32 - 1


class Owner:
    """The set points of one hand. The lock of the Sender protects all of it."""

    def __init__(self, put: Callable[[bytes], None], receiver: Receiver) -> None:
        self._put = put
        self._receiver = receiver
        self._epoch = 0
        self._validity = 0
        #: The number of the epoch, and the server's time from which every State contains this number.
        self._number = self._since = 0
        self._sequence = 0
        self._command = 0
        #: The last part of each finger that a State has confirmed.
        self._confirmed: Dict[int, Part] = {}
        #: The later commands of each finger: what each one changes, and the part that was sent for it.
        self._open: Dict[int, List[Tuple[Part, Part]]] = {}
        self._sent: Deque[Tuple[int, Dict[int, int]]] = collections.deque(maxlen=_REMEMBERED)
        self._refusals: Dict[int, str] = {}

    @property
    def epoch(self) -> int:
        """The epoch; 0 if this client is not the owner."""
        return self._epoch

    def begin(self, answer: Answer) -> None:
        """Begins the epoch of an Answer to acquire."""
        self._epoch, self._validity = answer.epoch, answer.catch_ms
        self._number, self._since, self._sequence = answer.number, answer.time, 0
        self._confirmed, self._open, self._refusals = {}, {}, {}
        self._sent.clear()

    def end(self) -> None:
        """Ends the epoch: nothing more is sent."""
        self._epoch = 0

    def heard(self, published: int, owner: int) -> None:
        """Processes what a State has shown: the number of the owner's epoch, and the applied commands."""
        if published > self._since and owner != self._number:
            self._epoch = 0
        for finger, commands in self._open.items():
            applied = self._receiver.applied(finger)[0]
            index = next((index for index, (_, part) in enumerate(commands) if part.command == applied), None)
            if index is not None:
                self._confirmed[finger] = commands[index][1]
                del commands[: index + 1]

    def refused(self, answer: Answer) -> None:
        """Processes the refusal of a Target: drops those of its set points that no State has confirmed."""
        if answer.epoch != self._epoch:
            return
        sent = next((commands for sequence, commands in self._sent if sequence == answer.number), {})
        for finger, command in sent.items():
            commands = self._open.get(finger, [])
            if any(part.command == command for _, part in commands):
                self._refusals[finger] = answer.text
                # A later command repeats the values of this one.
                commands.clear()

    def take_refusal(self, fingers: Iterable[int]) -> None:
        """Raises the refusal of an earlier command of these fingers, once.

        Raises:
            Refused: the server has refused what was sent before.
        """
        texts = {self._refusals.pop(finger) for finger in fingers if finger in self._refusals}
        if texts:
            raise Refused(" ".join(sorted(texts)), number=ErrorNumber.LIMIT)

    def pending(self, finger: int) -> Optional[int]:
        """Returns the number of the newest command of a finger; None if there is none."""
        part = self._part(finger)
        return None if part is None else part.command

    def check(self, fingers: Iterable[int]) -> None:
        """Checks that commands for these fingers can be accepted.

        Raises:
            NotOwner: this client is not the owner.
            Refused: the server has refused what was sent before.
        """
        if self._epoch == 0:
            remedy = "hand.acquire() gets the hand, if no other client owns it"
            raise NotOwner(f"this client does not command the hand. {remedy}.", number=5, remedy=remedy)
        self.take_refusal(fingers)

    def command(self, changes: List[Part]) -> None:
        """Accepts new set points. Each contains only the values that shall change. All other values stay the same."""
        for change in changes:
            self._command = self._command % _LAST_COMMAND + 1
            part = dataclasses.replace(change, command=self._command)
            commands = self._open.setdefault(change.finger, [])
            # The server may have missed what no State has confirmed, so the new part repeats it.
            for earlier, _ in reversed(commands):
                _fill(part, earlier)
            commands.append((change, part))

    def _part(self, finger: int) -> Optional[Part]:
        """Returns the part of a finger that is in force, or that shall come into force."""
        commands = self._open.get(finger)
        return commands[-1][1] if commands else self._confirmed.get(finger)

    def publish(self, sent: int) -> None:
        """Sends a Target with everything that is in force.

        Args:
            sent: time, ns of the local clock.
        """
        if self._epoch == 0:
            return
        self._sequence += 1
        parts = [part for part in map(self._part, (1, 2, 3)) if part is not None]
        target = Target(self._validity, self._epoch, self._sequence, sent, self._receiver.seen, parts)
        self._sent.append((self._sequence, {part.finger: part.command for part in parts}))
        self._put(_messages.write_target(target))


def _fill(part: Part, earlier: Part) -> None:
    """Adds the values of an earlier part that this one does not have."""
    if part.place == NO_PLACE:
        part.place, part.values, part.poses = earlier.place, earlier.values, earlier.poses
    if part.stiffness is None:
        part.stiffness = earlier.stiffness
    if part.damping is None:
        part.damping = earlier.damping


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
                raise Closed("the hand is closed", number=ErrorNumber.NO_HAND)
            for owner, changes in commands:
                owner.check(change.finger for change in changes)
            for owner, changes in commands:
                owner.command(changes)
            sent = time.monotonic_ns()
            for owner, _ in commands:
                owner.publish(sent)

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
                    owner.publish(sent)
            # After a pause of this thread, one Target follows at once. The other missed Targets are not sent.
            due = max(due + PERIOD, time.monotonic())

"""What the owner sends to one finger. Target and State are messages of docs/remote-protocol.md. A part is what a Target
says about one finger."""

from __future__ import annotations

import dataclasses
from typing import List, Optional

from ._messages import NO_PLACE, PATH, Part


@dataclasses.dataclass
class _Command:
    """A command that no State has confirmed."""

    #: What it changes.
    change: Part
    #: The part that was sent for it, which also has the values of earlier commands that were not confirmed.
    part: Part
    #: Sequence number of the first Target with this part.
    sequence: int


class Slot:
    """What the owner sends to one finger: the part that Targets repeat, and the changes that are not in it yet."""

    def __init__(self) -> None:
        #: The part that Targets repeat; None if there was no command, or if the newest one was refused. After a
        #: refusal an earlier part must not be sent again: the server applies a part if its command number differs from
        #: the last one that it applied, so it may apply the earlier part as a new one.
        self.part: Optional[Part] = None
        #: Changes that no Target has yet.
        self._waiting: Optional[Part] = None
        self._open: List[_Command] = []
        #: Bits of the finger's newest record (its entry in a State) of this epoch; None if no record has arrived yet.
        self._bits: Optional[int] = None

    @property
    def waits(self) -> bool:
        """Whether there are changes that no Target has yet."""
        return self._waiting is not None

    def holds(self, bits: int) -> bool:
        """Returns whether no change waits, States have confirmed everything that was sent and not refused, and the
        newest record has these bits."""
        if self._open or self.waits or self._bits is None:
            return False
        return self._bits & bits == bits

    @property
    def is_blocked(self) -> bool:
        """Whether the waiting changes must not be sent yet, because a path was sent and is not confirmed. If the path
        were repeated with the changes, it could begin twice. If it were left out, it could be lost."""
        if self._waiting is None or self._waiting.place != NO_PLACE:
            return False
        return bool(self._open) and self._open[-1].part.place == PATH

    def change(self, change: Part) -> None:
        """Adds a change. Its values replace those that wait."""
        change = dataclasses.replace(change)
        if self._waiting is not None:
            _fill(change, self._waiting)
        self._waiting = change

    def renew(self, command: int, sequence: int) -> None:
        """Makes the part for the Target with this sequence number. It contains the waiting changes, and everything that
        no State has confirmed, because the server may have missed it."""
        if self._waiting is None:
            return
        change, self._waiting = self._waiting, None
        self.part = dataclasses.replace(change, command=command)
        for earlier in reversed(self._open):
            _fill(self.part, earlier.change)
        self._open.append(_Command(change, self.part, sequence))

    def received(self, command: int, bits: int) -> None:
        """Processes a record of this epoch. The commands up to its command number are confirmed."""
        self._bits = bits
        numbers = [sent.part.command for sent in self._open]
        if command in numbers:
            del self._open[: numbers.index(command) + 1]

    def refuse(self, sequence: int) -> bool:
        """Drops what was in the refused Target with this sequence number, unless a State has confirmed it. Returns
        whether anything was dropped."""
        later = [sent for sent in self._open if sent.sequence > sequence]
        refused = len(later) < len(self._open)
        self._open = later
        if refused and not later:
            self.part = None
        return refused


def _fill(part: Part, earlier: Part) -> None:
    """Copies to `part` each value of `earlier` that `part` does not have."""
    if part.place == NO_PLACE:
        part.place, part.values, part.poses = earlier.place, earlier.values, earlier.poses
    if part.stiffness is None:
        part.stiffness = earlier.stiffness
    if part.damping is None:
        part.damping = earlier.damping

"""The exceptions of the package."""

from __future__ import annotations


class Error(Exception):
    """A call that was refused or that failed. A refused call changes nothing.

    Attributes:
        text: cause and remedy, in one line.
        number: the number of the errno that describes the error best (module `errno`).
        remedy: what to do.
    """

    text: str
    number: int
    remedy: str

    def __init__(self, text: str, *, number: int = 0, remedy: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.number = number
        self.remedy = remedy


class Closed(Error):
    """The hand is closed."""


class Refused(Error, ValueError):
    """An argument that the hand cannot take: a finger that it does not have, a set point outside the limits, an array
    with a wrong shape, or a call that does not suit the finger's stage."""


class ConfigurationError(Error):
    """A configuration that cannot be read, used or stored."""


class TimedOut(Error, TimeoutError):
    """A finger has not arrived or settled within the time limit."""


class Fault(Error):
    """The finger has stopped because of a fault. `hand.recover(finger)` makes it a spring again.

    Attributes:
        finger: number of the finger, 1 to 3.
        fault: number of the fault, as in docs/faults.md.
    """

    finger: int
    fault: int

    def __init__(self, text: str, *, number: int = 0, remedy: str = "", finger: int = 0, fault: int = 0) -> None:
        super().__init__(text, number=number, remedy=remedy)
        self.finger = finger
        self.fault = fault

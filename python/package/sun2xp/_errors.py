"""The exceptions of the package."""

from __future__ import annotations

import enum
from typing import Any


class ErrorNumber(enum.IntEnum):
    """Why a call was refused or failed: the constants SUN2XP_ERROR_... of the C interface. Numbers never change."""

    DEFECT = 1
    FORKED = 2
    EXITING = 3
    NO_HAND = 4
    BUSY = 5
    TOO_MANY = 6
    ARGUMENT = 7
    LIMIT = 8
    FAULTED = 9
    CONFIGURATION = 10
    PORT = 11
    SYSTEM = 12
    NO_MEMORY = 13
    TIMED_OUT = 14
    CALIBRATION = 15
    NOT_SUPPORTED = 16
    NOT_FOUND = 17
    REAL_TIME = 18


class Error(Exception):
    """A call that was refused or that failed. A refused call changes nothing.

    Attributes:
        text: cause and remedy, in one line.
        number: the reason, as the C interface numbers it.
        errno: the constant of the module `errno` that describes the error best.
        remedy: what to do; may be empty. The text always contains the whole remedy.
    """

    text: str
    number: ErrorNumber
    errno: int
    remedy: str

    def __init__(self, text: str, *, number: int = 1, errno: int = 0, remedy: str = "") -> None:
        super().__init__(text)
        self.text = text
        self.number = ErrorNumber(number)
        self.errno = errno
        self.remedy = remedy


class Closed(Error):
    """The hand is closed."""


class Refused(Error, ValueError):
    """An argument that the hand cannot take: a finger that it does not have, a set point outside the limits, an array
    with a wrong shape, or a call that does not suit the finger's stage."""


class ConfigurationError(Error):
    """A configuration that cannot be read, used or stored."""


# OSError has an attribute errno too, whose value may be None.
class TimedOut(Error, TimeoutError):  # type: ignore[misc]
    """A finger has not arrived or settled within the time limit."""


class Fault(Error):
    """The finger has stopped because of a fault. `hand.recover(finger)` makes it a spring again.

    Attributes:
        finger: number of the finger, 1 to 3.
        fault: number of the fault, as in docs/faults.md.
    """

    finger: int
    fault: int

    def __init__(self, text: str, *, finger: int = 0, fault: int = 0, **details: Any) -> None:
        super().__init__(text, **details)
        self.finger = finger
        self.fault = fault

"""The exceptions of the package."""

from __future__ import annotations

import enum
import errno as system
from typing import Any, Optional, Tuple


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


#: The errnos of errors that this package raises by itself. Errors of the library come with their errno.
_ERRNOS = {
    ErrorNumber.DEFECT: system.EIO,
    ErrorNumber.FORKED: system.EPERM,
    ErrorNumber.EXITING: system.ESHUTDOWN,
    ErrorNumber.NO_HAND: system.ENODEV,
    ErrorNumber.BUSY: system.EBUSY,
    ErrorNumber.TOO_MANY: system.ENOSPC,
    ErrorNumber.ARGUMENT: system.EINVAL,
    ErrorNumber.LIMIT: system.ERANGE,
    ErrorNumber.FAULTED: system.EIO,
    ErrorNumber.CONFIGURATION: system.EINVAL,
    ErrorNumber.PORT: system.EIO,
    ErrorNumber.SYSTEM: system.EIO,
    ErrorNumber.NO_MEMORY: system.ENOMEM,
    ErrorNumber.TIMED_OUT: system.ETIMEDOUT,
    ErrorNumber.CALIBRATION: system.ECANCELED,
    ErrorNumber.NOT_SUPPORTED: system.ENOTSUP,
    ErrorNumber.NOT_FOUND: system.ENOENT,
    ErrorNumber.REAL_TIME: system.EPERM,
}


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

    def __init__(
        self, text: str, *, number: int = 1, errno: Optional[int] = None, remedy: Optional[str] = None
    ) -> None:
        super().__init__(text)
        self.text = text
        self.number = ErrorNumber(number)
        self.errno = _ERRNOS[self.number] if errno is None else errno
        if remedy is None:
            # A text ends with its remedy, after its last colon.
            remedy = text.rpartition(": ")[2] if ": " in text else ""
        self.remedy = remedy


class Closed(Error):
    """The hand is closed."""


class Refused(Error, ValueError):
    """The hand does not accept the call: there is no such finger, a set point is outside the limits, an array has a
    wrong shape, or the finger's stage does not permit the call."""


class ConfigurationError(Error):
    """A configuration that cannot be read, used or stored."""


# mypy objects that the attribute errno of OSError may be None, unlike that of Error.
class TimedOut(Error, TimeoutError):  # type: ignore[misc]
    """A time limit has expired, for example before a finger arrived or settled."""

    def __reduce__(self) -> Tuple[Any, ...]:
        # OSError keeps its errno outside the dictionary, so a copy from another process would not have it.
        return type(self), self.args, {**vars(self), "errno": self.errno}


class Fault(Error):
    """The finger has stopped because of a fault. `hand.recover(finger)` makes it a spring again.

    Attributes:
        finger: number of the finger, 1 to 3. It is 0 if a request to a remote hand concerns all fingers, and the server
            does not say which one has stopped.
        fault: number of the fault, as in docs/faults.md. It is 0 if the server of a remote hand does not say which
            fault it was.
    """

    finger: int
    fault: int

    def __init__(self, text: str, *, finger: int = 0, fault: int = 0, **details: Any) -> None:
        super().__init__(text, **details)
        self.finger = finger
        self.fault = fault

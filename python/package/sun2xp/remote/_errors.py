"""The exceptions of the remote client, and which of them an Answer raises. Answer, Request and Target are messages of
docs/remote-protocol.md."""

from __future__ import annotations

from typing import Optional

from .._errors import Closed, Error, ErrorNumber, Fault, Refused, TimedOut
from ._messages import Answer


#: The code of an Answer if the hand has refused an argument, or if a recovery or calibration has failed.
_REFUSED = 6

#: The code of an Answer if a finger has stopped.
FAULTED = 7

#: The error number for each code of an Answer.
_NUMBERS = {
    3: ErrorNumber.ARGUMENT,
    4: ErrorNumber.BUSY,
    5: ErrorNumber.BUSY,
    _REFUSED: ErrorNumber.LIMIT,
    FAULTED: ErrorNumber.FAULTED,
    8: ErrorNumber.NO_HAND,
    9: ErrorNumber.BUSY,
}

#: The error number for each Request that fails with the code `_REFUSED`. The code then means a failure, because these
#: Requests have no argument that the hand could refuse.
_FAILURES = {
    "acquire": ErrorNumber.PORT,
    "recover": ErrorNumber.PORT,
    "calibrate": ErrorNumber.CALIBRATION,
    "identify": ErrorNumber.CALIBRATION,
}


class NotOwner(Error):
    """This client does not own the hand. It has not acquired the hand, has released it, was silent for too long, lost
    the hand to another client, or may not command it ([serve.clients] of the server). If the client may command the
    hand, `hand.acquire()` makes it the owner. If another client owns the hand, that call needs `take_over=True`."""


class Stale(TimedOut):
    """The newest state of the finger is older than `stale`: the line or the server has failed."""


class NoAnswer(TimedOut):
    """The server has not answered: there is no such hand, there is no connection, the server is busy with other
    requests of this client, or, with TLS, this client may not make the request."""


def forked() -> Error:
    """Returns the exception for a process that `os.fork` has made and that uses a connection of its parent."""
    remedy = 'make the call in the parent, or start processes with the method "spawn"'
    text = "this process was forked from the process that has connected, and only that process has the threads of the"
    return Error(f"{text} connection: {remedy}", number=ErrorNumber.FORKED, remedy=remedy)


def refusal_of(answer: Answer) -> Refused:
    """Returns the exception for the refusal of a Target."""
    return Refused(answer.text, number=_NUMBERS.get(answer.code, ErrorNumber.NOT_SUPPORTED))


def error_of(answer: Answer, action: str, finger: int = 0, fault: int = 0) -> Optional[Error]:
    """Returns the exception for the Answer to a Request, or None if its code is 0.

    Args:
        action: the action of the Request.
        finger, fault: the finger that has stopped and the number of its fault, for Fault.
    """
    code, text = answer.code, answer.text
    if code == 0:
        return None
    if code == _REFUSED and action in _FAILURES:
        return Error(text, number=_FAILURES[action])
    if code in (3, _REFUSED, 9):
        return Refused(text, number=_NUMBERS[code])
    if code in (4, 5):
        return NotOwner(text, number=_NUMBERS[code])
    if code == FAULTED:
        return Fault(text, number=_NUMBERS[code], finger=finger, fault=fault)
    if code == 8:
        return Closed(text, number=_NUMBERS[code])
    return Error(
        text or f"the server answers with code {code}: use a client and a server of the same version",
        number=ErrorNumber.NOT_SUPPORTED,
    )

"""The exceptions of the remote client, and which of them an Answer raises."""

from __future__ import annotations

from typing import Optional

from .._errors import Closed, Error, ErrorNumber, Fault, Refused, TimedOut
from ._messages import Answer


class NotOwner(Error):
    """Another client commands the hand, or this one has lost it: by a take-over, or because it was silent for too
    long. `hand.acquire()` gets it again."""


class Stale(TimedOut):
    """The newest state of the finger is older than `stale`: the line or the server has failed."""


class NoAnswer(TimedOut):
    """The server has not answered: no such hand, no connection, or this client may not ask for it."""


def error_of(answer: Answer, finger: int = 0, fault: int = 0) -> Optional[Error]:
    """Returns the exception for an Answer, or None if its code is 0.

    Args:
        finger, fault: the finger of the Request and the number of its fault, for Fault.
    """
    code, text = answer.code, answer.text
    if code == 0:
        return None
    if code == 3:
        return Refused(text, number=ErrorNumber.ARGUMENT)
    if code in (4, 5):
        return NotOwner(text, number=ErrorNumber.BUSY)
    if code == 6:
        return Refused(text, number=ErrorNumber.LIMIT)
    if code == 7:
        return Fault(text, number=ErrorNumber.FAULTED, finger=finger, fault=fault)
    if code == 8:
        return Closed(text, number=ErrorNumber.NO_HAND)
    if code == 9:
        return Refused(text, number=ErrorNumber.BUSY)
    return Error(text or f"the server answers with code {code}", number=ErrorNumber.NOT_SUPPORTED)

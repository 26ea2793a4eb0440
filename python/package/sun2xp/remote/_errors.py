"""The exceptions of the remote client, and which of them an Answer raises."""

from __future__ import annotations

from typing import Optional

from .._errors import Closed, Error, ErrorNumber, Fault, Refused, TimedOut
from ._messages import Answer


#: The code of an Answer: a finger has stopped.
FAULTED = 7


class NotOwner(Error):
    """This client does not own the hand: another client commands it, or this client was silent for too long.
    `hand.acquire()` makes this client the owner again."""


class Stale(TimedOut):
    """The newest state of the finger is older than `stale`: the line or the server has failed."""


class NoAnswer(TimedOut):
    """The server has not answered: no such hand, no connection, or this client may not ask for it."""


def forked() -> Error:
    """Returns the exception of a child of `os.fork` that uses a connection of its parent."""
    remedy = 'make the call in the parent, or start processes with the method "spawn"'
    text = "this process was forked from the process that has connected, and only that process has the threads of the"
    return Error(f"{text} connection: {remedy}", number=ErrorNumber.FORKED, remedy=remedy)


def error_of(answer: Answer, finger: int = 0, fault: int = 0) -> Optional[Error]:
    """Returns the exception for an Answer, or None if its code is 0.

    Args:
        finger, fault: the finger that has stopped and the number of its fault, for Fault.
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
    if code == FAULTED:
        return Fault(text, number=ErrorNumber.FAULTED, finger=finger, fault=fault)
    if code == 8:
        return Closed(text, number=ErrorNumber.NO_HAND)
    if code == 9:
        return Refused(text, number=ErrorNumber.BUSY)
    return Error(text or f"the server answers with code {code}", number=ErrorNumber.NOT_SUPPORTED)

"""Events of a remote hand as an iterator."""

from __future__ import annotations

from typing import Iterator, List, Optional

from .._types import Event
from ._errors import forked
from ._receiver import Receiver


class RemoteEvents:
    """A queue of all events of a remote hand, from `RemoteHand.events`. Iteration waits for each event, and ends when
    the hand or the queue is closed.

    Every queue gets all events. A queue that is not read keeps the newest 4096. The times of events are those of the
    server's clock. The server sends a number for the part of the finger that a fault or a warning concerns. The
    meaning of the number depends on the fault (docs/faults.md). The event names the part, for example "tendon 3" or
    "finger". For a fault that this version of the client does not know, the event has "part 3" instead of "tendon 3".
    """

    def __init__(self, receiver: Receiver) -> None:
        self._receiver = receiver
        self._queue = receiver.queue()
        self._closed = False

    def __iter__(self) -> Iterator[Event]:
        while (event := self.wait()) is not None:
            yield event

    def take(self) -> Optional[Event]:
        """Takes the next event, if there is one."""
        if self._receiver.forked:
            raise forked()
        with self._receiver.changed:
            return self._queue.popleft() if self._queue else None

    def wait(self, timeout: Optional[float] = None) -> Optional[Event]:
        """Waits for the next event, and takes it. Returns None if no event comes within `timeout` s, or if the hand or
        the queue is closed and no event is left. Without a timeout, waits without a limit."""
        if self._receiver.forked:
            raise forked()
        taken: List[Event] = []

        def take() -> bool:
            # This function runs under the lock, so no other thread can take an event that this one has seen.
            if self._queue and not taken:
                taken.append(self._queue.popleft())
            return bool(taken) or self._closed

        self._receiver.wait_for(take, timeout)
        return taken[0] if taken else None

    def close(self) -> None:
        """Closes the queue: it gets no further events, and the waits of all threads for its events end."""
        self._receiver.forget(self._queue)
        self._closed = True
        self._receiver.notify()

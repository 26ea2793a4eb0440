"""Events as iterators."""

from __future__ import annotations

import asyncio
from typing import AsyncIterator, Dict, Iterator, Optional, Set

from . import _sun2xp
from ._types import Event


class Events(_sun2xp.Queue):
    """A queue of all events of a hand, from `Hand.events`. Iteration waits for each event. It ends when no
    event is left and the hand is closed or being closed. `take` returns the events that come while the hand is being
    closed.

    Every queue gets all events. A queue that is not read keeps the newest 4096 of each finger. When it is read again,
    it adds the number of lost events to `lost`.
    """

    def __iter__(self) -> Iterator[Event]:
        while (event := self.wait()) is not None:
            yield event

    def __aiter__(self) -> AsyncIterator[Event]:
        return self._follow()

    async def next(self, timeout: Optional[float] = None) -> Optional[Event]:
        """Waits for an event in asyncio, and takes it. Returns None if no event comes within `timeout` s, or if
        no event is left and the hand is closed or being closed. Without a timeout, waits without a limit."""
        loop = asyncio.get_running_loop()
        deadline = None if timeout is None else loop.time() + timeout
        while (event := self.take()) is None and not self.closed:
            left = None if deadline is None else deadline - loop.time()
            if left is not None and left <= 0:
                return None
            await self._ready(loop, left)
        # The last events of a hand may come just before it is closed.
        return self.take() if event is None else event

    async def _follow(self) -> AsyncIterator[Event]:
        while (event := await self.next()) is not None:
            yield event

    async def _ready(self, loop: asyncio.AbstractEventLoop, timeout: Optional[float]) -> None:
        descriptor = self.fileno()
        # A loop calls only one function for each descriptor, so `_wake` wakes all tasks that wait for this queue.
        every: Dict[asyncio.AbstractEventLoop, Set[asyncio.Event]] = self.__dict__.setdefault("_waiting", {})
        tasks = every.setdefault(loop, set())
        ready = asyncio.Event()
        tasks.add(ready)
        try:
            # The descriptor is readable as long as there are events, so the loop watches it only during a wait.
            loop.add_reader(descriptor, _wake, tasks)
            await asyncio.wait_for(ready.wait(), timeout)
        except asyncio.TimeoutError:
            pass
        finally:
            tasks.remove(ready)
            if not tasks:
                loop.remove_reader(descriptor)
                del every[loop]


def _wake(tasks: Set[asyncio.Event]) -> None:
    for ready in tasks:
        ready.set()

"""Trajectories that wait for their stamps. This module needs no hand, so all of it can be tested without one."""

from __future__ import annotations

from typing import Any, Callable, List, Sequence, Set


class _Waiting:
    """A waiting trajectory, and those of its fingers that have got no other command since it was added."""

    def __init__(self, fingers: Sequence[int]) -> None:
        self.fingers: Set[int] = set(fingers)
        self.timer: Any = None


class WaitingTrajectories:
    """Begins each trajectory at its stamp, without the fingers that have got another command by then."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._waiting: List[_Waiting] = []

    def add(self, delay: float, fingers: Sequence[int], begin: Callable[[Set[int]], None]) -> None:
        """Calls `begin` after `delay`, s, with the fingers that have got no other command until then.

        If no such finger is left, `begin` is not called. The new trajectory counts as another command for the
        trajectories that already wait.
        """
        self.forget(fingers)
        one = _Waiting(fingers)

        def run() -> None:
            if one in self._waiting:
                self._end(one)
                begin(one.fingers)

        one.timer = self._node.create_timer(delay, run)
        self._waiting.append(one)

    def forget(self, fingers: Sequence[int]) -> None:
        """Notes that these fingers have got another command."""
        for one in list(self._waiting):
            one.fingers.difference_update(fingers)
            if not one.fingers:
                self._end(one)

    def _end(self, one: _Waiting) -> None:
        self._waiting.remove(one)
        # A ROS timer is periodic, so it must be destroyed after its first call.
        self._node.destroy_timer(one.timer)

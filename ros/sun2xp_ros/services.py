"""The services of the hand and of its fingers."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any, Callable, Sequence

import sun2xp
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

#: Does something with one finger, and returns what it has done.
Action = Callable[[int], str]


class Services:
    """Offers the services zero, recover and stop, for all fingers together and for each finger."""

    def __init__(self, node: Node, hand: sun2xp.Hand, fingers: Sequence[int], stopped: Callable[[int], None]) -> None:
        """The service `stop` calls `stopped` with each finger that it has stopped."""
        self._node = node
        self._stopped = stopped
        self._hand = hand
        #: Threads in which zero and recover wait, so that the node continues to publish. A zeroing takes half a minute.
        self._waiting = ThreadPoolExecutor(max_workers=len(fingers) + 1, thread_name_prefix="sun2xp service")
        slow, quick = ReentrantCallbackGroup(), MutuallyExclusiveCallbackGroup()
        for of, prefix in [(fingers, ""), *(((finger,), f"finger{finger}/") for finger in fingers)]:
            for name, action in (("zero", self._zero), ("recover", self._recover)):
                answer = partial(self._answer_later, of, action)
                node.create_service(Trigger, prefix + name, answer, callback_group=slow)
            stop = partial(self._answer, of, self._stop)
            node.create_service(Trigger, f"{prefix}stop", stop, callback_group=quick)

    def close(self) -> None:
        """Waits until the threads have ended. Close the hand first: this ends the calls for which they wait."""
        self._waiting.shutdown(wait=True)

    async def _answer_later(self, fingers: Sequence[int], action: Action, request: Any, response: Any) -> Any:
        done = Future(executor=self._node.executor)

        def work() -> None:
            try:
                done.set_result(self._answer(fingers, action, request, response))
            except BaseException as defect:
                # The exception ends the node, as in any other callback. If the exception were dropped, a planner would
                # wait for its response for ever.
                done.set_exception(defect)

        self._waiting.submit(work)
        return await done

    def _answer(self, fingers: Sequence[int], action: Action, _request: Any, response: Any) -> Any:
        said, response.success = [], True
        for finger in fingers:
            try:
                said.append(f"finger {finger} {action(finger)}")
            except Exception as refusal:
                # If the service stop fails for one finger, it must still stop the others.
                defect = f"finger {finger}: {refusal!r}: this is a defect of sun2xp_ros, please report it"
                text = str(refusal) if isinstance(refusal, sun2xp.Error) else defect
                response.success = False
                said.append(text)
                self._node.get_logger().error(text)
        response.message = "; ".join(said)
        return response

    def _zero(self, finger: int) -> str:
        self._hand.zero(finger)
        return "is zeroed"

    def _recover(self, finger: int) -> str:
        stage = self._hand.status(finger).stage
        # Just after a stop, the stage may not show the fault yet. The call `recover` waits for the fault.
        self._hand.recover(finger)
        return "has recovered" if stage == "faulted" else "has no fault"

    def _stop(self, finger: int) -> str:
        self._hand.stop(finger)
        self._stopped(finger)
        return "is stopped: call the service `recover` to make it a spring again"

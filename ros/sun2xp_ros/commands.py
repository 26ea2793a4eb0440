"""The topics that move the hand. A command that the hand cannot execute is refused, and the log says why."""

from __future__ import annotations

import time
from functools import partial
from typing import Any, Callable, Collection, Dict, Optional, Sequence, Tuple

import numpy
import sun2xp
from geometry_msgs.msg import PointStamped
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray
from trajectory_msgs.msg import JointTrajectory

from . import names
from .trajectory import Path, Unusable, begins_in, paths
from .waiting import WaitingTrajectories

#: cm in a metre.
CM_PER_M = 100.0

#: Shortest time between two equal lines of the log, s, so that a stream of refused commands does not fill the log.
REPEAT = 1.0


class Commands:
    """Subscribes to trajectories, stiffnesses and targets of fingertips."""

    def __init__(self, node: Node, hand: sun2xp.Hand, fingers: Sequence[int], prefix: str) -> None:
        self._node = node
        self._hand = hand
        self._fingers = fingers
        self._prefix = prefix
        self._said: Dict[str, float] = {}
        self._waiting = WaitingTrajectories(node)
        #: Pose of each finger's frame in the palm's frame: the origin, cm, and the axes as columns.
        self._mounts: Dict[int, Tuple[numpy.ndarray, numpy.ndarray]] = {}
        subscribe = partial(self._subscribe, node)
        subscribe(JointTrajectory, "joint_trajectory", "trajectory", self._move)
        for finger in fingers:
            pose = hand.palm_pose(finger)
            self._mounts[finger] = (pose.base, pose.rotation)
            name = f"finger{finger}"
            subscribe(PointStamped, f"{name}/target", f"target of {name}", partial(self._aim, finger))
            subscribe(Float64MultiArray, f"{name}/stiffness", f"stiffness of {name}", partial(self._soften, finger))

    def forget(self, finger: int) -> None:
        """Drops the trajectories of a finger that wait for their stamps, because the finger was stopped."""
        self._waiting.forget([finger])

    def _subscribe(self, node: Node, kind: Any, topic: str, what: str, action: Callable[[Any], None]) -> None:
        node.create_subscription(kind, topic, lambda message: self._take(what, partial(action, message)), 10)

    def _take(self, what: str, action: Callable[[], None]) -> None:
        try:
            action()
        except (sun2xp.Error, Unusable) as refusal:
            self._refuse(f"{what} refused: {refusal}")

    def _refuse(self, text: str) -> None:
        now = time.monotonic()
        self._said = {line: since for line, since in self._said.items() if now - since < REPEAT}
        if text not in self._said:
            self._said[text] = now
            self._node.get_logger().error(text)

    def _now(self) -> float:
        return self._node.get_clock().now().nanoseconds * 1e-9

    def _move(self, message: JointTrajectory) -> None:
        if not message.points:
            # An empty trajectory stops the motion, as it does with other controllers of ROS.
            self._waiting.forget(self._fingers)
            self._hold(self._fingers)
            return
        now = self._now()
        demanded = [path.finger for path in paths(message, self._prefix, self._fingers, now)]
        delay = begins_in(message, now)
        if delay:
            self._waiting.add(delay, demanded, partial(self._begin_at_stamp, message))
        else:
            self._begin(message, demanded)

    def _begin_at_stamp(self, message: JointTrajectory, fingers: Collection[int]) -> None:
        self._take("trajectory", partial(self._begin, message, fingers, waited=True))

    def _begin(self, message: JointTrajectory, fingers: Collection[int], *, waited: bool = False) -> None:
        """Sends the paths of these fingers."""
        demanded = paths(message, self._prefix, self._fingers, self._now(), waited=waited)
        demanded = [path for path in demanded if path.finger in fingers]
        for path in demanded:
            try:
                self._follow(path)
            except sun2xp.Error:
                # A path moves one finger only. If a finger refuses its path, the others must execute neither this
                # trajectory nor the one before it, because the fingers of a trajectory move together.
                others = [other.finger for other in demanded if other is not path]
                self._waiting.forget(others)
                self._take("stop of the other fingers", partial(self._hold, others))
                raise
        self._waiting.forget(fingers)

    def _follow(self, path: Path) -> None:
        if len(path.times):
            self._hand.send_path(path.finger, path.times, joints=path.joints)
        else:
            self._hand.send_position(path.finger, path.joints[0])

    def _hold(self, fingers: Sequence[int]) -> None:
        """Sends each of these fingers its present pose. A joint can be slightly beyond a limit, and the hand would
        refuse its angle. Such a joint gets the limit instead."""
        refused: Optional[sun2xp.Error] = None
        for finger in fingers:
            try:
                low, high = self._hand.limits(finger).joints
                self._hand.send_position(finger, numpy.clip(self._hand.position(finger), low, high))
            except sun2xp.Error as refusal:
                refused = refusal
        if refused is not None:
            raise refused

    def _aim(self, finger: int, message: PointStamped) -> None:
        point = CM_PER_M * numpy.array([message.point.x, message.point.y, message.point.z])
        frame = message.header.frame_id
        palm, base = names.palm(self._prefix), names.base(self._prefix, finger)
        if frame == palm:
            origin, axes = self._mounts[finger]
            point = axes.T @ (point - origin)
        elif frame != base:
            raise Unusable(f"the frame is {frame!r}: send the point in {palm!r} or {base!r}")
        self._hand.send_tip(finger, point)
        self._waiting.forget([finger])

    def _soften(self, finger: int, message: Float64MultiArray) -> None:
        numbers = list(message.data)[message.layout.data_offset :]
        sizes = [dimension.size for dimension in message.layout.dim]
        if len(numbers) != 9 or sizes not in ([], [9], [3, 3]):
            found = f"the message has {len(numbers)} numbers and the dimensions {sizes}"
            raise Unusable(f"{found}: send a 3 x 3 matrix in N/m, row by row")
        self._hand.send_stiffness(finger, numpy.reshape(numbers, (3, 3)) / CM_PER_M)

"""The node: publishes what the hand measures, and passes on what planners send.

The servos are threads of the library that run no Python, so nothing here delays them."""

from __future__ import annotations

import logging
from typing import Any, Dict, List, Optional, Sequence, Tuple

import rclpy
import sun2xp
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Vector3, Wrench, WrenchStamped
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor
from rclpy.clock import Clock, ClockType
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from . import names
from .commands import Commands
from .diagnostics import FingerDiagnostics
from .moment import Moment
from .services import Services

#: N cm in an N m.
N_CM_PER_N_M = 100.0

#: The fingers that a hand may have.
FINGERS = (1, 2, 3)

#: Interval at which the node looks for new faults, s. It does not depend on the rates of the topics.
FAULT_WATCH = 0.01


class _ToRos(logging.Handler):
    """Passes the messages of the library to the log of the node."""

    def __init__(self, node: Node) -> None:
        super().__init__()
        self._logger = node.get_logger()

    def emit(self, record: logging.LogRecord) -> None:
        self._logger.warning(record.getMessage())


class HandNode(Node):
    """A node with a hand. The constructor opens the hand, and `destroy_node` closes it."""

    def __init__(self, **options: Any) -> None:
        """Opens the hand. Options are those of `rclpy.node.Node`.

        Raises:
            sun2xp.Error: the hand was not opened, or faulted at once.
        """
        self.hand: Any = None
        self._serves: Optional[Services] = None
        super().__init__("sun2xp", **options)
        self._handler = _ToRos(self)
        logging.getLogger("sun2xp").addHandler(self._handler)
        try:
            self._start()
        except BaseException:
            # Otherwise the node outlives its context, and the process may not end.
            self.destroy_node()
            raise

    def _start(self) -> None:
        # A parameter that is wrong ends the node before the hand moves.
        self._prefix: str = self._parameter("prefix", "", "prefix of the names of joints and frames")
        rate = self._parameter("rate", 100.0, "rate of joint states and wrenches, Hz", (1.0, 1000.0))
        slow = self._parameter("diagnostics_rate", 1.0, "rate of diagnostics, Hz", (0.1, 10.0))
        self.hand = self._open()
        self.fingers = [finger for finger in FINGERS if self._has(finger)]
        self._publish_description()
        self._joint_states = self.create_publisher(JointState, "joint_states", 10)
        self._wrenches = {
            finger: self.create_publisher(WrenchStamped, f"finger{finger}/wrench", 10) for finger in self.fingers
        }
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._described = [
            FingerDiagnostics(self.hand, finger, f"{self._prefix}finger{finger}") for finger in self.fingers
        ]
        #: For each finger: the measurement that was published last, and the mean rates that were published with it.
        self._before: Dict[int, Tuple[sun2xp.JointState, Any]] = {}
        self._faults = [described.fault() for described in self._described]
        self._takes = Commands(self, self.hand, self.fingers, self._prefix)
        self._serves = Services(self, self.hand, self.fingers, self._takes.forget)
        # Timers on the clock of ROS would pause while the simulated time stands still, and after the system's clock was
        # set back.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(1.0 / rate, self._publish_measurements, clock=steady)
        self.create_timer(1.0 / slow, self._publish_diagnostics, clock=steady)
        self.create_timer(FAULT_WATCH, self._watch_faults, clock=steady)

    def destroy_node(self) -> None:
        """Closes the hand, which brings every finger to its end state, and ends the node."""
        if self.hand is not None:
            self.hand.close()
        if self._serves is not None:
            self._serves.close()
        logging.getLogger("sun2xp").removeHandler(self._handler)
        super().destroy_node()

    def _parameter(self, name: str, default: Any, description: str, bounds: Optional[Sequence[float]] = None) -> Any:
        descriptor = ParameterDescriptor(description=description, read_only=True)
        if bounds is not None:
            descriptor.floating_point_range = [FloatingPointRange(from_value=bounds[0], to_value=bounds[1])]
        return self.declare_parameter(name, default, descriptor).value

    def _open(self) -> sun2xp.Hand:
        path = self._parameter("configuration", "", "configuration file; empty: the one that the library finds")
        simulated = self._parameter("simulated", "", "name of a simulated hand instead of a configuration file")
        if simulated:
            return sun2xp.simulated(simulated)
        return sun2xp.open(path or None)

    def _has(self, finger: int) -> bool:
        try:
            self.hand.status(finger)
        except sun2xp.Refused:
            return False
        return True

    def _publish_description(self) -> None:
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._description = self.create_publisher(String, "robot_description", latched)
        self._description.publish(String(data=names.with_prefix(self.hand.urdf(), self._prefix)))

    def _publish_measurements(self) -> None:
        message, now = JointState(), Moment(self.get_clock())
        times: List[int] = []
        for finger in self.fingers:
            try:
                state = self.hand.joint_state(finger)
                self._publish_wrench(finger, now.on_ros.to_msg())
            except sun2xp.Error:
                # A finger that has stopped measures nothing. Diagnostics have the reason.
                self._before.pop(finger, None)
                continue
            times.append(state.time)
            message.name.extend(names.joints(self._prefix, finger))
            message.position.extend(state.position)
            message.velocity.extend(self._mean_rate(finger, state))
            message.effort.extend(state.torque / N_CM_PER_N_M)
        # The time of the oldest measurement.
        message.header.stamp = now.time_of(min(times, default=now.monotonic)).to_msg()
        self._joint_states.publish(message)

    def _watch_faults(self) -> None:
        faults = [described.fault() for described in self._described]
        if faults != self._faults:
            self._faults = faults
            self._publish_diagnostics()

    def _mean_rate(self, finger: int, state: sun2xp.JointState) -> Any:
        """The mean rate since the previous message. The rate in a single cycle has the noise of the encoders. If the
        finger has begun no new cycle since the previous message, the mean rate of that message is repeated."""
        if finger not in self._before:
            mean = state.rate
        else:
            before, mean = self._before[finger]
            if state.time <= before.time:
                return mean
            mean = (state.position - before.position) / (state.time - before.time) * 1e9
        self._before[finger] = (state, mean)
        return mean

    def _publish_wrench(self, finger: int, stamp: Any) -> None:
        tip, pose = self.hand.tip(finger), self.hand.palm_pose(finger)
        # The library reports the force on the touched object, in the finger's frame.
        force = -(pose.tip_rotation.T @ pose.rotation @ tip.contact_force)
        message = WrenchStamped(wrench=Wrench(force=Vector3(x=force[0], y=force[1], z=force[2])))
        message.header.stamp = stamp
        message.header.frame_id = names.tip(self._prefix, finger)
        self._wrenches[finger].publish(message)

    def _publish_diagnostics(self) -> None:
        message = DiagnosticArray(status=[described.status() for described in self._described])
        message.header.stamp = self.get_clock().now().to_msg()
        self._diagnostics.publish(message)


def main(arguments: Optional[List[str]] = None) -> int:
    """Runs the node until it is interrupted. Returns the exit status."""
    rclpy.init(args=arguments)
    node = None
    try:
        node = HandNode()
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except sun2xp.Error as error:
        rclpy.logging.get_logger("sun2xp").fatal(f"the node was not started: {error}")
        return 1
    finally:
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0

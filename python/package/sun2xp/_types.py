"""The results of calls. Lengths are in cm, forces in N, torques in N cm, angles in rad, stiffnesses in N/cm.

An array has no single truth value, so `==` does not compare the values of two results.
"""

from __future__ import annotations

import dataclasses
import enum
from typing import Optional, Tuple

import numpy
import numpy.typing

Array = numpy.typing.NDArray[numpy.float64]


@dataclasses.dataclass(frozen=True, eq=False)
class SetPoint:
    """A set point of one finger for `Hand.send_group`. The finger keeps the values whose fields are None."""

    #: Number of the finger, 1 to 3.
    finger: int
    #: Desired angles of joints 0, 1 and 2, rad: shape (3,). Do not set it together with `tip`.
    position: Optional[numpy.typing.ArrayLike] = None
    #: Desired position of the tip in the finger's frame, cm: shape (3,).
    tip: Optional[numpy.typing.ArrayLike] = None
    #: Kx in the finger's frame, N/cm: shape (3, 3).
    stiffness: Optional[numpy.typing.ArrayLike] = None
    #: Damping, relative to the damping that the controller chooses.
    damping: Optional[float] = None


@dataclasses.dataclass(frozen=True, eq=False)
class Distribution:
    """The distribution of a duration, microseconds."""

    #: Number of cycles.
    count: int
    #: Shortest duration.
    minimum: float
    #: Median.
    median: float
    #: 99 % of the durations are not longer.
    p99: float
    #: 99.9 % of the durations are not longer.
    p999: float
    #: Longest duration.
    maximum: float


@dataclasses.dataclass(frozen=True, eq=False)
class Losses:
    """Counts of a finger's cycles, and of the errors in them."""

    #: Number of cycles.
    cycles: int
    #: Cycles that ended after the next one should have begun.
    overruns: int
    #: Whole periods in which no cycle began because the previous cycle was late or the servo thread did not run.
    skipped_periods: int
    #: Cycles without a valid reply in time.
    lost_replies: int
    #: Replies that arrived after the end of their cycle.
    late_replies: int
    #: Replies that arrived twice.
    duplicate_replies: int
    #: Byte sequences on the finger's port that were not valid frames.
    damaged_replies: int
    #: Valid frames on the finger's port that no finger waited for.
    foreign_frames: int


@dataclasses.dataclass(frozen=True, eq=False)
class Status:
    """The status of a finger and of its servo thread."""

    #: "opening", "limp", "calibrating", "running", "closing", "closed" or "faulted".
    stage: str
    #: Whether every servo thread runs under SCHED_FIFO.
    realtime: bool
    #: Whether every servo thread has its memory locked.
    memory_locked: bool
    #: Whether every servo thread runs on its configured core, if one is configured.
    on_core: bool
    #: Configured rate, Hz.
    rate: float
    #: Measured rate since open, Hz.
    measured_rate: float
    #: Time from the scheduled beginning of a cycle to its first instruction, microseconds.
    wake_up: Distribution
    #: Cycles and errors since open.
    losses: Losses
    #: Part of the desired joint torque that the tension limits permitted in the last cycle, 0 to 1.
    torque_scale: float
    #: Part of Kx that was applied in the last cycle, 0 to 1.
    stiffness_scale: float
    #: Completed part of the calibration in progress, 0 to 1; 0 if there is none.
    calibration: float


@dataclasses.dataclass(frozen=True, eq=False)
class Tip:
    """The state of a fingertip, in the finger's frame."""

    #: Position from the measured joint angles, cm: shape (3,).
    position: Array
    #: Force on the touched object from the measured tensions, N: shape (3,). It includes friction, weight and
    #: acceleration of the finger.
    force: Array
    #: Number of directions in which a force at the tip causes joint torques: 3, or fewer near a singular pose.
    force_directions: int
    #: Measured tensions of tendons 1 to 4, N: shape (4,).
    tensions: Array
    #: Stiffness that is in effect, N/cm: shape (3, 3).
    stiffness: Array
    #: Force on the touched object without friction, weight and acceleration of the finger, N: shape (3,).
    contact_force: Array
    #: Whether the finger touches something, as far as tensions and motion show it.
    touching: bool
    #: Speed of the tip perpendicular to `contact_force` while it touches something, cm/s.
    slide_speed: float


@dataclasses.dataclass(frozen=True, eq=False)
class JointTorques:
    """The torques of joints 0, 1 and 2, N cm."""

    #: From the measured tensions: shape (3,).
    measured: Array
    #: Commanded by the controller, scaled down to what the tension bounds permit: shape (3,).
    commanded: Array


@dataclasses.dataclass(frozen=True, eq=False)
class JointState:
    """The motion of joints 0, 1 and 2 in the last cycle of a finger."""

    #: Beginning of this cycle, ns of CLOCK_MONOTONIC, as `time.monotonic_ns` counts.
    time: int
    #: Measured angles, rad: shape (3,).
    position: Array
    #: Measured rates, rad/s: shape (3,).
    rate: Array
    #: Torques from the measured tensions, N cm: shape (3,). They may belong to the next cycle.
    torque: Array


@dataclasses.dataclass(frozen=True, eq=False)
class PalmPose:
    """Where a finger and its tip are in the palm's frame."""

    #: Origin of the finger's frame, cm: shape (3,).
    base: Array
    #: Axes of the finger's frame as columns: shape (3, 3).
    rotation: Array
    #: Position of the tip, cm: shape (3,).
    tip: Array
    #: Axes of the last link as columns: shape (3, 3).
    tip_rotation: Array


@dataclasses.dataclass(frozen=True, eq=False)
class Limits:
    """The limits of a finger."""

    #: Lower limits (row 0) and upper limits (row 1) of joints 0, 1 and 2, rad: shape (2, 3).
    joints: Array
    #: Smallest and largest tension of a tendon, N.
    tension: Tuple[float, float]
    #: Largest torques of motors 1 to 4, N cm: shape (4,).
    motor_torque: Array
    #: Largest eigenvalue of Kx, N/cm.
    stiffness: float
    #: Largest joint speed on a path, rad/s.
    speed: float
    #: Largest joint acceleration on a path, rad/s^2.
    acceleration: float
    #: Largest joint jerk on a path, rad/s^3.
    jerk: float


@dataclasses.dataclass(frozen=True, eq=False)
class ObjectState:
    """The object that simulated fingers touch, in the palm's frame."""

    #: Simulated time since the boards started, s.
    time: float
    #: Position of the centre of mass, cm: shape (3,).
    position: Array
    #: Rotation from the object's frame to the palm's: shape (3, 3).
    rotation: Array
    #: Velocity of the centre of mass, cm/s: shape (3,).
    velocity: Array
    #: Angular velocity, rad/s: shape (3,).
    angular_velocity: Array
    #: Force of each finger on the object, N: shape (3, 3), with one row for each finger.
    forces: Array


@dataclasses.dataclass(frozen=True, eq=False)
class TouchReading:
    """The newest reading of a tactile element."""

    #: Whether the board has reported this element since open and since its last reset, and could read it then.
    #: Otherwise the other fields are 0.
    valid: bool
    #: Whether something presses the element.
    pressed: bool
    #: The raw count.
    count: int
    #: The force on the element, N.
    force: float


@dataclasses.dataclass(frozen=True, eq=False)
class FaultDescription:
    """A fault or a warning."""

    #: Number, as in docs/faults.md.
    number: int
    #: Name, such as "broken tendon".
    name: str
    #: The part that has the fault, such as "tendon 3", or "finger".
    part: str
    #: Value of the fault in the unit of docs/faults.md; 0 if there is none.
    value: float
    #: What has happened, the likely cause and the remedy.
    text: str
    #: What to do.
    remedy: str


@dataclasses.dataclass(frozen=True, eq=False)
class FingerFault:
    """The fault and the warnings of a finger."""

    #: The fault that has stopped the finger; None if it has not stopped.
    stopped: Optional[FaultDescription]
    #: The newest warning of the last second. If there is none and the system does not permit real time, the warning
    #: about that, which `warnings` does not count.
    warning: Optional[FaultDescription]
    #: Number of warnings since open. A warning that persists counts once.
    warnings: int


class EventKind(enum.IntEnum):
    """The kind of an event (docs/events.md)."""

    TOUCH_MADE = 1
    TOUCH_LOST = 2
    TOUCH_SLIP = 3
    TOUCH_PRESSURE = 4
    CONTACT = 5
    CONTACT_LOST = 6
    SLIP = 7
    TENSION_BOUND = 8
    FORCE_BOUND = 9
    JOINT_AT_LIMIT = 10
    ARRIVED = 11
    SETTLED = 12
    FAULT = 13
    WARNING = 14
    REFLEX_FIRED = 15
    PATH_ENDED = 16
    EXPIRED = 17
    TOUCH_INVALID = 18


@dataclasses.dataclass(frozen=True, eq=False)
class Event:
    """Something that happened to a finger in one cycle of its servo."""

    #: Number of the finger, 1 to 3.
    finger: int
    #: Number of the cycle, from 1, separately for each finger.
    cycle: int
    #: Beginning of this cycle, ns of CLOCK_MONOTONIC, as `time.monotonic_ns` counts.
    time: int
    #: Kind of the event.
    kind: EventKind
    #: The part that the event concerns, such as "tendon 3", or "finger".
    part: str
    #: Values, with the meanings and units of the kind (docs/events.md).
    values: Tuple[float, ...]
    #: What happened, in words.
    text: str


@dataclasses.dataclass(frozen=True, eq=False)
class Signs:
    """The directions in which motors, encoders and gauges 1 to 4 count: 1 or -1."""

    #: `motor.sign`.
    motor: Tuple[int, int, int, int]
    #: `encoder.sign`.
    encoder: Tuple[int, int, int, int]
    #: 1 if the gauge's count rises with the tension.
    gauge: Tuple[int, int, int, int]


@dataclasses.dataclass(frozen=True, eq=False)
class Zeros:
    """The zeros of the sensors."""

    #: `encoder.zero`, counts.
    encoder: Tuple[int, int, int, int]
    #: `gauge.zero`, counts: shape (4,).
    gauge: Array
    #: Error of the joint angles before zeroing, rad: shape (3,).
    joint_error: Array
    #: Measured minus configured angle between the two stops of each joint, rad: shape (3,). None if the routine did not
    #: move to the stops.
    range_error: Optional[Array]


@dataclasses.dataclass(frozen=True, eq=False)
class Identified:
    """Friction and elasticity of a finger."""

    #: `tendon.stiffness`, N/cm: shape (4,).
    tendon_stiffness: Array
    #: `tendon.stiffness_tolerance`, a fraction.
    stiffness_tolerance: float
    #: Part of the motors' travel that the identified elasticity does not explain: rms residual, cm.
    travel_residual: float
    #: `friction.motor_coulomb`, N cm of commanded torque: shape (4,).
    motor_coulomb: Array
    #: `friction.conduit`: shape (4,).
    conduit: Array
    #: `friction.pulley`: shape (4,).
    pulley: Array
    #: Factors for `gauge.newton_per_count`: shape (4,).
    gauge_gain: Array
    #: Ratio of each motor's true torque to its commanded torque: shape (4,).
    motor_ratio: Array
    #: `friction.joint_coulomb`, N cm: shape (3,).
    joint_coulomb: Array
    #: Viscous friction of the joints, N cm s/rad: shape (3,).
    joint_viscous: Array
    #: Measured moment arms `geometry.r`, cm: shape (3, 4). None if they agree with the configured ones.
    moment_arms: Optional[Array]


@dataclasses.dataclass(frozen=True, eq=False)
class Mark:
    """Something that happened in a recording."""

    #: Time, ns of CLOCK_MONOTONIC.
    time: int
    #: Number of the finger; None for the whole hand.
    finger: Optional[int]
    #: Number of the cycle; None if the mark belongs to no cycle.
    cycle: Optional[int]
    #: "stage", "event", "gap", "warning" or "fault".
    kind: str
    #: What happened, in words.
    text: str

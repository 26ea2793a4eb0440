"""Where a finger is, and what it touches."""

from __future__ import annotations

import dataclasses

import numpy
import numpy.typing

Array = numpy.typing.NDArray[numpy.float64]


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
    #: Stiffness of the tip in its present pose, N/cm: shape (3, 3). After a change of Kx, this field has its new value
    #: in the next cycle, although the stiffness of the finger changes over 50 ms.
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

    #: Whether the board could read the element when it reported the element last. False if the board has not reported
    #: the element since the hand was opened, or since the last reset of the board. If false, the other fields are 0.
    valid: bool
    #: Whether something presses the element.
    pressed: bool
    #: The raw count.
    count: int
    #: The force on the element, N.
    force: float

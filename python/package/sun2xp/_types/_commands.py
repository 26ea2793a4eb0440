"""Set points, and the limits of a finger."""

from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

import numpy.typing

from ._state import Array


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
class Limits:
    """The limits of a finger."""

    #: Lower limits (row 0) and upper limits (row 1) of joints 0, 1 and 2, rad: shape (2, 3).
    joints: Array
    #: Smallest and largest tension of a tendon, N.
    tension: Tuple[float, float]
    #: Largest torques of motors 1 to 4, N cm: shape (4,).
    motor_torque: Array
    #: Largest eigenvalue of Kx that the finger admits, N/cm.
    stiffness: float
    #: Largest joint speed on a path, rad/s.
    speed: float
    #: Largest joint acceleration on a path, rad/s^2.
    acceleration: float
    #: Largest joint jerk on a path, rad/s^3.
    jerk: float

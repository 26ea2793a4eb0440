"""What a calibration has found. A name in backquotes is the key of `[finger]` to which the values belong."""

from __future__ import annotations

import dataclasses
from typing import Optional, Tuple

from ._state import Array


@dataclasses.dataclass(frozen=True, eq=False)
class Signs:
    """The signs of motors, encoders and gauges 1 to 4: 1 or -1."""

    #: 1 if a positive command pulls the tendon, else -1: `motor.sign`.
    motor: Tuple[int, int, int, int]
    #: 1 if the encoder's count rises as the tendon is pulled in, else -1: `encoder.sign`.
    encoder: Tuple[int, int, int, int]
    #: 1 if the gauge's count rises with the tension, -1 if it falls.
    gauge: Tuple[int, int, int, int]


@dataclasses.dataclass(frozen=True, eq=False)
class Zeros:
    """The zeros of the sensors."""

    #: Zeros of the encoders, `encoder.zero`, counts.
    encoder: Tuple[int, int, int, int]
    #: Zeros of the gauges, `gauge.zero`, counts: shape (4,).
    gauge: Array
    #: Error of the joint angles before zeroing, rad: shape (3,).
    joint_error: Array
    #: Measured minus configured angle between the two stops of each joint, rad: shape (3,). None if the joints were not
    #: moved to their stops.
    range_error: Optional[Array]


@dataclasses.dataclass(frozen=True, eq=False)
class Identified:
    """Friction, elasticity and rotor inertia of a finger."""

    #: Stiffness of each tendon, `tendon.stiffness`, N/cm: shape (4,).
    tendon_stiffness: Array
    #: Relative uncertainty of the tendon stiffnesses, `tendon.stiffness_tolerance`.
    stiffness_tolerance: float
    #: Part of the motors' travel that the identified elasticity does not explain: rms residual, cm.
    travel_residual: float
    #: Coulomb friction of each motor, `friction.motor_coulomb`, N cm of commanded torque: shape (4,).
    motor_coulomb: Array
    #: Conduit friction of each tendon, `friction.conduit`, as a part of the tension's torque at the motor: shape (4,).
    conduit: Array
    #: Pulley friction of each tendon, `friction.pulley`: the largest difference of the tensions on the two sides of the
    #: pulleys, as a part of the smaller tension: shape (4,).
    pulley: Array
    #: Factors by which the calibration has multiplied `gauge.newton_per_count`: shape (4,).
    gauge_gain: Array
    #: Ratio of each motor's true torque to its commanded torque: shape (4,).
    motor_ratio: Array
    #: Coulomb friction of each joint, `friction.joint_coulomb`, N cm: shape (3,).
    joint_coulomb: Array
    #: Viscous friction of the joints, N cm s/rad: shape (3,).
    joint_viscous: Array
    #: Inertia of each rotor, divided by the ratio of true to commanded torque, `motor.inertia`, kg m^2: shape (4,). A
    #: rotor that could not be measured has its configured value. None if no measured value differs from the configured
    #: one.
    rotor_inertia: Optional[Array]
    #: Measured moment arms `geometry.r`, cm: shape (3, 4). None if they were not measured,
    #: or agree with the configured ones.
    moment_arms: Optional[Array]

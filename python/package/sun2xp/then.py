"""Reactions of reflexes, for `Hand.install_reflex`. The set point of a reaction is in force until the planner sends
another one, or until the time at which the planner's last set point would have expired."""

from __future__ import annotations

from typing import Any, Tuple

import numpy.typing

Reaction = Tuple[Any, ...]


def stop() -> Reaction:
    """The finger stops with a fault."""
    return ("stop",)


def hold() -> Reaction:
    """The finger holds its present pose."""
    return ("hold",)


def soften(stiffness: numpy.typing.ArrayLike) -> Reaction:
    """The spring gets this Kx, N/cm, shape (3, 3), and the damping ratio 1."""
    return ("soften", stiffness)


def retract(joints: numpy.typing.ArrayLike) -> Reaction:
    """The finger goes to these joint angles, rad: shape (3,)."""
    return ("retract", joints)


def grip(by: float, most: float, direction: numpy.typing.ArrayLike = (0.0, 0.0, 0.0)) -> Reaction:
    """The tip presses harder.

    Args:
        by: increase of the force, N.
        most: largest force, N.
        direction: direction of the force in the finger's frame: a vector of any magnitude, shape (3,). If it is zero,
            the tip presses harder in the direction in which the spring presses now.
    """
    return ("grip", by, most, direction)


def damp(ratio: float) -> Reaction:
    """The spring gets this damping ratio, or the nearest one that its stiffness admits."""
    return ("damp", ratio)

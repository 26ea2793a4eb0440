"""Conditions of reflexes, for `Hand.install_reflex`. A servo checks them in every cycle."""

from __future__ import annotations

from typing import Any, Tuple

from ._types import EventKind

Condition = Tuple[Any, ...]


def event(kind: EventKind) -> Condition:
    """An event of the finger that has the reflex."""
    return ("event", int(kind))


def other_finger(finger: int, kind: EventKind) -> Condition:
    """An event of another finger of the hand, 1 to 3."""
    return ("other_finger", finger, int(kind))


def force_above(force: float) -> Condition:
    """The force of the surroundings on the tip is above this value, N."""
    return ("force_above", force)


def tension_above(tension: float) -> Condition:
    """The tension of any tendon is above this value, N."""
    return ("tension_above", tension)


def tension_below(tension: float) -> Condition:
    """The tension of any tendon is below this value, N."""
    return ("tension_below", tension)


def joint_above(joint: int, angle: float) -> Condition:
    """The angle of joint 0, 1 or 2 is above this value, rad."""
    return ("joint_above", joint, angle)


def joint_below(joint: int, angle: float) -> Condition:
    """The angle of joint 0, 1 or 2 is below this value, rad."""
    return ("joint_below", joint, angle)


def link_lost(time: float) -> Condition:
    """The board has not replied for this time, s."""
    return ("link_lost", time)


def planner_silent(time: float) -> Condition:
    """The planner has sent no set point for this time, s."""
    return ("planner_silent", time)

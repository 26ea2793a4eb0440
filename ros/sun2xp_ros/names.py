"""Names of joints and frames: those of the URDF that `sun2xp model --urdf` writes."""

from __future__ import annotations

from typing import Iterable, List
from xml.etree import ElementTree

#: Joints of a finger.
JOINTS = 3


def joints(prefix: str, finger: int) -> List[str]:
    """The names of joints 0, 1 and 2 of a finger."""
    return [f"{prefix}finger{finger}_joint{joint}" for joint in range(JOINTS)]


def palm(prefix: str) -> str:
    """The frame of the palm."""
    return f"{prefix}palm"


def base(prefix: str, finger: int) -> str:
    """The frame of a finger, in which its stiffness is given (Figure 8 of COINS TR 90-48)."""
    return f"{prefix}finger{finger}_base"


def tip(prefix: str, finger: int) -> str:
    """The frame of a fingertip, with the axes of the last link."""
    return f"{prefix}finger{finger}_tip"


def with_prefix(urdf: str, prefix: str) -> str:
    """Returns the URDF with the prefix before the name of every link and joint."""
    robot = ElementTree.fromstring(urdf)
    named: Iterable[ElementTree.Element] = [*robot.findall("link"), *robot.findall("joint")]
    for element in named:
        element.set("name", prefix + element.get("name", ""))
    for joint in robot.findall("joint"):
        for end in [*joint.findall("parent"), *joint.findall("child")]:
            end.set("link", prefix + end.get("link", ""))
    return ElementTree.tostring(robot, encoding="unicode")

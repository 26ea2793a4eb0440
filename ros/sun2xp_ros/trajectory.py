"""Trajectories of ROS as paths of fingers. Needs no ROS, so that every rule can be tested without it."""

from __future__ import annotations

import dataclasses
from typing import Any, Dict, List, Sequence

import numpy

from . import names


#: Shortest time of the first pose of a path, s. The library refuses shorter ones.
SHORTEST = 1e-3


class Unusable(Exception):
    """A message that no hand can execute."""


@dataclasses.dataclass
class Path:
    """What a trajectory demands of one finger."""

    finger: int
    #: Times from the beginning of the path, s. Empty: `joints` has one row, the pose to take at once.
    times: numpy.ndarray
    #: Angles of joints 0, 1 and 2, rad: a row for each time.
    joints: numpy.ndarray


def seconds(duration: Any) -> float:
    """The seconds of a message of the type Time or Duration."""
    return duration.sec + duration.nanosec * 1e-9


def begins_in(message: Any, now: float) -> float:
    """The time from now until the stamp of a trajectory, s; 0 if it has no stamp or its stamp has passed."""
    stamp = seconds(message.header.stamp)
    return max(stamp - now, 0.0) if stamp else 0.0


def paths(message: Any, prefix: str, fingers: Sequence[int], now: float, *, waited: bool = False) -> List[Path]:
    """Returns the paths of a trajectory with at least one point. A path begins when the hand gets it. If the stamp is
    in the future, the times of the paths count from the stamp, so the caller must wait until the stamp (`begins_in`)
    before it sends the paths to the hand. If the stamp has passed, the paths begin now, and the points that have passed
    are left out.

    Args:
        message: a trajectory_msgs/JointTrajectory. It names all joints of each finger that it moves.
        prefix: the prefix of the names of joints.
        fingers: the fingers that the hand has.
        now: the time of the ROS clock, s. A trajectory without a stamp begins now.
        waited: whether the trajectory has waited for its stamp. A timer is always a little late. A pose that is to be
            taken at the stamp must not count as past because of this delay.
    """
    columns = _columns(message.joint_names, prefix, fingers)
    positions = [list(point.positions) for point in message.points]
    for place, angles in enumerate(positions):
        if len(angles) != len(message.joint_names):
            found = f"point {place} has {len(angles)} positions for {len(message.joint_names)} joints"
            raise Unusable(f"{found}: give every joint of joint_names one position")
    stamp = seconds(message.header.stamp)
    late = max(now - stamp, 0.0) if stamp else 0.0
    since_stamp = numpy.array([seconds(point.time_from_start) for point in message.points])
    times = since_stamp - late
    # Planners often send the present state as the point at the time 0. A path begins there anyway.
    ahead = times >= SHORTEST
    if not ahead.any():
        is_step = waited and since_stamp.max() < SHORTEST
        if late and not is_step:
            ago = max(-times.max(), 0.0)
            raise Unusable(f"the trajectory ended {ago:.3f} s ago: send it earlier, or without a stamp")
        times, positions = times[:0], positions[-1:]
    else:
        times = times[ahead]
        positions = [angles for angles, later in zip(positions, ahead) if later]
    return [Path(finger, times, numpy.array(positions)[:, places]) for finger, places in columns.items()]


def _columns(given: Sequence[str], prefix: str, fingers: Sequence[int]) -> Dict[int, List[int]]:
    """Returns for each finger the places of its joints in the message."""
    given = list(given)
    known = {finger: names.joints(prefix, finger) for finger in fingers}
    every = [name for joints in known.values() for name in joints]
    unknown = [name for name in given if name not in every]
    if unknown or not given:
        raise Unusable(f"there is no joint {', '.join(unknown) or 'in joint_names'}: the joints are {', '.join(every)}")
    if len(set(given)) != len(given):
        twice = [name for name in dict.fromkeys(given) if given.count(name) > 1]
        raise Unusable(f"{', '.join(twice)} is named twice: name every joint once")
    columns = {}
    for finger, joints in known.items():
        missing = [name for name in joints if name not in given]
        if not missing:
            columns[finger] = [given.index(name) for name in joints]
        elif len(missing) < len(joints):
            raise Unusable(f"{', '.join(missing)} is missing: name all joints of a finger")
    return columns

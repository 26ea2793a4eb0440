"""Tests of the conversion of trajectories to paths of fingers. They need no hand and no ROS nodes."""

import numpy
import pytest
from builtin_interfaces.msg import Duration, Time
from sun2xp_ros.trajectory import Unusable, begins_in, paths
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

NAMES = [f"finger{finger}_joint{joint}" for finger in (1, 3) for joint in (0, 1, 2)]


def message(times, stamp=0, names=None):
    names = NAMES if names is None else names
    result = JointTrajectory(joint_names=names)
    result.header.stamp = Time(sec=stamp)
    for time in times:
        angles = [time + 0.1 * place for place in range(len(names))]
        since = Duration(sec=int(time), nanosec=round(time % 1 * 1e9))
        result.points.append(JointTrajectoryPoint(positions=angles, time_from_start=since))
    return result


def test_columns_are_those_of_the_names():
    first, second = paths(message([1.0, 2.5], names=NAMES[::-1]), "", (1, 3), now=5.0)
    assert (first.finger, second.finger) == (1, 3)
    assert first.times.tolist() == second.times.tolist() == [1.0, 2.5]
    assert numpy.allclose(first.joints, [[1.5, 1.4, 1.3], [3.0, 2.9, 2.8]])
    assert numpy.allclose(second.joints, [[1.2, 1.1, 1.0], [2.7, 2.6, 2.5]])


def test_points_of_the_past_are_left_out():
    (path, _) = paths(message([0.0, 1.0, 2.0], stamp=10), "", (1, 3), now=11.5)
    assert path.times.tolist() == [0.5] and path.joints[0, 0] == 2.0
    with pytest.raises(Unusable, match="ended 3.000 s ago"):
        paths(message([0.0, 1.0, 2.0], stamp=10), "", (1, 3), now=15.0)


def test_a_point_that_is_nearly_past_is_left_out():
    """The library refuses a path whose first pose is less than 1 ms ahead."""
    (path, _) = paths(message([0.0, 1.0, 2.0], stamp=10), "", (1, 3), now=10.9995)
    assert path.times.tolist() == pytest.approx([1.0005])


def test_a_stamp_in_the_future_delays_the_beginning_and_not_the_points():
    later = message([0.0, 1.0, 2.0], stamp=10)
    assert begins_in(later, 8.5) == 1.5 and begins_in(later, 10.5) == 0.0 and begins_in(message([1.0]), 8.5) == 0.0
    (path, _) = paths(later, "", (1, 3), now=8.5)
    assert path.times.tolist() == [1.0, 2.0]


def test_a_point_at_the_time_0_is_a_pose_to_take_at_once():
    (path, _) = paths(message([0.0]), "", (1, 3), now=5.0)
    assert path.times.size == 0 and path.joints.shape == (1, 3)


@pytest.mark.parametrize(
    ("names", "text"),
    [
        (NAMES[:2], "finger1_joint2 is missing"),
        ([*NAMES, "finger2_joint0"], "there is no joint finger2_joint0"),
        ([NAMES[0], *NAMES], "named twice"),
        ([], "there is no joint in joint_names"),
    ],
)
def test_other_names_are_refused(names, text):
    with pytest.raises(Unusable, match=text):
        paths(message([1.0], names=names), "", (1, 3), now=0.0)


def test_a_point_without_all_positions_is_refused():
    one = message([1.0, 2.0])
    one.points[1].positions = [0.0]
    with pytest.raises(Unusable, match="point 1 has 1 positions for 6 joints"):
        paths(one, "", (1, 3), now=0.0)

"""Commands reach the finger, and the results of queries have the right shapes."""

import dataclasses

import numpy
import pytest

import sun2xp

HOME = [0.0, 0.6, 0.9]


def test_a_position_is_reached_and_held(hand):
    hand.send_position(2, HOME)
    hand.wait(2, timeout=30)
    assert abs(hand.position(2) - HOME).max() < 0.04
    with pytest.raises(sun2xp.TimedOut):
        hand.send_position(2, [0.2, 0.6, 0.9])
        hand.wait(2, timeout=0)
    hand.wait(numpy.int64(2), timeout=30)


def test_a_tip_is_sent_in_centimetres(hand):
    there = hand.forward_kinematics(1, HOME)
    assert there.shape == (3,)
    hand.send_tip(1, there)
    hand.wait([1], "settled", timeout=30)
    assert abs(hand.tip(1).position - there).max() < 0.3
    assert abs(hand.inverse_kinematics(1, there) - HOME).max() < 1e-6


def test_a_group_moves_two_fingers_and_leaves_the_third(hand):
    before = hand.position(3)
    soft = numpy.diag([2.0, 2.0, 1.0])
    hand.send_group([
        sun2xp.SetPoint(1, position=HOME, stiffness=soft),
        sun2xp.SetPoint(2, tip=hand.forward_kinematics(2, HOME), damping=1.2),
    ])
    hand.wait((1, 2), timeout=30)
    assert abs(hand.position(3) - before).max() < 0.05
    with pytest.raises(sun2xp.Refused):
        hand.send_group([sun2xp.SetPoint(1, position=HOME, tip=HOME)])
    with pytest.raises(sun2xp.Refused):
        hand.send_group([sun2xp.SetPoint(1), sun2xp.SetPoint(1)])


def test_a_path_is_followed_to_its_end(hand):
    hand.send_position(1, HOME)
    # A path begins with the rates that the set point has at that moment.
    hand.wait(1, "settled", timeout=30)
    times = numpy.linspace(0.5, 2.0, 4)
    poses = HOME + 0.2 * numpy.sin(numpy.outer(times, [0.0, 1.0, 1.5]))
    stiffness = numpy.tile(numpy.diag([3.0, 3.0, 1.0]), (4, 1, 1))
    events = hand.events()
    hand.send_path(1, times, joints=poses, stiffness=stiffness)
    assert any(event.kind == sun2xp.EventKind.PATH_ENDED for event in iter(lambda: events.wait(20), None))
    hand.wait(1, timeout=30)
    assert abs(hand.position(1) - poses[-1]).max() < 0.04
    hand.send_path(1, [1.5], tips=[hand.forward_kinematics(1, HOME)])
    for wrong in [{}, {"joints": poses, "tips": poses}, {"joints": poses[:2]}, {"joints": poses * 9}]:
        with pytest.raises(sun2xp.Refused):
            hand.send_path(1, times, **wrong)


def test_springs_of_every_kind_are_taken(hand):
    kx = numpy.diag([2.0, 2.0, 1.0])
    hand.send_stiffness(1, kx)
    hand.send_contact(1, kx)
    hand.send_contact(1, 2.0, normal=[0, 0, 1])
    hand.send_contact(1, numpy.diag([2.0, 2.0, 1.0, 1.0]), normal=[0, 1, 0])
    hand.send_contact(1, numpy.diag([2.0, 2.0, 1.0, 0.5, 0.5, 0.5]))
    hand.send_joint_stiffness(1, numpy.diag([20.0, 20.0, 10.0]))
    hand.send_joint_torque(1, [0.1, -0.1, 0.0])
    hand.send_damping(1, 1.0)
    for call, wrong in [
        (hand.send_stiffness, kx + [[0, 1, 0], [0, 0, 0], [0, 0, 0]]),
        (hand.send_stiffness, kx * 1000),
        (hand.send_stiffness, [1, 2, 3]),
        (hand.send_contact, [1, 2, 3]),
        (hand.send_joint_torque, [1e6, 0, 0]),
        (hand.send_damping, float("nan")),
    ]:
        with pytest.raises(sun2xp.Refused):
            call(1, wrong)


def test_arguments_may_be_any_array(hand):
    numbers = numpy.zeros((3, 6), order="F")
    numbers[:, 2] = HOME
    hand.send_position(1, numbers[:, 2])
    hand.send_position(1, numpy.array(HOME, dtype=numpy.float32))
    hand.send_position(1, (0, 1, 1))
    with pytest.raises(sun2xp.Refused, match=r"position has the shape \(3, 6\): pass an array with the shape \(3,\)"):
        hand.send_position(1, numbers)


def test_adjustments_are_in_the_configuration(hand):
    hand.adjust(1, "tendon.minimum = 6")
    assert hand.configuration(1)["tendon"]["minimum"] == 6
    assert hand.limits(1).tension[0] == 6 and hand.limits(2).tension[0] != 6
    with pytest.raises(sun2xp.Refused):
        hand.adjust(1, "port = 'x'")
    with pytest.raises(sun2xp.ConfigurationError, match="minimun"):
        hand.adjust(1, "tendon.minimun = 6")
    hand.set_gravity([0, 0, -9.81])


def test_results_have_their_shapes(shared):
    tip = shared.tip(1)
    assert tip.position.shape == tip.force.shape == tip.contact_force.shape == (3,)
    assert tip.tensions.shape == (4,) and tip.stiffness.shape == (3, 3) and (tip.tensions > 0).all()
    status = shared.status(1)
    assert status.stage == "running" and status.rate == 1000 and status.losses.cycles > 0
    assert status.wake_up.count > 0 and status.wake_up.minimum <= status.wake_up.p999 <= status.wake_up.maximum
    limits = shared.limits(1)
    assert limits.joints.shape == (2, 3) and (limits.joints[0] < limits.joints[1]).all() and limits.stiffness > 1
    torques = shared.joint_torques(1)
    assert torques.measured.shape == torques.commanded.shape == (3,)
    pose = shared.palm_pose(3)
    assert abs(pose.rotation @ pose.rotation.T - numpy.eye(3)).max() < 1e-12
    assert abs(pose.base + pose.rotation @ shared.tip(3).position - pose.tip).max() < 0.05
    assert shared.timing(1, "compute").median > 0
    with pytest.raises(sun2xp.Refused, match="wake_up, write"):
        shared.timing(1, "lunch")
    assert shared.fault(1).stopped is None
    with pytest.raises(dataclasses.FrozenInstanceError):
        status.rate = 7


def test_the_jacobian_is_the_derivative_of_the_tip(shared):
    step = 1e-6
    there = lambda joints: shared.forward_kinematics(1, joints)
    columns = [(there(HOME + step * axis) - there(HOME - step * axis)) / (2 * step) for axis in numpy.eye(3)]
    assert abs(shared.jacobian(1, HOME) - numpy.transpose(columns)).max() < 1e-6
    assert shared.jacobian(1).shape == (3, 3)


def test_the_urdf_has_only_the_fingers_of_the_hand():
    with sun2xp.simulated(text="[hand]\nfingers = [2]\n") as hand:
        urdf = hand.urdf()
        assert "finger2_joint0" in urdf and "finger1" not in urdf and "finger3" not in urdf


def test_arrays_with_any_layout_have_the_same_numbers(hand):
    packed = numpy.array([(0.1, 1), (0.5, 2), (0.9, 3)], [("angle", "f8"), ("joint", "i4")])
    bytes_of = numpy.zeros(25, "u1")
    shifted = bytes_of[1:].view("f8")
    shifted[:] = [0.1, 0.5, 0.9]
    expected = hand.forward_kinematics(1, [0.1, 0.5, 0.9])
    for angles in (packed["angle"], shifted, packed["angle"][::-1].copy()[::-1], packed["angle"].astype(">f8")):
        assert (hand.forward_kinematics(1, angles) == expected).all()
    springs = numpy.zeros(2, [("flag", "i1"), ("kx", "f8", (3, 3))])
    springs["kx"] = numpy.diag([3.0, 3.0, 1.0])
    hand.send_stiffness(1, springs["kx"][1])
    cycles = numpy.zeros(4, [("flag", "i1"), ("time", "f8"), ("joints", "f8", 3)])
    cycles["time"] = [0.5, 1.0, 1.5, 2.0]
    cycles["joints"] = HOME
    hand.send_path(2, cycles["time"], joints=cycles["joints"])
    hand.wait(2, "settled", timeout=30)
    assert abs(hand.position(2) - HOME).max() < 0.04

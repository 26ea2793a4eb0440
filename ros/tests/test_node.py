"""Tests the node with the real rclpy: what it publishes, what it does with messages, and how it starts and ends."""

import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
from xml.etree import ElementTree

import numpy
import pytest
import rclpy
import sun2xp
from conftest import JOINTS, LONGEST, PREFIX, near, refused, start, trajectory
from geometry_msgs.msg import PointStamped
from std_msgs.msg import Float64MultiArray
from sun2xp_ros.node import HandNode
from trajectory_msgs.msg import JointTrajectory

#: Environment of a second node, whose topics have the same names. Its ROS domain separates it from the first node.
APART = {"ROS_DOMAIN_ID": str(int(os.environ.get("ROS_DOMAIN_ID", 0)) % 100 + 1)}


def test_joint_states_are_complete_and_fresh(planner):
    message = planner.wait("joint_states")
    assert list(message.name) == JOINTS
    assert len(message.position) == len(message.velocity) == len(message.effort) == 9
    # Tendons at 5 to 60 N with moment arms of about 1 cm give some 0.1 N m. The unit is N m, and not N cm.
    assert 0.0 < max(abs(torque) for torque in message.effort) < 0.6
    now = planner.node.get_clock().now().nanoseconds * 1e-9
    age = now - (message.header.stamp.sec + message.header.stamp.nanosec * 1e-9)
    assert -0.001 < age < 1.0, age
    count, began = len(planner.received["joint_states"]), time.monotonic()
    time.sleep(2.0)
    rate = (len(planner.received["joint_states"]) - count) / (time.monotonic() - began)
    assert 50 < rate < 110, f"{rate} Hz instead of 100 Hz"


def frames(urdf, angles):
    """Returns the poses of all links in the frame of the root, m. `angles` has the angle of each joint, rad, by the
    name of the joint."""
    robot = ElementTree.fromstring(urdf)
    poses = {f"{PREFIX}palm": numpy.eye(4)}
    joints = list(robot.findall("joint"))
    while joints:
        joint = next(one for one in joints if one.find("parent").get("link") in poses)
        joints.remove(joint)
        origin = joint.find("origin")
        x, y, z, roll, pitch, yaw = (float(part) for key in ("xyz", "rpy") for part in origin.get(key).split())
        assert roll == pitch == 0.0
        step = numpy.array(
            [[math.cos(yaw), -math.sin(yaw), 0, x], [math.sin(yaw), math.cos(yaw), 0, y], [0, 0, 1, z], [0, 0, 0, 1]]
        )
        if joint.get("type") == "revolute":
            axis = [float(part) for part in joint.find("axis").get("xyz").split()]
            step = step @ turned(axis, angles[joint.get("name")])
        poses[joint.find("child").get("link")] = poses[joint.find("parent").get("link")] @ step
    return poses


def turned(axis, angle):
    """Returns the 4 x 4 matrix of the rotation about an axis by an angle, rad (Rodrigues' formula)."""
    x, y, z = axis
    cross = numpy.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    pose = numpy.eye(4)
    pose[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return pose


def test_the_latched_description_is_the_hand(planner):
    urdf = planner.latched("robot_description").data
    robot = ElementTree.fromstring(urdf)
    assert [joint.get("name") for joint in robot.findall("joint[@type='revolute']")] == JOINTS
    with sun2xp.simulated() as hand:
        for finger in (1, 2, 3):
            limits = hand.limits(finger).joints
            for joint, name in enumerate(JOINTS[3 * finger - 3 : 3 * finger]):
                soft = robot.find(f"joint[@name='{name}']/safety_controller")
                assert float(soft.get("soft_lower_limit")) == pytest.approx(limits[0, joint])
                assert float(soft.get("soft_upper_limit")) == pytest.approx(limits[1, joint])
            # The position and the axes of the tip agree with the pose that the library reports.
            pose, state = hand.palm_pose(finger), hand.position(finger)
            angles = dict(zip(JOINTS, 9 * [0.0])) | dict(zip(JOINTS[3 * finger - 3 :], state))
            found = frames(urdf, angles)
            tip, base = found[f"{PREFIX}finger{finger}_tip"], found[f"{PREFIX}finger{finger}_base"]
            assert numpy.allclose(base[:3, :3], pose.rotation) and numpy.allclose(base[:3, 3] * 100, pose.base)
            assert numpy.allclose(tip[:3, :3], pose.tip_rotation, atol=0.002)
            assert numpy.allclose(tip[:3, 3] * 100, pose.tip, atol=0.02)
            for angles in numpy.random.default_rng(14).uniform(limits[0], limits[1], (20, 3)):
                expected = pose.base + pose.rotation @ hand.forward_kinematics(finger, angles)
                every = dict(zip(JOINTS, 9 * [0.0])) | dict(zip(JOINTS[3 * finger - 3 :], angles))
                tip = frames(urdf, every)[f"{PREFIX}finger{finger}_tip"]
                assert numpy.allclose(tip[:3, 3] * 100, expected, atol=1e-9)


def test_a_trajectory_moves_a_finger_and_no_other(planner):
    before = planner.wait("joint_states")
    # The message has the joints in another order. Its first point is the present pose, as in messages of ROS planners.
    names = [JOINTS[5], JOINTS[3], JOINTS[4]]
    now = dict(zip(before.name, before.position))
    planner.trajectories.publish(
        trajectory(2, (0.0, [now[name] for name in names]), (0.8, [0.8, 0.1, 0.4]), (1.6, [0.9, 0.2, 0.5]), names=names)
    )
    after = planner.wait("joint_states", near(2, [0.2, 0.5, 0.9]))
    for finger in (1, 3):
        place = 3 * finger - 3
        assert near(finger, before.position[place : place + 3])(after)


def test_a_trajectory_beyond_the_limits_is_refused_with_the_reason(planner):
    before = planner.wait("joint_states")
    planner.trajectories.publish(trajectory(3, (1.0, [0.0, 0.5, 9.0])))
    line = planner.wait("/rosout", refused("trajectory refused", "finger 3", "rad"))
    assert "9.000" in line.msg
    planner.trajectories.publish(trajectory(3, (0.01, [0.5, 1.0, 1.4])))
    planner.wait("/rosout", refused("trajectory refused", "finger.motion"))
    planner.trajectories.publish(trajectory(3, (1.0, [0.5]), names=["elbow"]))
    planner.wait("/rosout", refused("there is no joint elbow"))
    # Finger 3 refuses its path. So finger 1 holds its pose, although its own path is within the limits.
    both = trajectory(1, (1.0, [0.0, 0.9, 1.2, 0.0, 0.5, 8.0]), names=[*JOINTS[:3], *JOINTS[6:]])
    planner.trajectories.publish(both)
    planner.wait("/rosout", refused("trajectory refused", "8.000", "finger 3"))
    time.sleep(1.2)
    after = planner.wait("joint_states")
    assert near(1, before.position[:3])(after) and near(3, before.position[6:])(after)


def test_an_empty_trajectory_stops_the_motion(planner):
    before = planner.wait("joint_states").position[6]
    planner.trajectories.publish(trajectory(3, (6.0, [before + 0.6, 0.5, 0.9])))
    moving = planner.wait("joint_states", lambda message: message.position[6] > before + 0.05)
    assert moving.velocity[6] > 0.02
    planner.trajectories.publish(JointTrajectory())
    time.sleep(0.5)
    stopped = planner.wait("joint_states").position[6]
    time.sleep(1.0)
    # The path would have moved on by 0.1 rad and more.
    assert abs(planner.wait("joint_states").position[6] - stopped) < 0.02


def test_a_target_moves_the_tip(planner):
    with sun2xp.simulated() as hand:
        joints = numpy.array([0.1, 0.7, 1.0])
        pose = hand.palm_pose(1)
        point = hand.forward_kinematics(1, joints)
    in_palm = (pose.base + pose.rotation @ point) / 100.0
    message = PointStamped()
    message.header.frame_id = f"{PREFIX}palm"
    message.point.x, message.point.y, message.point.z = in_palm
    planner.targets.publish(message)
    planner.wait("joint_states", near(1, joints))
    message.header.frame_id = "map"
    planner.targets.publish(message)
    planner.wait("/rosout", refused("target of finger1 refused", "map", f"{PREFIX}finger1_base"))
    message.header.frame_id = f"{PREFIX}finger1_base"
    message.point.x, message.point.y, message.point.z = point / 100.0 + [0.0, 0.002, 0.0]
    planner.targets.publish(message)
    planner.wait("joint_states", lambda message: not near(1, joints, 0.005)(message))


def test_a_stiffness_is_taken_in_newtons_per_metre(planner):
    planner.stiffnesses.publish(Float64MultiArray(data=numpy.diag([900.0, 300.0, 300.0]).ravel().tolist()))
    # The text of the library is in the library's own unit, N/cm.
    planner.wait("/rosout", refused("stiffness of finger1 refused", "9.000 N/cm"))
    planner.stiffnesses.publish(Float64MultiArray(data=[1.0, 2.0]))
    planner.wait("/rosout", refused("3 x 3"))
    count = len(planner.received["/rosout"])
    planner.stiffnesses.publish(Float64MultiArray(data=numpy.diag([200.0, 200.0, 100.0]).ravel().tolist()))
    # The node takes the messages of a topic in order: when it refuses this message, it has taken the one before.
    planner.stiffnesses.publish(Float64MultiArray(data=[1.0]))
    planner.wait("/rosout", refused("3 x 3"))
    lines = [line.msg for line in planner.received["/rosout"][count:] if refused("stiffness")(line)]
    assert len(lines) == 1 and "3 x 3" in lines[0], lines


def test_wrenches_are_in_the_frames_of_the_tips(planner):
    for finger in (1, 2, 3):
        message = planner.wait(f"finger{finger}/wrench")
        assert message.header.frame_id == f"{PREFIX}finger{finger}_tip"
        force = message.wrench.force
        # Nothing touches the fingers.
        assert math.hypot(force.x, force.y, force.z) < 1.0
        assert message.wrench.torque.x == message.wrench.torque.y == message.wrench.torque.z == 0.0


@pytest.mark.parametrize(
    ("parameter", "text"),
    [("simulated:=broken", "broken"), ("configuration:=/nowhere/hand.toml", "/nowhere/hand.toml")],
)
def test_a_hand_that_cannot_be_opened_ends_the_node_with_the_reason(ros, parameter, text):
    process = start(parameter)
    try:
        _, said = process.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    assert process.returncode == 1 and "the node was not started" in said and text in said and "Traceback" not in said


def test_a_node_without_a_hand_destroys_itself(ros):
    observer = rclpy.create_node("observer")
    try:
        with pytest.raises(sun2xp.Error) as refusal:
            HandNode(namespace="/broken", parameter_overrides=[rclpy.Parameter("simulated", value="broken")])
        # The traceback of `refusal` still refers to the node, so garbage collection has not destroyed the node.
        assert ("sun2xp", "/broken") not in observer.get_node_names_and_namespaces(), refusal
    finally:
        observer.destroy_node()


def test_a_hand_with_one_finger_has_only_its_topics(ros, tmp_path):
    file = tmp_path / "hand.toml"
    file.write_text("[hand]\nfingers = [2]\n[finger]\nport = 'simulated'\n")
    program = (
        "import rclpy\n"
        "from sensor_msgs.msg import JointState\n"
        "rclpy.init()\n"
        "planner, states = rclpy.create_node('planner'), []\n"
        "planner.create_subscription(JointState, 'joint_states', states.append, 10)\n"
        "while not states:\n"
        "    rclpy.spin_once(planner)\n"
        "print(*states[0].name, *sorted(name for name, _ in planner.get_topic_names_and_types()))\n"
    )
    process = start(f"configuration:={file}", **APART)
    try:
        options = dict(env={**os.environ, **APART}, timeout=LONGEST, check=True, capture_output=True, text=True)
        said = subprocess.run([sys.executable, "-c", program], **options).stdout.split()
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LONGEST)
    assert said[:3] == ["finger2_joint0", "finger2_joint1", "finger2_joint2"]
    fingers = [topic for topic in said if topic.startswith("/finger")]
    assert fingers == ["/finger2/stiffness", "/finger2/target", "/finger2/wrench"]


def test_the_example_of_the_page_moves_a_finger(ros):
    page = (pathlib.Path(__file__).parents[2] / "docs/ros.md").read_text()
    (example,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    example += (
        "from sensor_msgs.msg import JointState\n"
        "states = []\n"
        "planner.create_subscription(JointState, 'joint_states', states.append, 10)\n"
        "while not states or abs(states[-1].position[0] - 0.1) > 0.02:\n"
        "    rclpy.spin_once(planner)\n"
    )
    process = start("simulated:=nominal", **APART)
    try:
        subprocess.run([sys.executable, "-c", example], env={**os.environ, **APART}, timeout=LONGEST, check=True)
    finally:
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=LONGEST)

"""A running node, a planner that talks to it, and what the planner sends and expects."""

import os
import signal
import subprocess
import sys
import threading
import time
import types

import pytest
import rclpy
from builtin_interfaces.msg import Duration
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, WrenchStamped
from rcl_interfaces.msg import Log
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

#: Longest time of a wait, s. The machine may be busy.
LONGEST = 30.0

#: The parameter `prefix` of the node: the prefix of its joint and frame names.
PREFIX = "left_"

#: The names of all joints, in the order of the node.
JOINTS = [f"{PREFIX}finger{finger}_joint{joint}" for finger in (1, 2, 3) for joint in (0, 1, 2)]


def trajectory(finger, *points, names=None):
    """A trajectory of one finger: times, s, and angles, rad."""
    message = JointTrajectory(joint_names=names or JOINTS[3 * finger - 3 : 3 * finger])
    for seconds, angles in points:
        since = Duration(sec=int(seconds), nanosec=round(seconds % 1 * 1e9))
        message.points.append(JointTrajectoryPoint(positions=angles, time_from_start=since))
    return message


def near(finger, angles, tolerance=0.03):
    """Returns a condition that a JointState fulfils if it shows the finger near these angles, rad."""

    def condition(message):
        found = dict(zip(message.name, message.position))
        names = JOINTS[3 * finger - 3 : 3 * finger]
        return all(name in found and abs(found[name] - angle) < tolerance for name, angle in zip(names, angles))

    return condition


def refused(*words):
    """Returns the condition that a line of the log is a refusal with these words."""
    return lambda line: line.level == 40 and all(word in line.msg for word in words)


class Planner:
    """A node that keeps what it receives."""

    def __init__(self):
        self.node = rclpy.create_node("planner")
        self.received = {}
        self.changed = threading.Condition()
        subscribe = self._subscribe
        subscribe(JointState, "joint_states")
        subscribe(DiagnosticArray, "/diagnostics")
        subscribe(Log, "/rosout")
        for finger in (1, 2, 3):
            subscribe(WrenchStamped, f"finger{finger}/wrench")
        #: Number of log lines that had arrived when this planner last published a message.
        self.logged = 0
        self.publishers = []
        self.trajectories = self._publisher(JointTrajectory, "joint_trajectory")
        self.targets = self._publisher(PointStamped, "finger1/target")
        self.stiffnesses = self._publisher(Float64MultiArray, "finger1/stiffness")
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.thread = threading.Thread(target=self.executor.spin, daemon=True)
        self.thread.start()

    def _subscribe(self, kind, topic, qos=10):
        def keep(message):
            with self.changed:
                self.received.setdefault(topic, []).append(message)
                self.changed.notify_all()

        return self.node.create_subscription(kind, topic, keep, qos)

    def _publisher(self, kind, topic):
        publisher = self.node.create_publisher(kind, topic, 10)
        self.publishers.append(publisher)

        def publish(message):
            with self.changed:
                self.logged = len(self.received.get("/rosout", []))
            publisher.publish(message)

        return types.SimpleNamespace(publish=publish)

    def wait(self, topic, condition=lambda message: True):
        """Waits for a message that arrives after this call and fulfils the condition, and returns it.

        On /rosout, every line since the last published message counts, because the node may write its line before this
        call.
        """
        deadline = time.monotonic() + LONGEST
        with self.changed:
            place = self.logged if topic == "/rosout" else len(self.received.get(topic, []))
            while True:
                messages = self.received.get(topic, [])
                for message in messages[place:]:
                    if condition(message):
                        return message
                place = len(messages)
                left = deadline - time.monotonic()
                newest = messages[-1] if messages else None
                assert left > 0 and self.changed.wait(left) or newest, f"no message of {topic}"
                assert left > 0, f"no such message of {topic}; the newest is {newest}"

    def latched(self, topic):
        """Subscribes now, and returns the message that was published before."""
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._subscribe(String, topic, qos)
        deadline = time.monotonic() + LONGEST
        with self.changed:
            while topic not in self.received:
                assert self.changed.wait(deadline - time.monotonic()), f"no message of {topic}"
            return self.received[topic][0]

    def begin(self, service):
        """Calls a service without waiting for the response."""
        client = self.node.create_client(Trigger, service)
        assert client.wait_for_service(LONGEST), f"no service {service}"
        return client.call_async(Trigger.Request())

    def finish(self, future, service):
        """Waits for the response of a service."""
        done = threading.Event()
        future.add_done_callback(lambda _: done.set())
        assert done.wait(LONGEST), f"no response of {service}"
        return future.result()

    def call(self, service):
        return self.finish(self.begin(service), service)

    def ready(self):
        """Waits until the node has subscribed to the publishers of this planner, and a message of the node arrives."""
        deadline = time.monotonic() + LONGEST
        for publisher in self.publishers:
            while publisher.get_subscription_count() == 0:
                assert time.monotonic() < deadline, f"nobody subscribes to {publisher.topic_name}"
                time.sleep(0.05)
        self.wait("joint_states")

    def close(self):
        self.executor.shutdown()
        self.thread.join(LONGEST)
        self.node.destroy_node()


def start(*parameters, **environment):
    """Starts the node in a process of its own."""
    command = [sys.executable, "-m", "sun2xp_ros", "--ros-args"]
    for parameter in parameters:
        command += ["-p", parameter]
    return subprocess.Popen(command, env={**os.environ, **environment}, stderr=subprocess.PIPE, text=True)


@pytest.fixture(scope="session")
def ros():
    rclpy.init()
    yield
    rclpy.try_shutdown()


@pytest.fixture(scope="module")
def planner(ros):
    """A planner, while the node with a simulated hand runs."""
    process = start("simulated:=nominal", f"prefix:={PREFIX}", "diagnostics_rate:=2.0")
    one = Planner()
    try:
        one.ready()
        yield one
    finally:
        one.close()
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=LONGEST)
        print(said)
    assert process.returncode == 0, said

"""Tests services, times of measurements, and trajectories that wait for their start, with a fake hand and node."""

import time
import types

import numpy
import pytest
import sun2xp
from builtin_interfaces.msg import Time as Stamp
from rclpy.time import Time
from sun2xp_ros.commands import Commands
from sun2xp_ros.moment import Moment
from sun2xp_ros.services import Services
from test_trajectory import NAMES, message


class Logger:
    def __init__(self):
        self.lines = []

    def error(self, line):
        self.lines.append(line)


class Node:
    """A node whose clock stands still until a test moves it."""

    def __init__(self):
        self.now_ns = int(8.5e9)
        self.takes, self.timers, self.logger = {}, [], Logger()

    def create_subscription(self, _kind, topic, take, _depth):
        self.takes[topic] = take

    def create_timer(self, delay, run):
        self.timers.append((self.now_ns + round(delay * 1e9), run))
        return self.timers[-1]

    def destroy_timer(self, timer):
        self.timers.remove(timer)

    def get_clock(self):
        return self

    def now(self):
        return Time(nanoseconds=self.now_ns)

    def get_logger(self):
        return self.logger

    def advance_to(self, seconds):
        self.now_ns = int(seconds * 1e9)
        for due, run in list(self.timers):
            if due <= self.now_ns:
                run()


class Hand:
    """Notes the commands that it gets."""

    def __init__(self):
        self.calls = []
        #: The finger that refuses paths; 0 if none does.
        self.refusing = 0
        #: The pose of every finger, and the last pose that any finger got.
        self.pose, self.sent = [0.0, 0.0, 0.0], None

    def palm_pose(self, _finger):
        return self

    base = rotation = None

    def position(self, _finger):
        return self.pose

    def limits(self, _finger):
        return types.SimpleNamespace(joints=numpy.array([[-0.5, 0.0, 0.0], [0.5, 1.5, 1.5]]))

    def send_path(self, finger, times, joints):
        if finger == self.refusing:
            raise sun2xp.Fault(f"finger {finger} is faulted", number=9, finger=finger)
        self.calls.append(("path", finger, times.tolist()))

    def send_position(self, finger, joints):
        low, high = self.limits(finger).joints
        if (joints < low).any() or (joints > high).any():
            raise sun2xp.Refused("outside the limits: send angles within the limits")
        self.sent = list(joints)
        self.calls.append(("position", finger))

    def status(self, _finger):
        return types.SimpleNamespace(stage="running")

    def recover(self, finger):
        self.calls.append(("recover", finger))


@pytest.fixture
def one():
    node, hand = Node(), Hand()
    commands = Commands(node, hand, (1, 3), "")
    return node, hand, commands


def test_a_trajectory_begins_at_its_stamp(one):
    node, hand, _ = one
    node.takes["joint_trajectory"](message([0.0, 1.0, 2.0], stamp=10))
    node.advance_to(9.9)
    assert hand.calls == []
    node.advance_to(10.0)
    assert hand.calls == [("path", 1, [1.0, 2.0]), ("path", 3, [1.0, 2.0])] and not node.timers


def test_a_pose_to_take_at_once_is_sent_although_every_timer_is_late(one):
    node, hand, _ = one
    node.takes["joint_trajectory"](message([0.0], stamp=10))
    node.advance_to(10.003)
    assert hand.calls == [("position", 1), ("position", 3)] and not node.logger.lines


def test_a_trajectory_that_ends_before_a_late_timer_is_refused(one):
    node, hand, _ = one
    node.takes["joint_trajectory"](message([0.0, 0.5], stamp=10))
    node.advance_to(10.6)
    assert hand.calls == [] and "ended 0.100 s ago" in node.logger.lines[0]


@pytest.mark.parametrize(("refusing", "other"), [(1, 3), (3, 1)])
def test_if_one_finger_refuses_its_path_the_others_stop(one, refusing, other):
    node, hand, _ = one
    take = node.takes["joint_trajectory"]
    take(message([1.0], stamp=10))
    hand.refusing = refusing
    take(message([1.0]))
    assert hand.calls[-1] == ("position", other) and f"finger {refusing} is faulted" in node.logger.lines[0]
    # The other finger has got a command, so its part of the waiting trajectory is dropped.
    hand.refusing, hand.calls = 0, []
    node.advance_to(10.0)
    assert hand.calls == [("path", refusing, [1.0])]


def test_a_finger_is_recovered_although_its_stage_does_not_show_the_stop_yet():
    hand, node = Hand(), types.SimpleNamespace(create_service=lambda *_arguments, **_options: None)
    services = Services(node, hand, (1, 3), lambda _finger: None)
    try:
        assert services._recover(3) == "has no fault" and hand.calls == [("recover", 3)]
    finally:
        services.close()


class Failing:
    """A hand whose finger 1 cannot be recovered or stopped, because of an exception that is no refusal."""

    def __init__(self, defect):
        self.defect, self.stopped = defect, []

    def status(self, _finger):
        return types.SimpleNamespace(stage="faulted")

    def recover(self, finger):
        if finger == 1:
            raise self.defect

    def stop(self, finger):
        if finger == 1:
            raise self.defect
        self.stopped.append(finger)


@pytest.fixture
def failing():
    def begin(defect):
        node = types.SimpleNamespace(
            create_service=lambda *_arguments, **_options: None, executor=None, get_logger=lambda: Logger()
        )
        hand = Failing(defect)
        begun.append(Services(node, hand, (1, 3), lambda _finger: None))
        return begun[0], hand

    begun = []
    yield begin
    begun[0].close()


def answer_of(services, action):
    """Returns the response of a service that waits in a thread."""
    call = services._answer_later((1, 3), action, None, types.SimpleNamespace())
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        try:
            call.send(None)
        except StopIteration as ended:
            return ended.value
    raise AssertionError("no answer")


def test_a_service_answers_and_does_the_rest_although_one_finger_has_a_defect(failing):
    services, hand = failing(RuntimeError("broken"))
    answer = answer_of(services, services._recover)
    defect = "finger 1: RuntimeError('broken'): this is a defect of sun2xp_ros, please report it"
    assert not answer.success and answer.message == f"{defect}; finger 3 has recovered"
    answer = services._answer((1, 3), services._stop, None, types.SimpleNamespace())
    assert not answer.success and "finger 3 is stopped" in answer.message and hand.stopped == [3]


def test_a_panic_in_the_thread_of_a_service_reaches_the_node(failing):
    class Panic(BaseException):
        """An exception like a panic of the library, which is not an `Exception`."""

    services, _ = failing(Panic())
    with pytest.raises(Panic):
        answer_of(services, services._recover)


def test_a_later_command_replaces_a_trajectory_that_waits(one):
    node, hand, commands = one
    take = node.takes["joint_trajectory"]
    take(message([1.0], stamp=10))
    take(message([0.0], names=NAMES[:3]))
    assert hand.calls == [("position", 1)]
    node.advance_to(10.0)
    assert hand.calls[1:] == [("path", 3, [1.0])]
    take(message([1.0], stamp=12))
    commands.forget(3)
    node.advance_to(12.0)
    assert hand.calls[2:] == [("path", 1, [1.0])]
    take(message([1.0], stamp=14))
    take(message([]))
    node.advance_to(14.0)
    assert hand.calls[3:] == [("position", 1), ("position", 3)] and not node.timers and not node.logger.lines


def test_a_finger_beyond_a_limit_is_stopped_at_the_limit(one):
    node, hand, _ = one
    hand.pose = [0.1, -0.002, 1.501]
    node.takes["joint_trajectory"](message([]))
    assert hand.calls == [("position", 1), ("position", 3)] and hand.sent == [0.1, 0.0, 1.5] and not node.logger.lines


def test_a_trajectory_that_no_hand_can_execute_is_refused_at_once(one):
    node, _, _ = one
    node.takes["joint_trajectory"](message([1.0], stamp=10, names=NAMES[:2]))
    assert not node.timers and "finger1_joint2 is missing" in node.logger.lines[0]


def test_the_time_of_a_measurement_does_not_depend_on_the_time_of_reading(monkeypatch):
    node = Node()
    monkeypatch.setattr(time, "monotonic_ns", lambda: 1_000_000)
    moment = Moment(node)
    # Reading the fingers takes 20 ms.
    monkeypatch.setattr(time, "monotonic_ns", lambda: 21_000_000)
    assert moment.time_of(900_000).to_msg() == Stamp(sec=8, nanosec=499_900_000)
    assert moment.time_of(1_100_000).to_msg() == Stamp(sec=8, nanosec=500_100_000)


def test_a_measurement_before_the_clock_of_ros_began_has_the_time_of_its_beginning(monkeypatch):
    node = Node()
    monkeypatch.setattr(time, "monotonic_ns", lambda: 1_000_000)
    for now_ns, stamp in ((0, Stamp()), (200_000, Stamp(nanosec=100_000)), (50_000, Stamp())):
        node.now_ns = now_ns
        assert Moment(node).time_of(900_000).to_msg() == stamp

"""The rates at which the node publishes, and the mean joint rates in its messages. The hand is a stand-in whose fault a
test sets."""

import pathlib
import time
import types

import numpy
import pytest
import rclpy
import sun2xp
from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from sun2xp_ros.node import HandNode
from test_diagnostics import FAULT, STATUS

ZERO = numpy.zeros(3)


class Hand:
    """A hand at rest. If `stopped` is set, every finger reports this fault."""

    def __init__(self):
        self.stopped = None

    def status(self, _finger):
        return STATUS

    def fault(self, _finger):
        return sun2xp.FingerFault(self.stopped, None, 0)

    def urdf(self):
        return "<robot/>"

    def configuration(self, _finger):
        return {"port": "simulated"}

    def palm_pose(self, _finger):
        return types.SimpleNamespace(base=ZERO, rotation=numpy.eye(3), tip_rotation=numpy.eye(3))

    def joint_state(self, _finger):
        return sun2xp.JointState(time.monotonic_ns(), ZERO, ZERO, ZERO)

    def tip(self, _finger):
        return types.SimpleNamespace(contact_force=ZERO, tensions=[1.0, 2.0, 3.0, 4.0])

    def close(self):
        pass


@pytest.fixture
def opened(monkeypatch):
    """The hands that nodes have opened."""
    hands = []

    def simulated(_name):
        hands.append(Hand())
        return hands[-1]

    monkeypatch.setattr(sun2xp, "simulated", simulated)
    return hands


def node_with(**parameters):
    values = {"simulated": "nominal", **parameters}
    return HandNode(parameter_overrides=[Parameter(name, value=value) for name, value in values.items()])


def test_a_new_fault_is_published_at_once_at_every_rate(ros, opened):
    node = node_with(rate=1.0, diagnostics_rate=0.1)
    published = []
    node._diagnostics = types.SimpleNamespace(publish=published.append)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    # The first joint states come one second after the start of the node, and the first diagnostics after ten seconds.
    (hand,) = opened
    hand.stopped, end = FAULT, time.monotonic() + 0.8
    while not published and time.monotonic() < end:
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()
    node.destroy_node()
    assert published and published[0].status[0].level == DiagnosticStatus.ERROR


def test_the_rates_are_kept_while_the_clock_of_ros_stands_still(ros, opened):
    # Nobody publishes the simulated time.
    node = node_with(use_sim_time=True, diagnostics_rate=10.0)
    states, described = [], []
    node._joint_states = types.SimpleNamespace(publish=states.append)
    node._diagnostics = types.SimpleNamespace(publish=described.append)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    end = time.monotonic() + 20
    while (len(states) < 3 or not described) and time.monotonic() < end:
        executor.spin_once(timeout_sec=0.05)
    (hand,) = opened
    hand.stopped = FAULT
    while described and described[-1].status[0].level != DiagnosticStatus.ERROR and time.monotonic() < end:
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()
    node.destroy_node()
    assert len(states) >= 3 and described and described[-1].status[0].level == DiagnosticStatus.ERROR


def test_a_wrong_rate_ends_the_node_before_a_hand_is_opened(ros, opened):
    for parameters in ({"rate": 5000.0}, {"diagnostics_rate": 0.0}):
        with pytest.raises(rclpy.exceptions.ParameterException):
            node_with(**parameters)
    assert not opened


def test_the_file_of_parameters_serves_a_node_in_a_namespace(ros, opened, tmp_path):
    text = (pathlib.Path(__file__).parents[1] / "config/hand.yaml").read_text()
    for name, default, value in (("simulated", '""', '"nominal"'), ("rate", "100.0", "50.0")):
        assert f"    {name}: {default}\n" in text
        text = text.replace(f"    {name}: {default}\n", f"    {name}: {value}\n")
    file = tmp_path / "hand.yaml"
    file.write_text(text)
    node = HandNode(namespace="/left", cli_args=["--ros-args", "--params-file", str(file)])
    try:
        assert node.get_namespace() == "/left" and node.get_parameter("rate").value == 50.0 and len(opened) == 1
    finally:
        node.destroy_node()


def test_the_rates_are_means_since_the_previous_measurement():
    node = types.SimpleNamespace(_before={})
    noise = numpy.array([7.0, 7.0, 7.0])

    def mean(milliseconds, angle):
        state = sun2xp.JointState(milliseconds * 1_000_000, numpy.full(3, angle), noise, ZERO)
        return HandNode._mean_rate(node, 1, state)

    assert (mean(0, 0.0) == noise).all()
    assert mean(10, 0.02) == pytest.approx(2.0 * numpy.ones(3))
    # No cycle has passed since the previous call, so the mean rate of that call is repeated.
    assert mean(10, 0.02) == pytest.approx(2.0 * numpy.ones(3))
    assert mean(20, 0.03) == pytest.approx(1.0 * numpy.ones(3))

"""The requests of the client of `sun2xp.remote`, without a network and with simulated clocks."""

import threading

import numpy
import pytest

import sun2xp
import sun2xp.remote
from sun2xp.remote import _messages, _reading


class Clock:
    """Time that passes only during pauses."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds


@pytest.fixture
def clock(monkeypatch):
    one = Clock()
    monkeypatch.setattr(_reading, "time", one)
    return one


@pytest.fixture
def server(clock, server):
    server.gets.clear()
    return server


def test_a_get_that_reaches_nobody_is_repeated_twice(server):
    server.unanswered = 2
    server.hand.stop(1)
    assert server.gets == ["stop"] * 3
    server.gets.clear()
    server.unanswered = 2
    assert server.hand.status(1).stage == "running" and server.gets == [None] * 3
    server.unanswered = 3
    with pytest.raises(sun2xp.remote.NoAnswer):
        server.hand.status()


@pytest.mark.parametrize("action", ["zero", "identify"])
def test_a_calibration_is_not_requested_again(server, action):
    server.unanswered = 1
    with pytest.raises(sun2xp.remote.NoAnswer):
        getattr(server.hand, action)(1)
    assert len(server.gets) == 1


def test_a_get_that_ends_late_without_a_reply_is_not_repeated(server, clock, monkeypatch):
    """The connection was lost, and the server may have carried out the request."""

    def get(_key, _payload, _timeout):
        server.gets.append("late")
        clock.sleep(1.0)
        return []

    monkeypatch.setattr(server, "get", get)
    with pytest.raises(sun2xp.remote.NoAnswer):
        server.hand.recover(1)
    assert server.gets == ["late"]


def test_the_limits_are_those_of_the_server_that_was_acquired_last(server):
    with pytest.raises(sun2xp.Refused):
        server.hand.send_position(1, [0.55, 0.6, 0.9])
    server.status = {"turn": 0.6}
    server.hand.acquire()
    server.hand.send_position(1, [0.55, 0.6, 0.9])
    assert server.command()[3][:3] == [0.55, 0.6, 0.9]


def test_rounding_is_admitted(server):
    server.status = {"turn": 0.6}
    server.hand.acquire()
    limit = numpy.float32(0.6)
    assert float(limit) > 0.6
    server.hand.send_position(1, [limit, 0.6, 0.9])
    with pytest.raises(sun2xp.Refused):
        server.hand.send_position(1, [0.6001, 0.6, 0.9])
    server.hand.send_stiffness(1, [[4.000001, 4e-5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    for kx in ([[4.0, 0.1, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], numpy.diag([4.001, 1.0, 1.0])):
        with pytest.raises(sun2xp.Refused):
            server.hand.send_stiffness(1, kx)


@pytest.mark.parametrize(("finger", "named", "fault"), [(0, 2, 10), (2, 2, 10), (1, 1, 0)])
def test_a_fault_has_its_finger_and_its_number(server, finger, named, fault):
    server.status, server.code = {"fault": 10}, 7
    with pytest.raises(sun2xp.Fault) as refused:
        server.hand.recover(finger)
    assert (refused.value.finger, refused.value.fault) == (named, fault)


@pytest.mark.parametrize("finger", [0, 2])
def test_a_fault_has_its_finger_although_the_server_does_not_tell_its_status(server, monkeypatch, finger):
    server.records["stage"][1], server.records["fault"][1] = _messages.STAGES.index("faulted"), 10
    server.state()
    server.code = 7
    answers = server.get
    monkeypatch.setattr(server, "get", lambda key, payload, timeout: answers(key, payload, timeout) if payload else [])
    with pytest.raises(sun2xp.Fault) as refused:
        server.hand.recover(finger)
    assert (refused.value.finger, refused.value.fault) == (2, 10)


def test_a_fault_that_nobody_names_any_more_has_no_finger(server):
    """The finger was recovered after the server had refused the request."""
    server.code = 7
    with pytest.raises(sun2xp.Fault) as refused:
        server.hand.recover(0)
    assert (refused.value.finger, refused.value.fault) == (0, 0)


def test_closing_a_queue_of_events_ends_the_waits_for_it(server):
    events = server.hand.events()
    waiter = threading.Thread(target=events.wait, daemon=True)
    waiter.start()
    events.close()
    waiter.join(10)
    assert not waiter.is_alive() and list(events) == []

"""Tests arguments that a hand refuses, infinite times, an interrupted opening, and the arrival of a pushed finger."""

import math

import numpy
import pytest

import sun2xp
from sun2xp import EventKind, _hand, _log, then, when

HOME = [0.0, 0.6, 0.9]


@pytest.mark.parametrize("value", ["there", [1, [2, 3], 4], [0.0, "a", 1.0], object(), [1j, 0, 0], b"abc"])
def test_what_is_no_array_is_refused(shared, value):
    for call in (shared.send_position, shared.send_stiffness, shared.inverse_kinematics, shared.push):
        with pytest.raises(sun2xp.Refused, match="is no array of numbers .*: pass numbers"):
            call(1, value)


def test_a_column_is_no_vector(shared):
    for dtype in ("f4", "f8"):
        with pytest.raises(sun2xp.Refused, match=r"has the shape \(3, 1\): pass an array with the shape \(3,\)"):
            shared.send_position(1, numpy.zeros((3, 1), dtype))


def test_the_times_of_a_path_have_one_dimension(shared):
    poses = numpy.tile(HOME, (4, 1))
    for times in ([[0.5, 1.0], [1.5, 2.0]], 1.5, "now"):
        with pytest.raises(sun2xp.Refused, match="times"):
            shared.send_path(1, times, joints=poses)


@pytest.mark.parametrize(
    "call",
    [
        lambda hand: hand.position(2**40),
        lambda hand: hand.send_position(-(2**40), HOME),
        lambda hand: hand.send_group([sun2xp.SetPoint(2**40)]),
        lambda hand: hand.wait([1, 2**40]),
        lambda hand: hand.stop(2**40),
        lambda hand: hand.zero(2**40),
        lambda hand: hand.configuration(2**40),
        lambda hand: hand.touch(1, -1),
        lambda hand: hand.touch(1, 2**70),
        lambda hand: hand.remove_reflex(1, -1),
        lambda hand: hand.install_reflex(1, when.event(EventKind.CONTACT), then.hold(), priority=300),
        lambda hand: hand.install_reflex(1, when.event(EventKind.CONTACT), then.hold(), priority=-1),
        lambda hand: hand.install_reflex(1, when.event(300), then.hold()),
        lambda hand: hand.install_reflex(1, when.joint_above(-1, 0.0), then.hold()),
        lambda hand: hand.install_reflex(1, when.other_finger(2**40, EventKind.FAULT), then.hold()),
    ],
)
def test_integers_out_of_range_are_refused(shared, call):
    with pytest.raises(sun2xp.Refused):
        call(shared)


def test_a_set_point_that_is_valid_for_ever_does_not_expire():
    with sun2xp.simulated(text="[finger.motion]\nvalid_ms = 50\n") as hand:
        events = hand.events()
        hand.send_position(1, HOME, valid=math.inf)
        hand.send_position(2, HOME, valid=1e300)
        hand.send_path(3, [2.0], joints=[hand.position(3)], valid=math.inf)
        # If `valid` is left out, the configured `valid_ms` applies.
        with sun2xp.simulated(text="[finger.motion]\nvalid_ms = 50\n") as other:
            others = other.events()
            other.send_position(1, HOME)
            assert any(event.kind == EventKind.EXPIRED for event in iter(lambda: others.wait(20), None))
        hand.wait(3, timeout=30)
        hand.wait((1, 2), "settled", timeout=30)
        assert EventKind.EXPIRED not in [event.kind for event in iter(events.take, None)]


def test_a_time_limit_that_is_too_long_for_a_clock_is_no_limit(shared):
    shared.wait(1, "settled", timeout=1e300)
    for limit in (-1.0, math.nan):
        with pytest.raises(sun2xp.Refused, match="pass a time of 0 s or more"):
            shared.wait(1, timeout=limit)


def test_an_interrupted_opening_does_not_wait_for_the_log(monkeypatch):
    flushed = []
    monkeypatch.setattr(_log, "flush", lambda: flushed.append(1))

    def interrupted():
        raise KeyboardInterrupt

    def refused():
        raise sun2xp.ConfigurationError("no such key: remove it")

    with pytest.raises(KeyboardInterrupt):
        _hand._opened(interrupted)
    assert not flushed
    with pytest.raises(sun2xp.ConfigurationError):
        _hand._opened(refused)
    assert flushed


def test_a_finger_that_was_pushed_away_still_counts_as_arrived(hand):
    assert "Both conditions still hold" in sun2xp.Hand.wait.__doc__
    hand.send_position(1, HOME)
    hand.wait(1, timeout=30)
    hand.push(1, [0.0, 0.0, -5.0])
    while abs(hand.position(1) - HOME).max() < 0.05:
        pass
    hand.wait(1, timeout=0)

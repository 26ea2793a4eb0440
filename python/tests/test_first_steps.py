"""The first steps with a hand: a finger moves, and wrong arguments are refused."""

import time

import numpy
import pytest

import sun2xp


def test_a_finger_goes_where_it_is_sent():
    with sun2xp.simulated() as hand:
        before = hand.position(1)
        assert before.shape == (3,) and before.dtype == numpy.float64
        goal = before + [0.05, 0.1, -0.1]
        hand.send_position(1, goal)
        deadline = time.monotonic() + 20
        while abs(hand.position(1) - goal).max() > 0.01:
            assert time.monotonic() < deadline, (hand.position(1), goal)
        assert abs(hand.position(2) - before).max() < 0.05
    assert hand.closed
    hand.close()
    with pytest.raises(sun2xp.Closed) as refusal:
        hand.position(1)
    assert refusal.value.number == sun2xp.ErrorNumber.NO_HAND
    assert "closed" in refusal.value.text and refusal.value.remedy == "open it again"


def test_wrong_arguments_are_refused():
    with sun2xp.simulated() as hand:
        nan = float("nan")
        for finger, joints in [(4, [0, 0, 0]), (1, [0, 0]), (1, [0, 0, 9]), (1, [0, 0, nan]), (1, [[0, 0, 0]])]:
            with pytest.raises(sun2xp.Refused):
                hand.send_position(finger, joints)
        with pytest.raises((TypeError, ValueError)):
            hand.send_position(1, "north")
        hand.send_position(1, (0, numpy.float32(0.5), 1))
        hand.send_stiffness(1, numpy.diag([2.0, 2.0, 1.0])[::-1, ::-1])

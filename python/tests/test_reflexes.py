"""Reflexes, pushes and simulated objects."""

import numpy
import pytest

import sun2xp
from sun2xp import EventKind, then, when


def test_a_reflex_holds_a_finger_that_is_pushed(hand):
    number = hand.install_reflex(1, when.event(EventKind.CONTACT), then.hold(), refractory=1.0)
    events = hand.events()
    hand.push(1, [0, 3.0, 4.0])
    fired = next(event for event in events if event.kind == EventKind.REFLEX_FIRED)
    assert fired.finger == 1 and fired.values == (number,)
    hand.push(1, [0, 0, 0])
    hand.remove_reflex(1, number)
    hand.remove_reflex(1)
    with pytest.raises(sun2xp.Refused):
        hand.remove_reflex(1, number)


def test_every_condition_and_reaction_is_taken(hand):
    conditions = [
        when.event(EventKind.CONTACT),
        when.other_finger(2, EventKind.FAULT),
        when.force_above(100),
        when.tension_above(900),
        when.tension_below(0.1),
        when.joint_above(1, 3),
        when.joint_below(1, -3),
        when.link_lost(10),
        when.planner_silent(3000),
    ]
    kx = numpy.diag([1.0, 1.0, 0.5])
    reactions = [then.stop(), then.hold(), then.soften(kx), then.retract([0, 0.6, 0.9]), then.grip(1, 5), then.damp(1)]
    numbers = [hand.install_reflex(1, condition, then.damp(1)) for condition in conditions]
    numbers += [hand.install_reflex(1, when.force_above(100), reaction) for reaction in reactions]
    assert len(set(numbers)) == len(conditions) + len(reactions)
    for condition, reaction in [
        (("thunder",), then.stop()),
        (when.force_above(-1), then.stop()),
        (when.joint_above(3, 0), then.stop()),
        (when.force_above(1), then.retract([9, 9, 9])),
        (when.event(99), then.stop()),
        (when.other_finger(1, EventKind.FAULT), then.stop()),
    ]:
        with pytest.raises(sun2xp.Refused):
            hand.install_reflex(1, condition, reaction)


def test_a_simulated_object_has_a_state():
    text = "[hand.simulated_object]\nshape = { ball = { radius = 2.0 } }\n"
    with sun2xp.simulated(text=text) as hand:
        ball = hand.object()
        assert ball.position.shape == (3,) and ball.rotation.shape == ball.forces.shape == (3, 3) and ball.time > 0
    with sun2xp.simulated() as hand, pytest.raises(sun2xp.Refused):
        hand.object()


def test_touch_without_elements_is_refused(shared):
    with pytest.raises(sun2xp.Refused, match="lists 0 elements"):
        shared.touch(1, 0)
    assert shared.lost_touch_events(1) == 0 and shared.tare_touch(1) == []


def test_a_tactile_element_feels_a_wall():
    text = """
[finger.1.touch]
elements = [{ position = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], newton_per_count = 0.001 }]
[finger.1.simulation]
surface = { wall = { point = [0.0, -6.8, 0.0], normal = [0.0, 1.0, 0.0], stiffness = 50.0 } }
"""
    with sun2xp.simulated(text=text) as hand:
        assert not hand.touch(1, 0).pressed
        events = hand.events()
        hand.send_tip(1, hand.tip(1).position + [0.0, -0.6, 0.0])
        made = next(event for event in events if event.kind == EventKind.TOUCH_MADE)
        assert made.finger == 1 and made.values[0] == 0
        while not (reading := hand.touch(1, 0)).pressed:
            pass
        assert reading.valid and reading.count > 0 and reading.force > 0
        assert len(hand.tare_touch(1)) == 1
        with pytest.raises(sun2xp.Refused):
            hand.touch(1, 1)

"""What the client of `sun2xp.remote` sends over a line that loses Targets, States and refusals."""

import random

import numpy
import pytest
from remote_scripted import HOME, Scripted, holds

import sun2xp
from sun2xp.remote import _messages

KX = numpy.eye(3)
PATH = ([1.0], [HOME])


@pytest.mark.parametrize("seed", range(100))
def test_whatever_is_lost_the_newest_values_arrive_once(seed):
    """Targets and States are lost. The finger gets the newest values, the command numbers never decrease, and no path
    begins more often than it was sent."""
    draw, server = random.Random(seed), Scripted()
    hand, newest, values, numbers, paths, begun = server.hand, {}, {}, [0], 0, 0

    def take():
        nonlocal begun
        for _, command, place, bits, _, numbers_of_part in server.target():
            assert command >= numbers[-1]
            if command == numbers[-1]:
                continue
            numbers.append(command)
            begun += place == _messages.PATH
            values.update({"place": (place, numbers_of_part[:3])} if place else {})
            values.update({"kx": numbers_of_part[3]} if bits & 1 else {})
        server.records["command"][0] = numbers[-1]

    for step in range(draw.randrange(40)):
        angle = step / 100
        kind = draw.randrange(5)
        if kind == 0:
            hand.send_position(1, [angle] * 3)
            newest["place"] = (_messages.JOINTS, [angle] * 3)
        elif kind == 1:
            hand.send_stiffness(1, (1 + angle) * KX)
            newest["kx"] = 1 + angle
        elif kind == 2:
            hand.send_path(1, *PATH)
            newest["place"] = (_messages.PATH, [0.0] * 3)
            paths += 1
        if draw.randrange(3):
            take()
        if draw.randrange(2):
            server.state()
    for _ in range(3):
        take()
        server.state()
    assert values == newest and begun <= paths and (not newest or holds(hand))


@pytest.mark.parametrize("seed", range(100))
def test_whatever_is_refused_command_numbers_never_decrease(seed):
    """Targets, States and refusals are lost or late."""
    draw, server = random.Random(seed), Scripted()
    hand, refused = server.hand, []
    commands = [
        lambda finger: hand.send_position(finger, HOME),
        lambda finger: hand.send_tip(finger, [50.0, 0.0, 0.0]),
        lambda finger: hand.send_stiffness(finger, KX),
        lambda finger: hand.send_path(finger, *PATH),
    ]

    def take():
        parts = server.target()
        fresh = [part for part in parts if part[1] != server.records["command"][part[0] - 1]]
        if any(part[2] == _messages.TIP for part in fresh):
            refused.append(server.targets[-1][0])
            return
        for part in fresh:
            server.records["command"][part[0] - 1] = part[1]

    for _ in range(draw.randrange(40)):
        try:
            draw.choice(commands)(draw.choice([1, 2]))
        except sun2xp.Refused:
            pass
        if draw.randrange(3):
            take()
        if draw.randrange(2):
            server.state()
        while refused and draw.randrange(2):
            sequence = refused.pop(0)
            if draw.randrange(4):
                server.refuse(sequence)
    for _ in range(5):
        take()
        server.state()
        for sequence in refused:
            server.refuse(sequence)
        refused.clear()
    take()
    assert not refused
    for finger in (1, 2):
        sent = [part[1] for _, parts in server.targets for part in parts if part[0] == finger]
        assert sent == sorted(sent)

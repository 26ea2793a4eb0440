"""What the client of `sun2xp.remote` sends and reports, without a network and without time."""

import time
import types

import pytest
from remote_scripted import Scripted, S

import sun2xp.remote
from sun2xp.remote import _messages, _receiver


@pytest.fixture
def server():
    return Scripted()


@pytest.fixture
def hand(server):
    return server.hand


def test_the_age_is_that_of_the_record_of_the_finger(server, hand):
    server.state(after=11 * S, fingers=(2, 3))
    assert hand.position(2).shape == (3,)
    for read in (hand.position, hand.tip, hand.state):
        with pytest.raises(sun2xp.remote.Stale, match="finger 1 is 11.* ms old"):
            read(1)
    server.state()
    assert hand.position(1).shape == (3,)


def test_the_age_of_a_finger_that_has_stopped_is_that_of_the_state(server, hand, monkeypatch):
    server.records["stage"][0], server.records["fault"][0] = _messages.STAGES.index("faulted"), 10
    server.state()
    server.state(after=11 * S, fingers=(2, 3))
    assert hand.state(1).stage == "faulted"
    later = types.SimpleNamespace(monotonic_ns=lambda: time.monotonic_ns() + 11 * S)
    monkeypatch.setattr(_receiver, "time", later)
    with pytest.raises(sun2xp.remote.Stale):
        hand.state(1)

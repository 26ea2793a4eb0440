"""What the client of `sun2xp.remote` sends and reports, without a network and with a simulated clock of the server."""

import threading
import time
import types
import warnings

import numpy
import pytest
from remote_scripted import BEGIN, HOME, MS, S, holds

import sun2xp
import sun2xp.remote
from sun2xp.remote import _messages, _owner, _receiver

KX = numpy.eye(3)
PATH = ([1.0], [HOME])
ARRIVED, EVERYTHING = _messages.ARRIVED, 15


def test_after_a_refusal_nothing_is_sent_to_the_finger_until_a_new_command(server, remote):
    remote.send_position(1, HOME)
    server.apply()
    remote.send_tip(1, [50.0, 0.0, 0.0])
    server.refuse(server.targets[-1][0])
    assert server.target() == []
    with pytest.raises(sun2xp.Refused, match="out of reach"):
        remote.wait(timeout=0)
    server.state()
    assert server.target() == [] and holds(remote)
    remote.send_stiffness(1, KX)
    assert server.command()[:3] == (3, 0, 1)


def test_a_refusal_does_not_concern_later_commands(server, remote):
    remote.send_tip(1, [50.0, 0.0, 0.0])
    refused = server.targets[-1][0]
    remote.send_position(1, HOME)
    server.refuse(refused)
    server.target()
    assert server.command()[:2] == (2, 1)
    with pytest.raises(sun2xp.Refused):
        remote.wait(1, timeout=0)
    server.apply()
    assert holds(remote)


def test_a_refused_value_is_not_sent_with_later_commands(server, remote):
    remote.send_tip(1, [50.0, 0.0, 0.0])
    refused = server.targets[-1][0]
    remote.send_stiffness(1, KX)
    assert server.command()[:3] == (2, 2, 1)
    server.refuse(refused)
    with pytest.raises(sun2xp.Refused):
        remote.send_damping(1, 1.5)
    remote.send_damping(1, 1.5)
    assert server.command()[:3] == (3, 0, 3)


def test_a_refusal_does_not_concern_what_was_applied_or_another_epoch(server, remote):
    remote.send_position(1, HOME)
    server.apply()
    remote.send_tip(2, [50.0, 0.0, 0.0])
    server.refuse(server.targets[-1][0])
    assert [part[:2] for part in server.target()] == [(1, 1)]
    remote.send_position(1, HOME)
    refused = server.targets[-1][0]
    remote.acquire(take_over=True)
    remote.send_position(1, HOME)
    server.number -= 1
    server.refuse(refused + 10)
    server.number += 1
    assert server.target()[0][:2] == (1, 4)
    server.apply()
    assert holds(remote)


def test_a_state_from_before_the_acquire_applies_nothing(server, remote):
    server.now += 30 * MS
    remote.acquire(take_over=True)
    remote.send_position(1, HOME)
    command = server.command()[0]
    # A State from before the Answer arrives after it. In the previous epoch, another client used this command number.
    server.records["command"], server.records["bits"] = command, EVERYTHING
    server.now -= 30 * MS
    server.state(owner=server.number - 1)
    assert not holds(remote) and not holds(remote, condition="arrived")
    server.now += 30 * MS
    server.records["command"] = 0
    server.state()
    assert not holds(remote)
    server.apply()
    assert holds(remote) and holds(remote, condition="arrived")


def test_a_state_of_an_earlier_epoch_applies_nothing(server, remote):
    remote.send_position(1, HOME)
    server.records["bits"] = EVERYTHING
    server.apply()
    assert holds(remote, condition="arrived")
    # Other clients may use the same command numbers as this one.
    server.records["command"] = 2
    server.state(owner=server.number + 7)
    remote.acquire(take_over=True)
    remote.send_position(1, HOME)
    assert server.command()[0] == 2
    assert not holds(remote) and not holds(remote, condition="arrived")


def test_only_command_numbers_of_this_client_count(server, remote):
    remote.send_position(1, HOME)
    server.records["command"], server.records["bits"] = 2, EVERYTHING
    server.state()
    assert not holds(remote)
    server.records["bits"] = 0
    server.apply()
    assert holds(remote) and not holds(remote, condition="arrived")
    server.records["bits"] = ARRIVED
    server.state()
    assert holds(remote, condition="arrived")


def test_a_wait_says_that_the_hand_was_lost(server, remote):
    remote.send_position(1, HOME)
    server.records["bits"] = EVERYTHING
    server.apply()
    server.state(owner=server.number + 1)
    for condition in ("applied", "arrived", "settled"):
        with pytest.raises(sun2xp.remote.NotOwner):
            remote.wait(1, condition, timeout=0)
    with pytest.raises(sun2xp.remote.NotOwner):
        remote.wait(timeout=0)
    remote.acquire()
    remote.send_position(1, HOME)
    server.apply()
    assert holds(remote)


@pytest.mark.parametrize("back", [MS, 9 * S, BEGIN - MS])
def test_a_restart_of_the_machine_ends_the_epoch(server, remote, back):
    remote.send_position(1, HOME)
    server.now, server.states = server.now - back, 0
    server.records["command"], server.records["bits"] = server.command()[0], EVERYTHING
    server.state(after=0, owner=0)
    assert not remote.owned
    with pytest.raises(sun2xp.remote.NotOwner):
        remote.wait(1, timeout=0)
    # The States of the restarted machine are accepted, although their times are earlier.
    assert remote.state(1).time == server.now
    remote.acquire()
    server.state()
    remote.send_position(1, HOME)
    server.apply()
    assert remote.owned and holds(remote)


def test_a_restart_of_the_server_ends_the_epoch(server, remote):
    server.states = 0
    server.state(owner=0)
    assert not remote.owned


def test_a_hand_that_is_acquired_after_a_restart_stays_owned(server, remote):
    server.now, server.states = 20 * S, 0
    remote.acquire()
    # The State from before the Answer arrives after it.
    server.state(after=-MS, owner=0)
    server.state(after=2 * MS)
    remote.send_position(1, HOME)
    server.apply()
    assert remote.owned and holds(remote)


def test_the_age_is_that_of_the_record_of_the_finger(server, remote):
    server.state(after=11 * S, fingers=(2, 3))
    assert remote.position(2).shape == (3,)
    for read in (remote.position, remote.tip, remote.state):
        with pytest.raises(sun2xp.remote.Stale, match="finger 1 is 11.* ms old"):
            read(1)
    server.state()
    assert remote.position(1).shape == (3,)


def test_the_age_of_a_finger_that_has_stopped_is_that_of_the_state(server, remote, monkeypatch):
    server.records["stage"][0], server.records["fault"][0] = _messages.STAGES.index("faulted"), 10
    server.state()
    server.state(after=11 * S, fingers=(2, 3))
    assert remote.state(1).stage == "faulted"
    later = types.SimpleNamespace(monotonic_ns=lambda: time.monotonic_ns() + 11 * S)
    monkeypatch.setattr(_receiver, "time", later)
    with pytest.raises(sun2xp.remote.Stale):
        remote.state(1)


def test_a_path_is_sent_with_one_command_number(server, remote):
    remote.send_path(1, *PATH)
    assert server.command()[:3] == (1, 3, 0)
    # Kx and the damping are not sent until a State has confirmed the path.
    remote.send_stiffness(1, KX)
    remote.send_damping(1, 1.5)
    server.target()
    assert server.command()[:3] == (1, 3, 0) and not holds(remote)
    server.apply()
    assert not holds(remote)
    server.target()
    assert server.command()[:3] == (2, 0, 3)
    server.apply()
    assert holds(remote)


def test_a_place_replaces_a_path_at_once(server, remote):
    remote.send_path(1, *PATH)
    remote.send_stiffness(1, KX)
    remote.send_position(1, HOME)
    assert server.command()[:3] == (2, 1, 1)


def test_a_group_waits_as_a_whole_for_a_path(server, remote):
    remote.send_path(1, *PATH)
    remote.send_group([sun2xp.SetPoint(1, stiffness=KX), sun2xp.SetPoint(2, position=HOME)])
    assert [part[:2] for part in server.target()] == [(1, 1)]
    server.apply()
    assert [part[:2] for part in server.target()] == [(1, 2), (2, 3)]


def test_what_waits_for_a_refused_path_is_sent(server, remote):
    remote.send_path(1, *PATH)
    remote.send_stiffness(1, KX)
    server.refuse(server.targets[-1][0])
    server.target()
    assert server.command()[:3] == (2, 0, 1)


@pytest.mark.parametrize("finger", [1.0, numpy.float64(1), "1"])
def test_a_finger_whose_number_is_no_integer_is_refused(server, remote, finger):
    for call in (lambda: remote.send_position(finger, HOME), lambda: remote.send_path(finger, *PATH)):
        with pytest.raises(sun2xp.Refused, match="there is no finger"):
            call()
    with pytest.raises(sun2xp.Refused):
        remote.wait([finger], timeout=0)
    assert server.target() == []
    remote.send_position(numpy.int64(1), HOME)
    server.apply()
    assert holds(remote, numpy.int64(1))


def test_a_wait_for_a_finger_without_a_command_uses_the_records_of_the_epoch(server, remote):
    server.records["bits"] = EVERYTHING
    remote.acquire()
    assert not holds(remote, 2) and not holds(remote, 2, "arrived")
    server.state()
    assert holds(remote, 2) and holds(remote, 2, "arrived")
    remote.send_position(1, HOME)
    assert not holds(remote, [1, 2], "arrived")
    server.apply()
    assert holds(remote, [1, 2], "arrived")
    server.records["bits"][1] = 0
    server.state()
    assert holds(remote, 2) and not holds(remote, 2, "settled")


@pytest.mark.parametrize("call", [lambda hand: hand.owned, lambda hand: hand.recover(1), lambda hand: hand.zero(1)])
def test_a_call_that_may_end_the_epoch_holds_the_lock(remote, call):
    """Without the lock, an acquire of another thread could begin an epoch that this call ends at once."""
    free, lock = [], remote._network.sender.lock

    def try_lock():
        free.append(lock.acquire(blocking=False))
        if free[-1]:
            lock.release()

    def silence():
        thread = threading.Thread(target=try_lock)
        thread.start()
        thread.join()
        return 0.0

    remote._receiver.silence = silence
    call(remote)
    assert free == [False]


def test_a_target_that_cannot_be_sent_does_not_stop_those_of_other_hands():
    class Failing:
        def publish(self, sent):
            raise OSError("no line")

    class Counting:
        sent = threading.Event()

        def publish(self, sent):
            self.sent.set()

    sender = _owner.Sender()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        sender.add(Failing())
        sender.add(Counting())
        assert Counting.sent.wait(10)
        sender.close()

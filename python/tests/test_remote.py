"""The client of `sun2xp.remote` against a server without a hand."""

import socket
import subprocess
import sys
import time

import numpy
import pytest
from remote_double import Double

import sun2xp
import sun2xp.remote
import sun2xp.remote.__main__

HOME = [0.0, 0.6, 0.9]


def free_endpoint():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


@pytest.fixture
def double():
    endpoint = free_endpoint()
    with Double(endpoint) as server:
        server.endpoint = endpoint
        yield server


@pytest.fixture
def hand(double):
    with sun2xp.remote.open("hand", double.endpoint) as opened:
        yield opened


def eventually(holds, timeout=5.0):
    end = time.monotonic() + timeout
    while not holds():
        assert time.monotonic() < end, "the condition does not hold in time"
        time.sleep(0.002)


def test_a_set_point_arrives_and_is_repeated_with_what_the_hand_does_not_have_yet(double, hand):
    assert hand.fingers == [1, 2, 3] and hand.owned
    double.publishing = False
    time.sleep(0.05)
    # The parameters have the names of the calls of a local hand.
    hand.send_stiffness(finger=1, stiffness=numpy.diag([2.0, 2.0, 1.0]))
    hand.send_position(finger=1, position=HOME)
    eventually(lambda: double.targets and double.targets[-1][3] and double.targets[-1][3][0][2] == 1)
    finger, command, place, bits, poses, values = double.targets[-1][3][0]
    assert (finger, place, bits, poses) == (1, 1, 1, 0) and command == 2
    assert values == [*HOME, 2, 0, 0, 0, 2, 0, 0, 0, 1, 0]
    double.publishing = True
    hand.wait(1, "applied", timeout=5)
    assert abs(hand.position(1) - HOME).max() == 0
    # What was applied is not sent again with a new command.
    hand.send_damping(1, 1.5)
    hand.wait(1, "applied", timeout=5)
    finger, command, place, bits, _, values = double.targets[-1][3][0]
    assert (command, place, bits, values[12]) == (3, 0, 2, 1.5)


def test_targets_come_every_20_ms_with_rising_times(double, hand):
    hand.send_position(2, HOME)
    hand.wait(2, "applied", timeout=5)
    double.targets.clear()
    eventually(lambda: len(double.targets) >= 50)
    sent = numpy.array([target[0] for target in double.targets])
    assert (numpy.diff(sent) > 0).all() and 0.015e9 < numpy.median(numpy.diff(sent)) < 0.025e9
    # Each Target repeats the newest time that the server has published. The age of this time is at most one interval of
    # the States and one transmission.
    seen = numpy.array([target[1] for target in double.targets])
    assert (numpy.diff(seen) >= 0).all() and numpy.median(sent - seen) < 0.03e9
    assert {target[2] for target in double.targets} == {100}


def test_a_refusal_is_raised_by_the_next_call_and_the_set_point_is_left_out(double, hand):
    hand.send_position(1, HOME)
    hand.wait(1, "applied", timeout=5)
    double.refusal = "the tip is out of reach"
    hand.send_tip(1, [50.0, 0.0, 0.0])
    with pytest.raises(sun2xp.Refused, match="out of reach"):
        hand.wait(1, timeout=5)
    double.refusal = None
    double.targets.clear()
    eventually(lambda: len(double.targets) >= 3)
    # The earlier set point, command 1, stays in force. Its part must not be sent again, because command 2 was sent
    # after it: a server that had applied command 2 would take command 1 as a new part.
    assert double.targets[-1][3] == []
    assert hand.state(1).command == 1
    hand.send_position(1, [0.1, 0.6, 0.9])
    hand.wait(1, "applied", timeout=5)


@pytest.mark.parametrize(
    "call",
    [
        lambda hand: hand.send_position(1, [0.0, 9.0, 0.0]),
        lambda hand: hand.send_position(4, HOME),
        lambda hand: hand.send_position(1, [0.0, float("nan"), 0.0]),
        lambda hand: hand.send_position(1, [0.0, 0.0]),
        lambda hand: hand.send_position(1, "there"),
        lambda hand: hand.send_stiffness(1, [[1, 2, 0], [0, 1, 0], [0, 0, 1]]),
        lambda hand: hand.send_stiffness(1, numpy.diag([9.0, 1.0, 1.0])),
        lambda hand: hand.send_group([]),
        lambda hand: hand.send_group([sun2xp.SetPoint(1)]),
        lambda hand: hand.send_group([sun2xp.SetPoint(1, position=HOME, tip=HOME)]),
        lambda hand: hand.send_group([sun2xp.SetPoint(1, position=HOME), sun2xp.SetPoint(1, damping=1.0)]),
        lambda hand: hand.send_path(1, [], numpy.zeros((0, 3))),
        lambda hand: hand.send_path(1, [0.0, 1.0], [HOME, HOME]),
        lambda hand: hand.send_path(1, [1.0, 0.5], [HOME, HOME]),
        lambda hand: hand.send_path(1, [1.0], [HOME, HOME]),
        lambda hand: hand.send_path(1, numpy.arange(1, 34), numpy.tile(HOME, (33, 1))),
        lambda hand: hand.wait(1, "there"),
    ],
)
def test_what_cannot_be_right_is_refused_before_it_is_sent(hand, double, call):
    with pytest.raises(sun2xp.Refused, match=": .") as refusal:
        call(hand)
    # The text is a cause, a colon, and what to do, without a full stop at the end.
    assert not refusal.value.text.endswith(".")
    double.targets.clear()
    eventually(lambda: len(double.targets) >= 2)
    assert all(not target[3] for target in double.targets)


def test_old_data_are_refused_and_come_back(double, hand):
    assert hand.position(1).shape == (3,)
    double.publishing = False
    eventually(lambda: hand._receiver.age() > 0.1)
    for read in (hand.position, hand.tip, hand.state):
        with pytest.raises(sun2xp.remote.Stale, match="100 ms are allowed"):
            read(1)
    double.publishing = True
    eventually(lambda: hand._receiver.age() < 0.05)
    assert hand.tip(1).tensions.shape == (4,)


def test_another_owner_is_respected_and_a_take_over_is_noticed(double, hand):
    with pytest.raises(sun2xp.remote.NotOwner, match="screen owns"):
        sun2xp.remote.open("hand", double.endpoint, client="second")
    with sun2xp.remote.open("hand", double.endpoint, client="second", take_over=True) as second:
        eventually(lambda: not hand.owned)
        with pytest.raises(sun2xp.remote.NotOwner):
            hand.send_position(1, HOME)
        second.send_position(1, HOME)
        second.wait(1, "applied", timeout=5)
    hand.acquire()
    hand.send_position(1, HOME)
    hand.wait(1, "applied", timeout=5)


def test_requests_have_their_answers(double, hand):
    hand.stop(2)
    hand.recover(2)
    hand.zero(1)
    hand.identify(3)
    assert double.requests[-4:] == [(6, 2, 0), (3, 2, 0), (4, 1, 0), (5, 3, 0)]
    for code, error in [(1, sun2xp.Error), (3, sun2xp.Refused), (5, sun2xp.remote.NotOwner), (7, sun2xp.Fault),
                        (8, sun2xp.Closed), (9, sun2xp.Refused)]:
        double.code = code
        with pytest.raises(error, match="a reason"):
            hand.recover(1)
    double.code = 0


def test_a_hand_that_does_not_answer_is_named(double):
    began = time.monotonic()
    with pytest.raises(sun2xp.remote.NoAnswer, match="absent"):
        sun2xp.remote.open("absent", double.endpoint)
    with pytest.raises(sun2xp.remote.NoAnswer, match="no connection"):
        sun2xp.remote.open("hand", free_endpoint())
    assert time.monotonic() - began < 20
    for name in ("", "Hand", "a/b", "*", "x" * 33):
        with pytest.raises(sun2xp.ConfigurationError):
            sun2xp.remote.open(name, double.endpoint)
    with pytest.raises(sun2xp.ConfigurationError):
        sun2xp.remote.open("hand", double.endpoint, client="a/b")


def test_a_wait_ends_when_the_newest_record_says_so(double, hand):
    for condition, bit in [("arrived", 4), ("settled", 8)]:
        hand.send_position(1, HOME)
        hand.wait(1, "applied", timeout=5)
        double.records["bits"][0] = 15 - bit
        with pytest.raises(sun2xp.TimedOut):
            hand.wait(1, condition, timeout=0.05)
        double.records["bits"][0] = bit
        hand.wait(1, condition, timeout=5)


def test_events_reach_every_queue(double, hand):
    first, second = hand.events(), hand.events()
    double.put_event(1, 11, int(double.records["cycle"][0]) + 1)
    for queue in (first, second):
        event = queue.wait(5)
        assert (event.finger, event.kind) == (1, sun2xp.EventKind.ARRIVED)
        assert queue.take() is None
    double.put_event(1, 999, 1)
    double.put_event(2, 12, 1)
    assert first.wait(5).kind == sun2xp.EventKind.SETTLED
    second.close()


def test_the_status_and_the_cycles_are_read(double, hand):
    status = hand.status()
    assert (status.owner, status.catch, status.end, status.counts.ended) == ("planner", 0.1, 10.0, 7)
    assert hand.status(1).joints.tolist() == [[-0.5, 0, 0], [0.5, 1.5, 1.5]]
    assert list(sun2xp.remote.discover(double.endpoint)) == ["hand"]
    hand.cycles()
    eventually(lambda: hand._receiver._states)
    cycles = hand.cycles()
    assert set(cycles["finger"]) == {1, 2, 3} and hand.missing == (0, 0)


def test_the_module_lists_the_hands(double):
    command = [sys.executable, "-m", "sun2xp.remote"]
    found = subprocess.run([*command, double.endpoint], capture_output=True, text=True, timeout=60)
    assert found.stdout == "hand: finger 1 running, finger 2 running, finger 3 running; owner: planner\n", found
    nobody = subprocess.run([*command, free_endpoint()], capture_output=True, text=True, timeout=60)
    assert nobody.returncode == 1 and "no connection" in nobody.stderr


def test_the_module_says_that_no_hand_answers(monkeypatch, capsys):
    monkeypatch.setattr(sun2xp.remote.__main__, "discover", lambda endpoint: {})
    monkeypatch.setattr(sys, "argv", ["sun2xp.remote", "tcp/127.0.0.1:1"])
    assert sun2xp.remote.__main__.main() == 1
    output, error = capsys.readouterr()
    assert output == "" and error.startswith("no hand answers at tcp/127.0.0.1:1: start `sun2xp serve`"), error


def test_two_hands_get_one_time_stamp():
    endpoint = free_endpoint()
    with Double(endpoint, "left") as left, sun2xp.remote.connect(endpoint) as network:
        with pytest.raises(ValueError):
            sun2xp.remote.send_together({})
        # The second hand is behind the same router.
        with Double(None, "right", sun2xp.remote._network.configuration(endpoint, None)) as right:
            eventually(lambda: set(network.hands()) == {"left", "right"})
            hands = {name: network.open(name) for name in ("left", "right")}
            point = [sun2xp.SetPoint(1, position=HOME)]
            sun2xp.remote.send_together({hands["left"]: point, hands["right"]: point})
            for hand in hands.values():
                hand.wait(1, "applied", timeout=5)
            # The line may drop some Targets, but at least one pair with the same time stamp arrives.
            times = [{sent for sent, _, _, parts in server.targets if parts} for server in (left, right)]
            assert times[0] & times[1]


def test_a_closed_hand_is_released_and_refuses_calls(double):
    with sun2xp.remote.open("hand", double.endpoint) as hand:
        events = hand.events()
    assert double.requests[-1] == (2, 0, 0) and double.epoch == 0
    assert hand.closed and list(events) == []
    for call in (lambda: hand.position(1), lambda: hand.send_position(1, HOME), lambda: hand.stop(), hand.status):
        with pytest.raises(sun2xp.Closed):
            call()
    hand.close()
    with sun2xp.remote.open("hand", double.endpoint, read_only=True) as reader:
        assert not reader.owned and reader.position(3).shape == (3,)
        with pytest.raises(sun2xp.remote.NotOwner):
            reader.send_position(1, HOME)
        reader.stop()

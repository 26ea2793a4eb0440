"""The errors of `sun2xp.remote`: their types, numbers and remedies, and what an interrupted call leaves behind."""

import errno
import pathlib
import re
import struct

import pytest
from remote_double import Double
from remote_scripted import HOME, MS
from test_remote import free_endpoint

import sun2xp
import sun2xp.remote
from sun2xp import ErrorNumber, EventKind
from sun2xp.remote import _messages, _receiver


@pytest.mark.parametrize(
    ("call", "number", "system"),
    [
        (lambda hand: hand.send_position(1, [0.0, 9.0, 0.0]), ErrorNumber.LIMIT, errno.ERANGE),
        (lambda hand: hand.send_position(1, [0.0, 0.0]), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.send_position(1, "there"), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.send_position(4, HOME), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.send_stiffness(1, [[9.0, 0, 0], [0, 1, 0], [0, 0, 1]]), ErrorNumber.LIMIT, errno.ERANGE),
        (lambda hand: hand.send_group([]), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.send_path(1, [1.0, 0.5], [HOME, HOME]), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.wait(1, "there"), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.wait(1, timeout=0), ErrorNumber.TIMED_OUT, errno.ETIMEDOUT),
        (lambda hand: hand.zero(0), ErrorNumber.ARGUMENT, errno.EINVAL),
        (lambda hand: hand.identify(0), ErrorNumber.ARGUMENT, errno.EINVAL),
    ],
)
def test_an_error_has_number_errno_and_remedy(remote, call, number, system):
    remote.send_position(1, HOME)
    with pytest.raises(sun2xp.Error) as refused:
        call(remote)
    error = refused.value
    assert (error.number, error.errno) == (number, system)
    assert error.remedy and error.text.endswith(error.remedy)


def test_joint_angles_have_the_name_of_the_argument(remote):
    with pytest.raises(sun2xp.Refused, match=r"^position has the shape \(2,\): pass an array with the shape \(3,\)"):
        remote.send_position(1, [0.0, 0.0])
    with pytest.raises(sun2xp.Refused, match=r"^joints is \[\[0.0, nan, 0.0\]\]: pass finite numbers"):
        remote.send_path(1, [1.0], [[0.0, float("nan"), 0.0]])


def test_a_closed_or_lost_hand_has_its_errno_and_remedy(server, remote):
    server.state(owner=server.number + 1)
    with pytest.raises(sun2xp.remote.NotOwner) as lost:
        remote.send_position(1, HOME)
    assert (lost.value.errno, "hand.acquire()" in lost.value.remedy) == (errno.EBUSY, True)
    remote.close()
    with pytest.raises(sun2xp.Closed) as closed:
        remote.send_position(1, HOME)
    assert (closed.value.errno, closed.value.remedy) == (errno.ENODEV, "open it again")


def test_a_hand_of_which_nothing_is_heard_any_more_is_lost(server, remote):
    """A Target contains the newest time that the client has received from the server. When this time is older than
    10 s (`end_ms` of this server), the server has ended the client's ownership, so the client must not send more."""
    server.silence = 9.0
    remote.send_position(1, HOME)
    assert remote.owned
    server.silence = 11.0
    targets = len(server.targets)
    server.hand.owner.publish(0)
    assert len(server.targets) == targets and not remote.owned
    for call in (lambda: remote.send_position(1, HOME), lambda: remote.wait(1, "applied", timeout=0)):
        with pytest.raises(sun2xp.remote.NotOwner):
            call()
    server.silence = 0.0
    assert not remote.owned
    remote.acquire()
    remote.send_position(1, HOME)


@pytest.mark.parametrize(
    ("code", "number"), [(6, ErrorNumber.LIMIT), (7, ErrorNumber.FAULTED), (9, ErrorNumber.BUSY)]
)
def test_the_number_of_a_refusal_is_its_reason(server, remote, code, number):
    remote.send_position(1, HOME)
    sequence = server.targets[-1][0]
    server._subscribers["refused"](server.answer(code, sequence, "finger 1 is faulted: recover it"))
    with pytest.raises(sun2xp.Refused) as refused:
        remote.send_position(1, HOME)
    assert (refused.value.number, refused.value.remedy) == (number, "recover it")
    # The text of the refusal concerns the earlier set point, and not that of this call.
    assert refused.value.text.startswith("the hand has refused an earlier set point, and keeps the set point before it")
    assert "it was not sent: send it again. Reason of the refusal: finger 1 is faulted" in refused.value.text


def test_the_refusals_of_several_fingers_are_separated(server, remote):
    for finger in (1, 2):
        remote.send_position(finger, HOME)
        server.refuse(server.targets[-1][0], f"finger {finger} is faulted: recover finger {finger}")
    with pytest.raises(sun2xp.Refused) as refused:
        remote.wait(timeout=0)
    assert refused.value.text.endswith(": finger 1 is faulted: recover finger 1; finger 2 is faulted: recover finger 2")


@pytest.mark.parametrize(
    ("call", "number"),
    [
        (lambda hand: hand.zero(1), ErrorNumber.CALIBRATION),
        (lambda hand: hand.identify(1), ErrorNumber.CALIBRATION),
        (lambda hand: hand.recover(1), ErrorNumber.PORT),
        (lambda hand: hand.acquire(recover=True), ErrorNumber.PORT),
    ],
)
def test_a_request_that_fails_refuses_no_argument(server, remote, call, number):
    server.code = 6
    with pytest.raises(sun2xp.Error) as failed:
        call(remote)
    assert not isinstance(failed.value, sun2xp.Refused) and failed.value.number == number


@pytest.mark.parametrize(("reported", "name"), [(True, ": lost replies (17 ms)"), (False, "")])
def test_a_fault_has_its_name_unless_the_server_does_not_report_it(server, remote, monkeypatch, reported, name):
    """The text of the fault in a Status ends in the middle of a word. The error has only the part before the colon."""
    remote.send_position(2, HOME)
    server.records["stage"][1], server.records["fault"][1] = _messages.STAGES.index("faulted"), 13
    server.status = {"fault": 13}
    server.apply()
    if not reported:
        monkeypatch.setattr(server, "get", lambda *_: [])
    with pytest.raises(sun2xp.Fault) as fault:
        remote.wait(2, timeout=0)
    assert (fault.value.finger, fault.value.fault) == (2, 13)
    assert fault.value.remedy == "remove the cause (docs/faults.md), and call hand.recover(2)"
    assert fault.value.text == f"finger 2 is faulted (fault 13){name}: {fault.value.remedy}"


def test_a_wait_takes_the_event_that_ended_it(server, remote, monkeypatch):
    events = remote.events()
    message = struct.pack("<BBBBHxxQQQ4d", 3, 1, 2, 0, EventKind.ARRIVED, 1, 7, 8 * MS, 1.0, 2.0, 3.0, 4.0)
    server._subscribers["events"](message)
    wait_for = events._receiver.wait_for

    def wait_while_another_thread_takes(holds, timeout):
        found = wait_for(holds, timeout)
        assert events.take() is None
        return found

    monkeypatch.setattr(events._receiver, "wait_for", wait_while_another_thread_takes)
    assert events.wait(5).kind == EventKind.ARRIVED


def test_an_event_has_the_values_of_its_kind(server, remote):
    events = remote.events()
    for kind in EventKind:
        message = struct.pack("<BBBBHxxQQQ4d", 3, 1, 2, 0, kind, int(kind), 7, 8 * MS, 1.0, 2.0, 3.0, 4.0)
        server._subscribers["events"](message)
    assert [len(event.values) for event in events_now(events)] == [_receiver.VALUES[kind] for kind in EventKind]
    assert _receiver.VALUES[EventKind.ARRIVED] == 3


@pytest.mark.parametrize(
    ("fault", "number", "part"),
    [(10, 0, "joint 0"), (11, 2, "joint 2"), (2, 4, "tendon 4"), (9, 1, "motor 1"), (13, 0, "finger")]
    + [(9999, 3, "part 3"), (float("nan"), 0, "finger"), (float("inf"), 1, "part 1")],
)
def test_the_part_of_a_fault_follows_from_its_number(server, remote, fault, number, part):
    events = remote.events()
    for kind in (EventKind.FAULT, EventKind.WARNING):
        message = struct.pack("<BBBBHxxQQQ4d", 3, 1, 2, number, kind, int(kind), 7, 8 * MS, fault, 2.0, 0.0, 0.0)
        server._subscribers["events"](message)
    assert [event.part for event in events_now(events)] == [part, part]


def test_the_parts_of_faults_are_those_of_the_page():
    page = (pathlib.Path(__file__).parents[2] / "docs/faults.md").read_text()
    rows = re.findall(r"^\| (\d+) \| `[A-Z_]+` \| [^|]+ \| (tendon|gauge|encoder|motor|joint)\b", page, re.MULTILINE)
    assert {int(number): part for number, part in rows} == _receiver.FAULT_PARTS


def events_now(events):
    return list(iter(events.take, None))


def test_the_types_of_events_have_as_many_values_as_in_the_library():
    from sun2xp import _sun2xp

    assert [(int(kind), count) for kind, count in _receiver.VALUES.items()] == _sun2xp.event_values()


def test_a_close_that_is_interrupted_closes_the_hand(server, remote, monkeypatch):
    undeclared = []
    remote._declared = [type("Declared", (), {"undeclare": lambda self: undeclared.append(self)})()]

    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(server, "get", interrupted)
    with pytest.raises(KeyboardInterrupt):
        remote.close()
    assert remote.closed and remote._receiver.closed and undeclared and not server.sender._owners


def test_files_of_tls_that_cannot_be_read_are_named(tmp_path):
    missing = tmp_path / "missing.pem"
    present = tmp_path / "present.pem"
    present.write_text("")
    for files in [(missing, present, present), (present, missing, present), (present, present, missing)]:
        with pytest.raises(sun2xp.ConfigurationError, match="missing.pem"):
            sun2xp.remote.connect("tls/127.0.0.1:9", client="planner", tls=sun2xp.remote.Tls(*files))


def test_a_connection_that_is_closed_refuses_calls():
    endpoint = free_endpoint()
    with Double(endpoint):
        network = sun2xp.remote.connect(endpoint)
        network.close()
        for call in (network.hands, network.open):
            with pytest.raises(sun2xp.Closed):
                call()


def test_an_acquire_that_is_interrupted_closes_the_hand(monkeypatch):
    endpoint = free_endpoint()

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(sun2xp.remote.RemoteHand, "acquire", interrupted)
    with Double(endpoint), sun2xp.remote.connect(endpoint) as network:
        with pytest.raises(KeyboardInterrupt):
            network.open("hand")
        assert network._hands == [] and network.sender._owners == []

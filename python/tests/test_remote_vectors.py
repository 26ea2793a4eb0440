"""Compares `sun2xp.remote` with the test vectors of the protocol: it writes the messages that a client sends, and reads
those that a client receives."""

import json
import math
import pathlib

import numpy
import pytest

import sun2xp
from sun2xp.remote import _messages, _network

VECTORS = json.loads((pathlib.Path(__file__).parents[2] / "remote/vectors.json").read_text())

READERS = {
    "State": _messages.read_state,
    "Event": _messages.read_event,
    "Status": _messages.read_status,
    "Answer": _messages.read_answer,
}


def of_type(section, *types):
    return [
        pytest.param(vector, id=f"{vector['type']}-{vector['name']}")
        for vector in VECTORS[section]
        if vector["type"] in types
    ]


def part_of(fields):
    part = _messages.Part(fields["finger"], fields["command"])
    for place, name in [(_messages.JOINTS, "joints"), (_messages.TIP, "tip")]:
        if fields[name] is not None:
            part.place, part.values = place, fields[name]
    if fields["path"] is not None:
        part.place = _messages.PATH
        part.poses = [(pose["time"], *pose["joints"]) for pose in fields["path"]]
    if fields["stiffness"] is not None:
        part.stiffness = numpy.ravel(fields["stiffness"]).tolist()
    part.damping = fields["damping"]
    return part


@pytest.mark.parametrize("vector", of_type("messages", "Target"))
def test_a_target_is_written(vector):
    parts = [part_of(fields) for fields in vector["parts"]]
    numbers = [vector[name] for name in ("validity_ms", "epoch", "sequence", "sent", "seen")]
    assert _messages.write_target(_messages.Target(*numbers, parts)).hex() == vector["payload"]


@pytest.mark.parametrize("vector", of_type("messages", "Request"))
def test_a_request_is_written(vector):
    flags = {name: vector[name] for name in ("take_over", "recover")}
    payload = _messages.write_request(vector["action"], vector["finger"], vector["epoch"], **flags)
    assert payload.hex() == vector["payload"]


@pytest.mark.parametrize("vector", of_type("messages", "State"))
def test_a_state_is_read(vector):
    state = _messages.read_state(bytes.fromhex(vector["payload"]))
    assert [state.missing, state.number, state.published, state.owner] == [
        vector[name] for name in ("missing", "number", "time", "owner")
    ]
    assert len(state.records) == len(vector["records"])
    for record, fields in zip(state.records, vector["records"]):
        assert record["time"] == fields["begin"]
        for name in ("finger", "stage", "fault", "command", "cycle"):
            assert record[name] == fields[name], name
        assert bool(record["bits"] & _messages.TOUCHING) == fields["touching"]
        assert bool(record["bits"] & _messages.CAUGHT) == fields["caught"]
        assert bool(record["bits"] & _messages.ARRIVED) == fields["arrived"]
        assert bool(record["bits"] & _messages.SETTLED) == fields["settled"]
        for name, field in [("joints",) * 2, ("tip",) * 2, ("force", "tip_force"), ("tensions",) * 2]:
            assert record[field].tolist() == fields[name], name
        expected = [math.nan] * 3 if fields["set_point"] is None else fields["set_point"]
        assert numpy.array_equal(record["joint_set_point"], expected, equal_nan=True)


@pytest.mark.parametrize("vector", of_type("messages", "Event"))
def test_an_event_is_read(vector):
    event = _messages.read_event(bytes.fromhex(vector["payload"]))
    names = {"finger": "finger", "part": "part", "kind": "kind", "number": "number", "cycle": "cycle", "time": "begin"}
    assert {name: getattr(event, name) for name in names} == {name: vector[field] for name, field in names.items()}
    assert [None if math.isnan(value) else value for value in event.values] == vector["values"]


@pytest.mark.parametrize("vector", of_type("messages", "Status"))
def test_a_status_is_read(vector):
    status = _messages.read_status(bytes.fromhex(vector["payload"]))
    for name in ("catch_ms", "end_ms", "clients", "time", "rate", "lead_force", "soft_stiffness", "owner"):
        assert getattr(status, name) == vector[name], name
    counted = ("taken", "malformed", "old_epoch", "replayed", "late", "refused", "caught", "ended")
    assert list(status.counts) == [vector[name] for name in counted]
    for number, fields in enumerate(vector["fingers"], 1):
        assert (number in status.fingers) == (fields is not None)
        if fields is None:
            continue
        finger = status.fingers[number]
        assert finger.stage == _messages.STAGES[fields["stage"]]
        assert finger.limits.tolist() == [fields["low"], fields["high"]]
        for name, field in [
            ("fault",) * 2, ("warnings",) * 2, ("cycles",) * 2, ("skipped", "skipped_periods"),
            ("lost", "lost_replies"), ("corrupt", "corrupt_replies"), ("stiffness", "stiffness_bound"),
            ("calibration",) * 2, ("text", "fault_text"),
        ]:
            assert getattr(finger, name) == fields[field], name


@pytest.mark.parametrize("vector", of_type("messages", "Answer"))
def test_an_answer_is_read(vector):
    answer = _messages.read_answer(bytes.fromhex(vector["payload"]))
    names = ("code", "catch_ms", "epoch", "time", "number", "text")
    assert [getattr(answer, name) for name in names] == [vector[name] for name in names]


@pytest.mark.parametrize("vector", of_type("malformed", *READERS))
def test_a_malformed_message_is_dropped(vector):
    assert READERS[vector["type"]](bytes.fromhex(vector["payload"])) is None, vector["reason"]


@pytest.mark.parametrize("vector", [pytest.param(vector, id=vector["name"][:40]) for vector in VECTORS["names"]])
def test_names_are_accepted_or_refused(vector):
    for check, good in [
        (_network.checked_hand, vector["of_a_hand"]),
        (lambda name: _network.checked_client(name, None), vector["of_a_client"]),
    ]:
        if good:
            assert check(vector["name"]) == vector["name"]
        else:
            with pytest.raises(sun2xp.ConfigurationError):
                check(vector["name"])


def test_every_kind_of_message_has_vectors():
    assert {vector["type"] for vector in VECTORS["messages"]} == {*READERS, "Target", "Request"}
    assert VECTORS["protocol"] == _messages.VERSION

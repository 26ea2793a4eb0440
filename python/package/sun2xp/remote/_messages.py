"""The messages of docs/remote-protocol.md, as bytes and as objects. This module does no input or output.

Each function read_... returns None for bytes that are not one whole and valid message of its type, of version 1.
"""

from __future__ import annotations

import dataclasses
import math
import re
import struct
from typing import Dict, List, Optional, Sequence, Tuple

import numpy
import numpy.typing

from .._types import Array

VERSION = 1

TARGET, STATE, EVENT, STATUS, REQUEST, ANSWER = 1, 2, 3, 4, 5, 6

#: The number of each action of a Request. The action's name is a part of the Zenoh key to which the Request is sent.
ACTIONS = {"acquire": 1, "release": 2, "recover": 3, "calibrate": 4, "identify": 5, "stop": 6}

#: The values of `place` in a part of a Target.
NO_PLACE, JOINTS, TIP, PATH = 0, 1, 2, 3

#: Largest number of poses of a path.
MOST_POSES = 32

#: Names of the stages, by their numbers.
STAGES = ("opening", "limp", "calibrating", "running", "closing", "closed", "faulted")

#: The highest code of an Answer.
_LAST_CODE = 9

#: The number of the stage "faulted".
_FAULTED = 6

#: Names that a client can have.
CLIENT = re.compile(r"[A-Za-z0-9._-]{1,64}\Z")

_TARGET = struct.Struct("<BBBxIQQQQ")
_PART = struct.Struct("<BBBBI3d9dd")
_POSE = struct.Struct("<4d")
_STATE = struct.Struct("<BBHIQQQ")
_EVENT = struct.Struct("<BBBBHxxQQQ4d")
_STATUS = struct.Struct("<BBBxIIIQ3d8Q")
_FINGER = struct.Struct("<BxHIQQQQ3d3dddB71s")
_REQUEST = struct.Struct("<BBBBB3xQ")
_ANSWER = struct.Struct("<BBHIQQQH")

#: A record of State: one cycle of one finger.
RECORD = numpy.dtype([
    ("finger", "u1"),
    ("stage", "u1"),
    ("fault", "<u2"),
    ("command", "<u4"),
    ("cycle", "<u8"),
    ("time", "<u8"),
    ("bits", "u1"),
    ("reserved", "V7"),
    ("joints", "<f8", 3),
    ("joint_set_point", "<f8", 3),
    ("tip", "<f8", 3),
    ("tip_force", "<f8", 3),
    ("tensions", "<f8", 4),
])

#: Bits of a record.
TOUCHING, CAUGHT, ARRIVED, SETTLED = 1, 2, 4, 8


@dataclasses.dataclass
class Part:
    """What a Target says about one finger."""

    finger: int
    command: int
    place: int = NO_PLACE
    #: Joint angles, rad, or the position of the tip, cm.
    values: Sequence[float] = (0.0, 0.0, 0.0)
    #: Kx, row by row, N/cm.
    stiffness: Optional[Sequence[float]] = None
    damping: Optional[float] = None
    #: Poses of a path: time, s, and three joint angles, rad.
    poses: Sequence[Sequence[float]] = ()


@dataclasses.dataclass
class Target:
    """Set points of up to three fingers. `validity` is in ms. The times `sent` and `seen` are in ns."""

    validity: int
    epoch: int
    sequence: int
    sent: int
    seen: int
    parts: List[Part]


@dataclasses.dataclass
class State:
    """The cycles since the previous State. A finger that has stopped has one record, with its newest cycle."""

    missing: int
    number: int
    published: int
    owner: int
    #: Of type RECORD.
    records: numpy.typing.NDArray[numpy.void]


@dataclasses.dataclass
class EventMessage:
    """An event of a finger."""

    finger: int
    part: int
    kind: int
    number: int
    cycle: int
    time: int
    values: Tuple[float, ...]


@dataclasses.dataclass
class FingerRecord:
    """What Status says about one finger."""

    stage: str
    fault: int
    warnings: int
    cycles: int
    skipped: int
    lost: int
    corrupt: int
    #: Smallest (row 0) and largest (row 1) joint angles, rad.
    limits: Array
    #: Largest eigenvalue of Kx that the finger admits, N/cm.
    stiffness: float
    calibration: float
    text: str


@dataclasses.dataclass
class StatusMessage:
    """The status of a hand and of its server."""

    catch_ms: int
    end_ms: int
    clients: int
    time: int
    rate: float
    lead_force: float
    soft_stiffness: float
    counts: Tuple[int, ...]
    #: By the number of the finger.
    fingers: Dict[int, FingerRecord]
    owner: str


@dataclasses.dataclass
class Answer:
    """The answer to a Request, or the reason why a Target was refused. For a refused Target, `number` is its sequence
    number. For an acquire with code 0, `number` is the public number of the new epoch, and `epoch` is the epoch itself:
    a random number that only its owner and the server know."""

    code: int
    catch_ms: int
    epoch: int
    time: int
    number: int
    text: str


def write_target(target: Target) -> bytes:
    """Returns the bytes of a Target."""
    head = (target.validity, target.epoch, target.sequence, target.sent, target.seen)
    parts = sorted(target.parts, key=lambda part: part.finger)
    return _TARGET.pack(TARGET, VERSION, len(parts), *head) + b"".join(map(_write_part, parts))


def _write_part(part: Part) -> bytes:
    bits = (part.stiffness is not None) | (part.damping is not None) << 1
    kx = (0.0,) * 9 if part.stiffness is None else part.stiffness
    head = (part.finger, part.place, bits, len(part.poses), part.command)
    poses = b"".join(_POSE.pack(*pose) for pose in part.poses)
    return _PART.pack(*head, *part.values, *kx, part.damping or 0.0) + poses


def read_state(data: bytes) -> Optional[State]:
    """Reads a State."""
    if not _begins(data, STATE, _STATE.size):
        return None
    _, _, count, missing, number, published, owner = _STATE.unpack_from(data)
    if count > 300 or len(data) != _STATE.size + count * RECORD.itemsize:
        return None
    records = numpy.frombuffer(data, RECORD, offset=_STATE.size)
    return State(missing, number, published, owner, records) if _sound(records) else None


def _sound(records: numpy.typing.NDArray[numpy.void]) -> bool:
    """Returns whether docs/remote-protocol.md allows every value of the records."""
    set_points = numpy.isnan(records["joint_set_point"])
    finite = [records[name] for name in ("joints", "tip", "tip_force", "tensions")]
    return bool(
        ((records["finger"] - 1) < 3).all()
        and (records["stage"] < len(STAGES)).all()
        and ((records["fault"] == 0) == (records["stage"] != _FAULTED)).all()
        and (records["bits"] <= TOUCHING | CAUGHT | ARRIVED | SETTLED).all()
        and (set_points.all(axis=1) == set_points.any(axis=1)).all()
        and not numpy.isinf(records["joint_set_point"]).any()
        and all(numpy.isfinite(values).all() for values in finite)
        and all(
            (numpy.diff(records["cycle"][records["finger"] == finger].astype(numpy.int64)) > 0).all()
            for finger in (1, 2, 3)
        )
    )


def read_event(data: bytes) -> Optional[EventMessage]:
    """Reads an Event."""
    if not _begins(data, EVENT, _EVENT.size, _EVENT.size):
        return None
    _, _, finger, part, kind, number, cycle, time, *values = _EVENT.unpack(data)
    if finger not in (1, 2, 3) or 0 in (kind, number):
        return None
    return EventMessage(finger, part, kind, number, cycle, time, tuple(values))


def read_status(data: bytes) -> Optional[StatusMessage]:
    """Reads a Status."""
    end = _STATUS.size + 3 * _FINGER.size
    if not _begins(data, STATUS, end + 1) or len(data) != end + 1 + data[end]:
        return None
    _, _, bits, catch_ms, end_ms, clients, time, rate, lead, soft, *counts = _STATUS.unpack_from(data)
    floats = (rate, lead, soft)
    if not (bits < 8 and catch_ms and end_ms and all(map(math.isfinite, floats)) and rate > 0 < lead and soft >= 0):
        return None
    fingers = {}
    for finger in (1, 2, 3):
        if bits >> (finger - 1) & 1:
            record = _read_finger(data, _STATUS.size + (finger - 1) * _FINGER.size)
            if record is None:
                return None
            fingers[finger] = record
        elif any(data[_STATUS.size + (finger - 1) * _FINGER.size :][: _FINGER.size]):
            return None
    owner = _text(data[end + 1 :])
    if owner is None or not CLIENT.match(owner or "-"):
        return None
    return StatusMessage(catch_ms, end_ms, clients, time, rate, lead, soft, tuple(counts), fingers, owner)


def _read_finger(data: bytes, offset: int) -> Optional[FingerRecord]:
    stage, fault, warnings, cycles, skipped, lost, corrupt, *values = _FINGER.unpack_from(data, offset)
    *numbers, length, text = values
    if stage >= len(STAGES) or length > len(text) or not all(map(math.isfinite, numbers)):
        return None
    limits = numpy.array([numbers[:3], numbers[3:6]])
    largest, calibration = numbers[6:]
    said = _text(text[:length])
    faulted = stage == _FAULTED
    if (fault != 0) != faulted or said is None or any(text[length:]) or (said and not faulted):
        return None
    if (limits[0] > limits[1]).any() or largest < 0 or not 0 <= calibration <= 1:
        return None
    counts = (warnings, cycles, skipped, lost, corrupt)
    return FingerRecord(STAGES[stage], fault, *counts, limits, largest, calibration, said)


def write_request(action: str, finger: int, epoch: int, *, take_over: bool = False, recover: bool = False) -> bytes:
    """Returns the bytes of a Request. The action is a key of ACTIONS."""
    return _REQUEST.pack(REQUEST, VERSION, ACTIONS[action], finger, take_over | recover << 1, epoch)


def read_answer(data: bytes) -> Optional[Answer]:
    """Reads an Answer."""
    if not _begins(data, ANSWER, _ANSWER.size):
        return None
    _, _, code, catch_ms, epoch, time, number, length = _ANSWER.unpack_from(data)
    text = _text(data[_ANSWER.size :])
    sound = code <= _LAST_CODE and catch_ms > 0 and not (code == 0 and text)
    if len(data) != _ANSWER.size + length or text is None or not sound:
        return None
    return Answer(code, catch_ms, epoch, time, number, text)


def _begins(data: bytes, kind: int, least: int, most: Optional[int] = None) -> bool:
    """Returns whether the bytes begin with this type and the version, and have a length from `least` to `most`."""
    return least <= len(data) <= (len(data) if most is None else most) and data[0] == kind and data[1] == VERSION


def _text(data: bytes) -> Optional[str]:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return None

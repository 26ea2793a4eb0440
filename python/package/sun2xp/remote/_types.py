"""The results of the calls of a remote hand, and the files for its TLS connection. Lengths are in cm, forces in N,
angles in rad, stiffnesses in N/cm. Times are in ns of the server's clock, unless a field says otherwise."""

from __future__ import annotations

import dataclasses
import os
from typing import Dict, Optional, Tuple, Union

from .._types import Array
from ._messages import FingerRecord, StatusMessage

_Path = Union[str, "os.PathLike[str]"]


@dataclasses.dataclass(frozen=True)
class Tls:
    """The files of mutual TLS, in PEM. The common name of the certificate is the name of the client."""

    #: Certificate of the authority that has signed the server's certificate.
    authority: _Path
    #: Certificate of this client.
    certificate: _Path
    #: Private key of this certificate.
    key: _Path


@dataclasses.dataclass(frozen=True, eq=False)
class FingerState:
    """One cycle of a finger."""

    #: Number of the finger, 1 to 3.
    finger: int
    #: Number of the cycle, counted since the server opened the hand.
    cycle: int
    #: Beginning of the cycle.
    time: int
    #: "opening", "limp", "calibrating", "running", "closing", "closed" or "faulted".
    stage: str
    #: Number of the fault, as in docs/faults.md; 0 if there is none.
    fault: int
    #: Number of the command that the server has applied last; 0 if it has applied none.
    command: int
    #: Whether the server holds the finger because the targets of the hand's owner have become too old.
    caught: bool
    #: Whether the finger touches something.
    touching: bool
    #: Joint angles, rad: shape (3,).
    position: Array
    #: Joint angles of the set point, rad: shape (3,). None if the finger is not controlled as a spring, for example
    #: during calibration or after a fault.
    set_point: Optional[Array]
    #: Position of the tip in the finger's frame, cm: shape (3,).
    tip: Array
    #: Force of the tip on what it touches, in the finger's frame, N: shape (3,). It includes the effects of friction,
    #: weight and inertia of the finger.
    force: Array
    #: Tensions of tendons 1 to 4, N: shape (4,).
    tensions: Array


@dataclasses.dataclass(frozen=True, eq=False)
class Tip:
    """The state of a fingertip, in the finger's frame."""

    #: Position, cm: shape (3,).
    position: Array
    #: Force on the touched object, N: shape (3,).
    force: Array
    #: Tensions of tendons 1 to 4, N: shape (4,).
    tensions: Array
    #: Whether the finger touches something.
    touching: bool


@dataclasses.dataclass(frozen=True)
class Counts:
    """What the server has done with Targets (messages with set points) since its start. docs/remote-protocol.md
    describes each count."""

    #: Targets whose set points the server has taken.
    taken: int
    #: Targets that are not valid messages.
    malformed: int
    #: Targets of an epoch that has ended, or of a client that does not own the hand.
    old_epoch: int
    #: Targets that arrived a second time or in the wrong order.
    replayed: int
    #: Targets that were too old when they arrived.
    late: int
    #: Targets with a set point that the hand does not accept.
    refused: int
    #: Number of times that the fingers were held because the owner's targets had become too old.
    caught: int
    #: Number of times that the fingers went to their end state because the owner fell silent.
    ended: int


@dataclasses.dataclass(frozen=True, eq=False)
class FingerStatus:
    """The status of one finger."""

    #: The stage, one of those of FingerState.
    stage: str
    #: Number of the fault, and the beginning of the fault's text; 0 and "" if there is no fault.
    fault: int
    fault_text: str
    #: Warnings since the hand was opened; a warning that persists counts once.
    warnings: int
    #: Cycles since open, skipped periods, lost replies and corrupt replies.
    cycles: int
    skipped_periods: int
    lost_replies: int
    corrupt_replies: int
    #: Joint limits, rad: shape (2, 3). Row 0 has the lower limits, row 1 the upper ones.
    joints: Array
    #: Largest eigenvalue of Kx that the finger admits, N/cm.
    stiffness: float
    #: Completed part of the calibration in progress, 0 to 1; 0 if there is none.
    calibration: float


@dataclasses.dataclass(frozen=True, eq=False)
class Status:
    """The status of a hand and of its server."""

    #: Name of the client that commands the hand; None if there is none.
    owner: Optional[str]
    #: The status of each finger that the hand has, by the number of the finger.
    fingers: Dict[int, FingerStatus]
    #: Time at which the server made this status.
    time: int
    #: Ages of the newest target, s: at `catch` the server holds the fingers, and at `end` they go to their end state.
    catch: float
    end: float
    #: Rate of the servos, Hz.
    rate: float
    #: Largest force with which a set point pulls a fingertip, N.
    lead_force: float
    #: Stiffness with which the server holds a finger, N/cm.
    soft_stiffness: float
    #: Number of clients that have sent a permitted request, such as acquire, since the start of the server.
    clients: int
    counts: Counts


def status(message: StatusMessage) -> Status:
    """Returns the public form of a Status."""
    fingers = {finger: _finger_status(record) for finger, record in message.fingers.items()}
    return Status(
        owner=message.owner or None,
        fingers=fingers,
        time=message.time,
        catch=message.catch_ms / 1000,
        end=message.end_ms / 1000,
        rate=message.rate,
        lead_force=message.lead_force,
        soft_stiffness=message.soft_stiffness,
        clients=message.clients,
        counts=Counts(*message.counts),
    )


def _finger_status(record: FingerRecord) -> FingerStatus:
    counts: Tuple[int, int, int, int] = (record.cycles, record.skipped, record.lost, record.corrupt)
    return FingerStatus(
        record.stage, record.fault, record.text, record.warnings, *counts, record.limits, record.stiffness,
        record.calibration,
    )

"""What happened to a finger."""

from __future__ import annotations

import dataclasses
import enum
from typing import Optional, Tuple


@dataclasses.dataclass(frozen=True, eq=False)
class FaultDescription:
    """A fault or a warning."""

    #: Number, as in docs/faults.md.
    number: int
    #: Name, such as "broken tendon".
    name: str
    #: The part that has the fault, such as "tendon 3", or "finger".
    part: str
    #: Value of the fault in the unit of docs/faults.md; 0 if there is none.
    value: float
    #: What has happened, the likely cause and the remedy.
    text: str
    #: What to do.
    remedy: str


@dataclasses.dataclass(frozen=True, eq=False)
class FingerFault:
    """The fault and the warnings of a finger."""

    #: The fault that has stopped the finger; None if it has not stopped.
    stopped: Optional[FaultDescription]
    #: The newest warning of the last second. Without such a warning, it is the warning REALTIME_REFUSED if the system
    #: has refused SCHED_FIFO to the servo, and otherwise None. `warnings` does not count REALTIME_REFUSED.
    warning: Optional[FaultDescription]
    #: Number of warnings since open. A warning that persists counts once.
    warnings: int


class EventKind(enum.IntEnum):
    """The kind of an event (docs/events.md)."""

    TOUCH_MADE = 1
    TOUCH_LOST = 2
    TOUCH_SLIP = 3
    TOUCH_PRESSURE = 4
    CONTACT = 5
    CONTACT_LOST = 6
    SLIP = 7
    TENSION_BOUND = 8
    FORCE_BOUND = 9
    JOINT_AT_LIMIT = 10
    ARRIVED = 11
    SETTLED = 12
    FAULT = 13
    WARNING = 14
    REFLEX_FIRED = 15
    PATH_ENDED = 16
    EXPIRED = 17
    TOUCH_INVALID = 18


@dataclasses.dataclass(frozen=True, eq=False)
class Event:
    """Something that happened to a finger in one cycle of its servo."""

    #: Number of the finger, 1 to 3.
    finger: int
    #: Number of the cycle. Each finger counts its own cycles from 1.
    cycle: int
    #: Beginning of this cycle, ns of CLOCK_MONOTONIC, as `time.monotonic_ns` counts.
    time: int
    #: Kind of the event.
    kind: EventKind
    #: The part that the event concerns, such as "tendon 3", or "finger".
    part: str
    #: Values. Their meanings and units depend on the kind (docs/events.md).
    values: Tuple[float, ...]
    #: What happened, in words.
    text: str


@dataclasses.dataclass(frozen=True, eq=False)
class Mark:
    """Something that happened in a recording."""

    #: Time, ns of CLOCK_MONOTONIC.
    time: int
    #: Number of the finger; None for the whole hand.
    finger: Optional[int]
    #: Number of the cycle; None if the mark belongs to no cycle.
    cycle: Optional[int]
    #: "stage", "event", "gap", "warning" or "fault".
    kind: str
    #: What happened, in words.
    text: str

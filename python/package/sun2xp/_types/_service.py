"""How a finger and its servo thread run."""

from __future__ import annotations

import dataclasses


@dataclasses.dataclass(frozen=True, eq=False)
class Distribution:
    """The distribution of a duration, microseconds."""

    #: Number of cycles.
    count: int
    #: Shortest duration.
    minimum: float
    #: Median.
    median: float
    #: 99 % of the durations are not longer.
    p99: float
    #: 99.9 % of the durations are not longer.
    p999: float
    #: Longest duration.
    maximum: float


@dataclasses.dataclass(frozen=True, eq=False)
class Losses:
    """Counts of a finger's cycles, and of the errors in them."""

    #: Number of cycles.
    cycles: int
    #: Cycles that ended after the next one should have begun.
    overruns: int
    #: Whole periods in which no cycle began because the previous cycle was late or the servo thread did not run.
    skipped_periods: int
    #: Cycles without a valid reply in time.
    lost_replies: int
    #: Replies that arrived after the end of their cycle.
    late_replies: int
    #: Replies that arrived twice.
    duplicate_replies: int
    #: Byte sequences on the finger's port that were not valid frames.
    damaged_replies: int
    #: Valid frames on the finger's port that no finger waited for.
    foreign_frames: int


@dataclasses.dataclass(frozen=True, eq=False)
class Status:
    """The status of a finger and of its servo thread."""

    #: "opening", "limp", "calibrating", "running", "closing", "closed" or "faulted".
    stage: str
    #: Whether every servo thread runs under SCHED_FIFO.
    realtime: bool
    #: Whether every servo thread has its memory locked.
    memory_locked: bool
    #: Whether every servo thread runs on its configured core, if one is configured.
    on_core: bool
    #: Configured rate, Hz.
    rate: float
    #: Measured rate since open, Hz.
    measured_rate: float
    #: Time from the scheduled beginning of a cycle to its first instruction, microseconds.
    wake_up: Distribution
    #: Cycles and errors since open.
    losses: Losses
    #: Part of the desired joint torque that the tension limits permitted in the last cycle, 0 to 1.
    torque_scale: float
    #: Part of Kx that was applied in the last cycle, 0 to 1.
    stiffness_scale: float
    #: Completed part of the calibration in progress, 0 to 1; 0 if there is none.
    calibration: float

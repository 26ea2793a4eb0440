//! The exported functions that tell how the servo of a finger is doing. As in `calls.rs`, their comments are the C manual.

// Named like the calls of 1990.
#![allow(non_snake_case)]

use crate::capi::default_hand;
use crate::capi::memory::{fill, size_up_to};
use crate::capi::refusal::guarded;
use crate::finger::{Losses, Stage};
use crate::hand::{self, Hand, HandError};
use crate::model::configuration::FINGERS;
use crate::realtime::{self, Distribution};
use std::ffi::{c_int, c_uint, c_ulong};

/// FingerStatus.State: the fingertip is the spring that it was told to be.
pub const FINGER_RUNNING: c_int = 1;

/// FingerStatus.State: the finger has stopped by itself, its motors are in the
/// configured end state, and its calls are refused with EIO and the reason. RecoverHand,
/// or CloseHand and OpenHand, start again.
pub const FINGER_FAULTED: c_int = 2;

/// FingerStatus.State: the motors are off, after a calibration that was refused (which
/// says why). Set points have no effect. Another calibration, or CloseHand and OpenHand,
/// make it a spring again.
pub const FINGER_LIMP: c_int = 3;

/// FingerStatus.State: ZeroFinger or IdentifyFinger moves the finger, or its tendons are
/// brought under tension. Set points have no effect.
pub const FINGER_CALIBRATING: c_int = 4;

/// What GetStatus tells of a finger. Set Size = sizeof (struct FingerStatus) before the
/// call: later versions add members at the end, and a program never gets more than it
/// has room for.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerStatus {
    /// In: bytes of room, sizeof *Status. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// FINGER_RUNNING, FINGER_FAULTED, FINGER_LIMP or FINGER_CALIBRATING.
    pub State: c_int,
    /// 1: the servo thread runs under SCHED_FIFO. 0: it does not, and shares its core with
    /// everybody.
    pub Realtime: c_int,
    /// Configured servo rate, Hz.
    pub Rate: f64,
    /// Measured servo rate since OpenHand, Hz.
    pub MeasuredRate: f64,
    /// How late cycles began, microseconds: half of them no later than this. The servo's
    /// jitter.
    pub WakeUpMedian: f64,
    /// The same, microseconds: 99 of 100 cycles no later than this.
    pub WakeUp99: f64,
    /// The same, microseconds: the worst since OpenHand.
    pub WakeUpMaximum: f64,
    /// The part of the joint torque that the tension limits let through in the last cycle,
    /// 0 to 1. Its direction is kept.
    pub TorqueScale: f64,
    /// Cycles since OpenHand.
    pub Cycles: c_ulong,
    /// Periods that were skipped because the servo was late.
    pub LateCycles: c_ulong,
    /// Cycles without a valid reply from the board.
    pub LostReplies: c_ulong,
    /// Damaged or foreign frames on the finger's port.
    pub DamagedFrames: c_ulong,
    /// The part of the calibration under way that is done, 0 to 1; 0 where there is none.
    pub Calibration: f64,
    /// 1: the memory that the servo thread uses is locked, so that it never waits for a page.
    /// 0: it is not.
    pub MemoryLocked: c_int,
    /// 1: the servo thread runs on the configured core, or none is configured. 0: it does not.
    pub OnCore: c_int,
}

/// Stage for GetTiming: from the scheduled beginning of a cycle to the thread's first
/// instruction.
pub const TIMING_WAKE_UP: c_int = 0;

/// Stage for GetTiming: handing the commands of the port to the system.
pub const TIMING_WRITE: c_int = 1;

/// Stage for GetTiming: from there until the reply can be read: both ways on the line, and
/// the board.
pub const TIMING_WIRE: c_int = 2;

/// Stage for GetTiming: reading the reply.
pub const TIMING_READ: c_int = 3;

/// Stage for GetTiming: from bytes to the finger's reply, checks included.
pub const TIMING_DECODE: c_int = 4;

/// Stage for GetTiming: the controller.
pub const TIMING_COMPUTE: c_int = 5;

/// Stage for GetTiming: from the scheduled beginning of a cycle to the end of its
/// computation.
pub const TIMING_CYCLE: c_int = 6;

/// Stage for GetTiming: how old the newest measurement is when the command that was
/// computed from it takes effect, by the board's clock. One period where nothing is late.
pub const TIMING_AGE: c_int = 7;

/// What GetTiming tells of a stage of a finger's cycle. Set Size = sizeof (struct
/// FingerTiming) before the call: later versions add members at the end, and a program
/// never gets more than it has room for.
///
/// All times are ns, within 1 %, at most 4.29e9, and 0 where nothing was counted. All
/// numbers are since OpenHand or the finger's last ResetTiming.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerTiming {
    /// In: bytes of room, sizeof *Timing. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// The stage that was asked for.
    pub Stage: c_int,
    /// Cycles that had this stage.
    pub Count: c_ulong,
    /// The shortest.
    pub Minimum: c_ulong,
    /// Half of them took no longer.
    pub Median: c_ulong,
    /// 99 of 100 took no longer.
    pub P99: c_ulong,
    /// 999 of 1000 took no longer.
    pub P999: c_ulong,
    /// The longest.
    pub Maximum: c_ulong,
    /// The finger's cycles, with or without this stage, like all that follows.
    pub Cycles: c_ulong,
    /// Cycles that were not over when the next one should have begun.
    pub Overruns: c_ulong,
    /// Whole periods that were skipped because of that.
    pub SkippedPeriods: c_ulong,
    /// Cycles without a valid reply in time.
    pub LostReplies: c_ulong,
    /// Replies that came when their cycle was over.
    pub LateReplies: c_ulong,
    /// Pieces of bytes on the finger's port that were no frame: damaged, cut short, noise.
    pub CorruptReplies: c_ulong,
    /// Replies that came once more.
    pub DuplicateReplies: c_ulong,
    /// Whole frames on the finger's port that nobody waited for.
    pub ForeignFrames: c_ulong,
}

/// GetStatus - rate, jitter and losses of a finger's servo
///
///     int GetStatus(int i, struct FingerStatus *Status);
///
///   i        finger, 1 to 3
///   Status   Status->Size is set by the caller, all else is filled in. Written only if
///            the call returns 0
///
/// Works on a faulted finger too.
///
/// Returns 0, or -1 with
///   EFAULT   Status is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   EPERM    forked child
///
/// Threads: any.
///
///     struct FingerStatus Status;
///     Status.Size = sizeof Status;
///     if (GetStatus(1, &Status) == 0) printf("%.1f Hz\n", Status.MeasuredRate);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetStatus(i: c_int, Status: *mut FingerStatus) -> c_int {
    guarded("GetStatus", || {
        let least = size_up_to!(FingerStatus, DamagedFrames: c_ulong);
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Status, "Status", least, |hand| hand.status(i).map(|status| told(&status))) }
    })
}

/// GetTiming - where the time of a finger's cycles goes
///
///     int GetTiming(int i, int Stage, struct FingerTiming *Timing);
///
///   i        finger, 1 to 3
///   Stage    TIMING_WAKE_UP to TIMING_AGE
///   Timing   Timing->Size is set by the caller, all else is filled in. Written only if
///            the call returns 0
///
/// Works while the servo runs, and on a faulted finger too.
///
/// Returns 0, or -1 with
///   EFAULT   Timing is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger; no such Stage
///   EPERM    forked child
///
/// Threads: any. Never waits for a servo; some us.
///
///     struct FingerTiming Timing;
///     Timing.Size = sizeof Timing;
///     if (GetTiming(1, TIMING_WIRE, &Timing) == 0) printf("%lu ns\n", Timing.P99);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetTiming(i: c_int, Stage: c_int, Timing: *mut FingerTiming) -> c_int {
    guarded("GetTiming", || {
        let least = size_up_to!(FingerTiming, CorruptReplies: c_ulong);
        let tell = |hand: &Hand| {
            let losses = hand.losses(i)?;
            let times = hand.timing(i, stage(Stage).ok_or(HandError::NoSuchStage(Stage))?)?;
            Ok(timing(Stage, &times, &losses))
        };
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Timing, "Timing", least, tell) }
    })
}

/// ResetTiming - begin to count anew what GetTiming tells
///
///     int ResetTiming(int i);
///
///   i        finger, 1 to 3; 0: all
///
/// What GetStatus tells since OpenHand goes on, but for the wake-up times, which are
/// those of GetTiming.
///
/// Returns 0, or -1 with
///   ENODEV   no hand is open
///   EINVAL   no such finger
///   EPERM    forked child
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub extern "C" fn ResetTiming(i: c_int) -> c_int {
    guarded("ResetTiming", || {
        default_hand::with(|hand| match i {
            0 => (1..=FINGERS as c_int).try_for_each(|finger| hand.reset_timing(finger)),
            finger => hand.reset_timing(finger),
        })
    })
}

fn stage(number: c_int) -> Option<realtime::Stage> {
    use realtime::Stage;
    match number {
        TIMING_WAKE_UP => Some(Stage::WakeUp),
        TIMING_WRITE => Some(Stage::Write),
        TIMING_WIRE => Some(Stage::Wire),
        TIMING_READ => Some(Stage::Read),
        TIMING_DECODE => Some(Stage::Decode),
        TIMING_COMPUTE => Some(Stage::Compute),
        TIMING_CYCLE => Some(Stage::Whole),
        TIMING_AGE => Some(Stage::Age),
        _ => None,
    }
}

fn told(status: &hand::FingerStatus) -> FingerStatus {
    FingerStatus {
        Size: 0, // until the caller's room is known
        State: state(&status.stage),
        Realtime: status.realtime.into(),
        Rate: status.rate,
        MeasuredRate: status.measured_rate,
        WakeUpMedian: status.wake_up.median,
        WakeUp99: status.wake_up.p99,
        WakeUpMaximum: status.wake_up.maximum,
        TorqueScale: status.torque_scale,
        Cycles: count(status.losses.cycles),
        LateCycles: count(status.losses.skipped_periods),
        LostReplies: count(status.losses.lost_replies),
        DamagedFrames: count(status.losses.damaged_frames),
        Calibration: status.calibration,
        MemoryLocked: status.memory_locked.into(),
        OnCore: status.on_core.into(),
    }
}

/// FINGER_...
pub(super) fn state(stage: &Stage) -> c_int {
    match stage {
        Stage::Faulted(_) => FINGER_FAULTED,
        Stage::Limp => FINGER_LIMP,
        Stage::Calibrating | Stage::Opening => FINGER_CALIBRATING,
        Stage::Running | Stage::Closing | Stage::Closed => FINGER_RUNNING,
    }
}

fn timing(stage: c_int, times: &Distribution, losses: &Losses) -> FingerTiming {
    let ns = |microseconds: f64| (microseconds * 1e3).round() as c_ulong;
    FingerTiming {
        Size: 0, // until the caller's room is known
        Stage: stage,
        Count: count(times.count),
        Minimum: ns(times.minimum),
        Median: ns(times.median),
        P99: ns(times.p99),
        P999: ns(times.p999),
        Maximum: ns(times.maximum),
        Cycles: count(losses.cycles),
        Overruns: count(losses.overruns),
        SkippedPeriods: count(losses.skipped_periods),
        LostReplies: count(losses.lost_replies),
        LateReplies: count(losses.late_replies),
        CorruptReplies: count(losses.damaged_frames),
        DuplicateReplies: count(losses.duplicate_replies),
        ForeignFrames: count(losses.foreign_frames),
    }
}

/// Where `unsigned long` has 32 bits a count stops at its largest value.
pub(super) fn count(count: u64) -> c_ulong {
    c_ulong::try_from(count).unwrap_or(c_ulong::MAX)
}

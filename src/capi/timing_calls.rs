//! The exported functions that tell where the time of a finger's cycles goes. As in `calls.rs`, their comments are the
//! C manual.

// Named like the calls of 1990.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::default_hand;
use crate::capi::memory::{fill, size_up_to};
use crate::capi::status_calls::count;
use crate::finger::Losses;
use crate::hand::{Hand, HandError};
use crate::model::configuration::FINGERS;
use crate::realtime::{CycleStage, Distribution};
use std::ffi::{c_int, c_uint, c_ulong};

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
    /// Whole periods in which no cycle began, because the cycle before was not over or the
    /// servo thread did not run, up to the last cycle.
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
///   EPERM    forked child
///   EFAULT   Timing is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger; no such Stage
///
/// Threads: any. Never waits for a servo; some us.
///
/// Example:
///
///     struct FingerTiming Timing;
///     Timing.Size = sizeof Timing;
///     if (GetTiming(1, TIMING_WIRE, &Timing) == 0)
///         printf("%lu ns\n", Timing.P99);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetTiming(i: c_int, Stage: c_int, Timing: *mut FingerTiming) -> c_int {
    guarded("GetTiming", || {
        let least = size_up_to!(FingerTiming, CorruptReplies: c_ulong);
        let tell = |hand: &Hand| {
            // The finger's number is looked at first.
            hand.report(i)?;
            // Times first: then there are no more of them than cycles.
            let times = hand.timing(i, stage(Stage).ok_or(HandError::NoSuchStage(Stage))?)?;
            let losses = hand.losses(i)?;
            Ok(told(Stage, &times, &losses))
        };
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Timing, "Timing", least, tell) }
    })
}

/// ResetTiming - restart the counts of GetTiming
///
///     int ResetTiming(int i);
///
///   i        finger, 1 to 3; 0: all
///
/// The counts of GetStatus go on, except the wake-up times, which are those of GetTiming.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EINVAL   no such finger
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

fn stage(number: c_int) -> Option<CycleStage> {
    match number {
        TIMING_WAKE_UP => Some(CycleStage::WakeUp),
        TIMING_WRITE => Some(CycleStage::Write),
        TIMING_WIRE => Some(CycleStage::Wire),
        TIMING_READ => Some(CycleStage::Read),
        TIMING_DECODE => Some(CycleStage::Decode),
        TIMING_COMPUTE => Some(CycleStage::Compute),
        TIMING_CYCLE => Some(CycleStage::Whole),
        TIMING_AGE => Some(CycleStage::Age),
        _ => None,
    }
}

fn told(stage: c_int, times: &Distribution, losses: &Losses) -> FingerTiming {
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

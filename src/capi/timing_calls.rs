//! The exported functions for the timing of a finger's cycles. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
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

/// From the scheduled start of a cycle to the thread's first instruction.
pub const TIMING_WAKE_UP: c_int = 0;

/// Passing the commands of the port to the system.
pub const TIMING_WRITE: c_int = 1;

/// From the end of TIMING_WRITE until the reply can be read: the line in both directions, and the board.
pub const TIMING_WIRE: c_int = 2;

/// Reading the reply.
pub const TIMING_READ: c_int = 3;

/// Decoding the bytes to the finger's reply, including all checks.
pub const TIMING_DECODE: c_int = 4;

/// Computing the command and the report.
pub const TIMING_COMPUTE: c_int = 5;

/// From the scheduled start of a cycle to the end of its computation.
pub const TIMING_CYCLE: c_int = 6;

/// Age of the newest measurement when the command computed from it takes effect, by the board's clock. One period
/// if nothing is late.
pub const TIMING_AGE: c_int = 7;

/// Result of GetTiming. All times are in ns, accurate to 1 %, at most 4.29e9, and 0 if no cycle had
/// the stage. All values count from OpenHand or the last ResetTiming of the finger.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerTiming {
    /// In: sizeof (struct FingerTiming). Out: bytes written, at most that.
    pub Size: c_uint,
    /// The requested stage.
    pub Stage: c_int,
    /// Cycles that had this stage.
    pub Count: c_ulong,
    /// Shortest time of the stage.
    pub Minimum: c_ulong,
    /// Half of the cycles took no longer.
    pub Median: c_ulong,
    /// 99 of 100 cycles took no longer.
    pub P99: c_ulong,
    /// 999 of 1000 cycles took no longer.
    pub P999: c_ulong,
    /// Longest time of the stage.
    pub Maximum: c_ulong,
    /// All cycles of the finger. This and the members below do not depend on Stage.
    pub Cycles: c_ulong,
    /// Cycles that were not over when the next one was due.
    pub Overruns: c_ulong,
    /// Whole periods in which no cycle began because the previous cycle was not over or the servo thread did not run,
    /// up to the last cycle.
    pub SkippedPeriods: c_ulong,
    /// Cycles without a valid reply in time.
    pub LostReplies: c_ulong,
    /// Replies that arrived after the end of their cycle.
    pub LateReplies: c_ulong,
    /// Pieces of bad data on the finger's port: damaged frames, truncated frames and noise.
    pub CorruptReplies: c_ulong,
    /// Replies that arrived a second time.
    pub DuplicateReplies: c_ulong,
    /// Whole frames on the finger's port that no finger expected.
    pub ForeignFrames: c_ulong,
}

/// GetTiming - where the time of a finger's cycles goes
///
///     int GetTiming(int i, int Stage, struct FingerTiming *Timing);
///
///   i        finger, 1 to 3
///   Stage    TIMING_WAKE_UP to TIMING_AGE
///   Timing   result; set Timing->Size before the call
///
/// Works while the servo runs, and on a faulted finger too.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Timing is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger; no such Stage
///
/// Threads: any. Never waits for a servo. Takes a few us.
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
        let read = |hand: &Hand| {
            // Reports a wrong finger number before a wrong stage.
            hand.report(i)?;
            // Times are read before the losses, so that Count never exceeds Cycles.
            let times = hand.timing(i, stage(Stage).ok_or(HandError::NoSuchStage(Stage))?)?;
            let losses = hand.losses(i)?;
            Ok(to_c(Stage, &times, &losses))
        };
        // SAFETY: by the contract in the manual, `Timing` is null or points to as many bytes as its first member gives.
        unsafe { fill(Timing, "Timing", least, read) }
    })
}

/// ResetTiming - restart the counts of GetTiming
///
///     int ResetTiming(int i);
///
///   i        finger, 1 to 3; 0: all
///
/// The counts of GetStatus continue. The wake-up times of GetStatus restart, because they are those of
/// GetTiming.
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

/// Converts everything except `Size`. [`fill`] sets `Size`, because it depends on the room of the caller.
fn to_c(stage: c_int, times: &Distribution, losses: &Losses) -> FingerTiming {
    let ns = |microseconds: f64| (microseconds * 1e3).round() as c_ulong;
    FingerTiming {
        Size: 0,
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

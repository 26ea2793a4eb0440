//! The exported functions for the timing of a finger's cycles. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::fingers::fingers;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill_from;
use crate::capi::status_calls::count;
use crate::finger::Losses;
use crate::hand::{Hand, HandError};
use crate::realtime::{CycleStage, Distribution};
use std::ffi::{c_int, c_ulong};

/// From the scheduled start of a cycle to the thread's first instruction.
pub const SUN2XP_STAGE_WAKE_UP: c_int = 0;

/// Passing the commands of the port's fingers to the operating system.
pub const SUN2XP_STAGE_WRITE: c_int = 1;

/// From the end of SUN2XP_STAGE_WRITE until the reply can be read: the line in both directions, and the
/// board.
pub const SUN2XP_STAGE_WIRE: c_int = 2;

/// Reading the reply.
pub const SUN2XP_STAGE_READ: c_int = 3;

/// Decoding the bytes to the finger's reply, including all checks.
pub const SUN2XP_STAGE_DECODE: c_int = 4;

/// Computing the command, and the state that planners read.
pub const SUN2XP_STAGE_COMPUTE: c_int = 5;

/// From the scheduled start of a cycle to the end of its computation.
pub const SUN2XP_STAGE_CYCLE: c_int = 6;

/// Age of the newest measurement when the command computed from it takes effect, by the board's clock. It is
/// one period if nothing is late.
pub const SUN2XP_STAGE_AGE: c_int = 7;

/// Result of sun2xp_timing. All times are in ns, accurate to 1 %, at most 4.29e9, and 0 if no cycle had the
/// stage. All values count from sun2xp_open or the last sun2xp_reset_timing of the finger.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_timing {
    /// sizeof (struct sun2xp_timing), set before the call.
    pub size: usize,
    /// The requested stage.
    pub stage: c_int,
    /// Cycles that had this stage.
    pub count: c_ulong,
    /// Shortest time of the stage.
    pub minimum: c_ulong,
    /// Half of the cycles took no longer.
    pub median: c_ulong,
    /// 99 of 100 cycles took no longer.
    pub p99: c_ulong,
    /// 999 of 1000 cycles took no longer.
    pub p999: c_ulong,
    /// Longest time of the stage.
    pub maximum: c_ulong,
    /// All cycles of the finger. This member and all later ones do not depend on the stage.
    pub cycles: c_ulong,
    /// Cycles that were not over when the next one was due.
    pub overruns: c_ulong,
    /// Whole periods, up to the last cycle, in which no cycle began because the previous cycle was not over or the
    /// servo thread did not run.
    pub skipped_periods: c_ulong,
    /// Cycles without a valid reply in time.
    pub lost_replies: c_ulong,
    /// Replies that arrived after the end of their cycle.
    pub late_replies: c_ulong,
    /// Pieces of bad data on the finger's port: damaged frames, truncated frames and noise.
    pub damaged_replies: c_ulong,
    /// Replies that arrived a second time.
    pub duplicate_replies: c_ulong,
    /// Whole frames on the finger's port that no finger expected.
    pub foreign_frames: c_ulong,
}

/// sun2xp_timing - where the time of a finger's cycles goes
///
///   finger   1 to 3
///   stage    SUN2XP_STAGE_WAKE_UP to SUN2XP_STAGE_AGE
///   timing   result; set timing->size before the call
///
/// Works while the servo runs, and on a faulted finger too.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   timing is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger; no such stage
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     struct sun2xp_timing timing;
///     timing.size = sizeof timing;
///     if (sun2xp_timing(hand, 1, SUN2XP_STAGE_WIRE, &timing) == 0)
///         printf("%lu ns\n", timing.p99);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_timing(
    hand: *mut sun2xp_hand,
    finger: c_int,
    stage: c_int,
    timing: *mut sun2xp_timing,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_timing", hand, || {
        let read = |hand: &Hand| {
            // Reports a wrong finger number before a wrong stage.
            hand.report(finger)?;
            // Times are read before the losses, so that `count` does not exceed `cycles`. Just after
            // sun2xp_reset_timing it can exceed `cycles` by 1.
            let times = hand.timing(finger, cycle_stage(stage).ok_or(HandError::NoSuchStage(stage))?)?;
            let losses = hand.losses(finger)?;
            Ok(to_c(stage, &times, &losses))
        };
        // SAFETY: by the contract in the manual, `timing` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, timing, "timing", read) }
    })
}

/// sun2xp_reset_timing - restart the counts of sun2xp_timing
///
///   finger   1 to 3, or SUN2XP_ALL_FINGERS
///
/// The counts of sun2xp_status continue. The wake-up times of sun2xp_status restart, because they are those
/// of sun2xp_timing.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EINVAL   no such finger
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_reset_timing(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_reset_timing", hand, || {
        hand_table::with(hand, |hand| fingers(hand, finger).try_for_each(|finger| hand.reset_timing(finger)))
    })
}

fn cycle_stage(number: c_int) -> Option<CycleStage> {
    match number {
        SUN2XP_STAGE_WAKE_UP => Some(CycleStage::WakeUp),
        SUN2XP_STAGE_WRITE => Some(CycleStage::Write),
        SUN2XP_STAGE_WIRE => Some(CycleStage::Wire),
        SUN2XP_STAGE_READ => Some(CycleStage::Read),
        SUN2XP_STAGE_DECODE => Some(CycleStage::Decode),
        SUN2XP_STAGE_COMPUTE => Some(CycleStage::Compute),
        SUN2XP_STAGE_CYCLE => Some(CycleStage::Whole),
        SUN2XP_STAGE_AGE => Some(CycleStage::Age),
        _ => None,
    }
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(stage: c_int, times: &Distribution, losses: &Losses) -> sun2xp_timing {
    let ns = |microseconds: f64| (microseconds * 1e3).round() as c_ulong;
    sun2xp_timing {
        size: 0,
        stage,
        count: count(times.count),
        minimum: ns(times.minimum),
        median: ns(times.median),
        p99: ns(times.p99),
        p999: ns(times.p999),
        maximum: ns(times.maximum),
        cycles: count(losses.cycles),
        overruns: count(losses.overruns),
        skipped_periods: count(losses.skipped_periods),
        lost_replies: count(losses.lost_replies),
        late_replies: count(losses.late_replies),
        damaged_replies: count(losses.damaged_frames),
        duplicate_replies: count(losses.duplicate_replies),
        foreign_frames: count(losses.foreign_frames),
    }
}

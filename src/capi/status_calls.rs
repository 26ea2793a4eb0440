//! The exported function for the status of a finger's servo. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill_from;
use crate::finger::Stage;
use crate::hand;
use std::ffi::{c_int, c_ulong};

/// The fingertip is the spring that the planner has commanded.
pub const SUN2XP_STATE_RUNNING: c_int = 1;

/// The finger has stopped because of a fault. Its motors are in the configured end state. Calls for the
/// finger are refused with EIO until sun2xp_recover, or sun2xp_close and sun2xp_open.
pub const SUN2XP_STATE_FAULTED: c_int = 2;

/// The motors are off after a failed calibration. Set points have no effect. The finger becomes a spring
/// again after another calibration, or after sun2xp_close and sun2xp_open.
pub const SUN2XP_STATE_LIMP: c_int = 3;

/// sun2xp_zero or sun2xp_identify moves the finger. Set points have no effect.
pub const SUN2XP_STATE_CALIBRATING: c_int = 4;

/// sun2xp_recover or the end of a calibration brings the tendons under tension. Set points have no effect.
pub const SUN2XP_STATE_TENSIONING: c_int = 5;

/// The process exits without sun2xp_close, and the finger goes to its configured end state or is in it.
/// Only exit handlers and remaining threads see this state.
pub const SUN2XP_STATE_CLOSED: c_int = 6;

/// Result of sun2xp_status.
///
/// measured_rate is the cycles divided by the time up to this call: it falls while the servo does not run.
/// The delays count since sun2xp_open or sun2xp_reset_timing. torque_scale applies to all joints alike,
/// so the torque keeps its direction. stiffness_scale is below 1 in poses in which the tendons cannot provide
/// the whole Kx, for example near the straight pose. A joint beyond its limit can reduce it too, because the
/// spring of the limit needs a part of what the tendons provide. sun2xp_tip gives the stiffness that
/// results.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_status {
    /// sizeof (struct sun2xp_status), set before the call.
    pub size: usize,
    /// SUN2XP_STATE_RUNNING to SUN2XP_STATE_CLOSED.
    pub state: c_int,
    /// 1: all servo threads of the hand run under SCHED_FIFO.
    pub realtime: c_int,
    /// Configured servo rate, Hz.
    pub rate: f64,
    /// Measured servo rate since sun2xp_open, Hz.
    pub measured_rate: f64,
    /// Median delay of the start of a cycle, us (jitter).
    pub wake_up_median: f64,
    /// Delay that 99 of 100 cycles did not exceed, us.
    pub wake_up_p99: f64,
    /// Maximum delay, us.
    pub wake_up_maximum: f64,
    /// Fraction of the joint torque within the tension limits, 0 to 1.
    pub torque_scale: f64,
    /// Cycles since sun2xp_open.
    pub cycles: c_ulong,
    /// Whole periods in which no cycle began because the previous cycle was not over or the servo thread did not run,
    /// up to now. One late cycle may skip many.
    pub skipped_periods: c_ulong,
    /// Cycles without a valid reply in time.
    pub lost_replies: c_ulong,
    /// Pieces of bad data on the finger's port: damaged frames, truncated frames and noise. Whole frames that no finger
    /// expected count in sun2xp_timing.foreign_frames.
    pub damaged_replies: c_ulong,
    /// Progress of a calibration, 0 to 1. It is 0 if no calibration runs.
    pub calibration: f64,
    /// 1: sun2xp_open has locked the memory of every servo thread, so that no servo thread waits for a page. 0: the
    /// memory of at least one is not locked. If the planner calls munlockall later, this memory is unlocked too, and
    /// this member stays 1. sun2xp_close and sun2xp_open lock the memory again.
    pub memory_locked: c_int,
    /// 1: each servo thread with a configured core runs on it.
    pub on_core: c_int,
    /// Fraction of Kx in force in the last cycle, 0 to 1.
    pub stiffness_scale: f64,
}

/// sun2xp_status - rate, jitter and losses of a finger's servo
///
///   finger   1 to 3
///   status   result; set status->size before the call
///
/// Works on a faulted finger too. A servo thread does not run while a thread with a higher priority
/// occupies its core, or while a debugger stops it. Then state stays that of the last cycle, and cycles
/// does not grow. skipped_periods grows with every period, so a planner can compare it with an earlier
/// value to compute how old the pose of sun2xp_position is.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   status is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///
/// Threads: any.
///
/// Example:
///
///     struct sun2xp_status status;
///     status.size = sizeof status;
///     if (sun2xp_status(hand, 1, &status) == 0)
///         printf("%.1f Hz\n", status.measured_rate);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_status(hand: *mut sun2xp_hand, finger: c_int, status: *mut sun2xp_status) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_status", hand, || {
        // SAFETY: by the contract in the manual, `status` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, status, "status", |hand| hand.status(finger).map(|status| to_c(&status))) }
    })
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(status: &hand::FingerStatus) -> sun2xp_status {
    sun2xp_status {
        size: 0,
        state: state(&status.stage),
        realtime: status.realtime.into(),
        rate: status.rate,
        measured_rate: status.measured_rate,
        wake_up_median: status.wake_up.median,
        wake_up_p99: status.wake_up.p99,
        wake_up_maximum: status.wake_up.maximum,
        torque_scale: status.torque_scale,
        cycles: count(status.losses.cycles),
        skipped_periods: count(status.losses.skipped_periods),
        lost_replies: count(status.losses.lost_replies),
        damaged_replies: count(status.losses.damaged_frames),
        calibration: status.calibration,
        memory_locked: status.memory_locked.into(),
        on_core: status.on_core.into(),
        stiffness_scale: status.stiffness_scale,
    }
}

/// One of the constants SUN2XP_STATE_RUNNING to SUN2XP_STATE_CLOSED.
pub(super) fn state(stage: &Stage) -> c_int {
    match stage {
        Stage::Faulted(_) => SUN2XP_STATE_FAULTED,
        Stage::Limp => SUN2XP_STATE_LIMP,
        Stage::Calibrating => SUN2XP_STATE_CALIBRATING,
        Stage::Opening => SUN2XP_STATE_TENSIONING,
        Stage::Running => SUN2XP_STATE_RUNNING,
        Stage::Closing | Stage::Closed => SUN2XP_STATE_CLOSED,
    }
}

/// A count stops at the largest value of an `unsigned long`, which has 32 bits on some machines.
pub(super) fn count(count: u64) -> c_ulong {
    c_ulong::try_from(count).unwrap_or(c_ulong::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finger::{Fault, FaultKind, Losses};
    use crate::realtime::Distribution;

    #[test]
    fn every_stage_has_its_state() {
        let faulted = Stage::Faulted(Fault::new(FaultKind::Watchdog));
        for (stage, constant) in [
            (Stage::Opening, SUN2XP_STATE_TENSIONING),
            (Stage::Limp, SUN2XP_STATE_LIMP),
            (Stage::Calibrating, SUN2XP_STATE_CALIBRATING),
            (Stage::Running, SUN2XP_STATE_RUNNING),
            (Stage::Closing, SUN2XP_STATE_CLOSED),
            (Stage::Closed, SUN2XP_STATE_CLOSED),
            (faulted, SUN2XP_STATE_FAULTED),
        ] {
            assert_eq!(state(&stage), constant, "{stage}");
        }
    }

    #[test]
    fn damaged_frames_exclude_foreign_ones_and_skipped_periods_are_not_overruns() {
        let losses =
            Losses { overruns: 1, skipped_periods: 20, damaged_frames: 300, foreign_frames: 4000, ..Losses::default() };
        let status = hand::FingerStatus {
            stage: Stage::Running,
            realtime: true,
            memory_locked: true,
            on_core: true,
            rate: 1000.0,
            measured_rate: 1000.0,
            wake_up: Distribution::default(),
            losses,
            torque_scale: 1.0,
            stiffness_scale: 1.0,
            calibration: 0.0,
        };
        let converted = to_c(&status);
        assert_eq!((converted.skipped_periods, converted.damaged_replies), (20, 300));
    }
}

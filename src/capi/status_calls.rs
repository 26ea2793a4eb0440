//! The exported function for the status of a finger's servo. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill_from_either;
use crate::capi::status_struct::{
    SUN2XP_STATE_CALIBRATING, SUN2XP_STATE_CLOSED, SUN2XP_STATE_FAULTED, SUN2XP_STATE_LIMP, SUN2XP_STATE_RUNNING,
    SUN2XP_STATE_TENSIONING, sun2xp_status,
};
use crate::finger::Stage;
use crate::hand;
use std::ffi::{c_int, c_ulong};

/// sun2xp_status - rate, jitter and losses of a finger's servo
///
///   finger   1 to 3
///   status   result; set status->size before the call
///
/// Works on a faulted finger too. A servo thread does not run while a thread with a higher priority
/// occupies its core, or while a debugger stops it. Meanwhile the members state and cycles keep the values
/// of the last cycle, and the member skipped_periods grows by 1 in every period. A planner can therefore
/// compare skipped_periods with an earlier value to compute how old the pose of sun2xp_position is.
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
        unsafe {
            let local = |hand: &hand::Hand| hand.status(finger).map(|status| to_c(&status));
            fill_from_either(hand, status, "status", local, |remote| remote.status(finger))
        }
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

//! The exported function for the status of a finger's servo. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::memory::{fill, size_up_to};
use crate::finger::Stage;
use crate::hand;
use std::ffi::{c_int, c_uint, c_ulong};

/// The fingertip is the spring that the planner has commanded.
pub const FINGER_RUNNING: c_int = 1;

/// The finger has stopped because of a fault. Its motors are in the configured end state. Calls for the finger are
/// refused with EIO until RecoverHand, or CloseHand and OpenHand.
pub const FINGER_FAULTED: c_int = 2;

/// The motors are off after a refused calibration. Set points have no effect. The finger becomes a spring again after
/// another calibration, or after CloseHand and OpenHand.
pub const FINGER_LIMP: c_int = 3;

/// ZeroFinger or IdentifyFinger moves the finger. Set points have no effect.
pub const FINGER_CALIBRATING: c_int = 4;

/// RecoverHand or the end of a calibration brings the tendons under tension. Set points have no effect.
pub const FINGER_TENSIONING: c_int = 5;

/// The process exits without CloseHand, and the finger goes to its configured end state or is in it. Only exit
/// handlers and remaining threads see this state.
pub const FINGER_CLOSED: c_int = 6;

/// Result of GetStatus.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerStatus {
    /// In: sizeof (struct FingerStatus). Out: bytes written, at most that.
    pub Size: c_uint,
    /// FINGER_RUNNING to FINGER_CLOSED.
    pub State: c_int,
    /// 1: all servo threads of the hand run under SCHED_FIFO. 0: at least one does not.
    pub Realtime: c_int,
    /// Configured servo rate, Hz.
    pub Rate: f64,
    /// Measured servo rate since OpenHand, Hz: cycles divided by the time up to this call. It falls while the servo
    /// does not run.
    pub MeasuredRate: f64,
    /// Jitter: median delay of the start of a cycle, since OpenHand or ResetTiming, us.
    pub WakeUpMedian: f64,
    /// Delay that 99 of 100 cycles did not exceed, over the same time, us.
    pub WakeUp99: f64,
    /// Maximum delay over the same time, us.
    pub WakeUpMaximum: f64,
    /// Fraction of the joint torque that the tension limits admitted in the last cycle, 0 to 1. The direction of the
    /// torque is kept.
    pub TorqueScale: f64,
    /// Cycles since OpenHand.
    pub Cycles: c_ulong,
    /// Whole periods in which no cycle began because the previous cycle was not over or the servo thread did not run,
    /// up to now. One late cycle may skip many.
    pub SkippedPeriods: c_ulong,
    /// Cycles without a valid reply in time.
    pub LostReplies: c_ulong,
    /// Pieces of bad data on the finger's port: damaged frames, truncated frames and noise. Whole frames that no finger
    /// expected count in FingerTiming.ForeignFrames.
    pub DamagedFrames: c_ulong,
    /// Progress of a calibration, 0 to 1. It is 0 if no calibration runs.
    pub Calibration: f64,
    /// 1: OpenHand has locked the memory of every servo thread, so that no servo thread waits for a page. 0: the memory
    /// of at least one is not locked. If the planner calls munlockall later, this memory is unlocked too, and this
    /// member stays 1. CloseHand and OpenHand lock the memory again.
    pub MemoryLocked: c_int,
    /// 1: each servo thread with a configured core runs on that core. 0: at least one does not.
    pub OnCore: c_int,
    /// Fraction of Kx in force in the last cycle, 0 to 1, with every controller and law. It is below 1 in poses in
    /// which the tendons cannot provide the whole Kx, for example near the straight pose. A joint beyond its limit can
    /// reduce it too, because the spring of the limit needs a part of what the tendons provide. GetTip gives the
    /// stiffness that results.
    pub StiffnessScale: f64,
}

/// GetStatus - rate, jitter and losses of a finger's servo
///
///     int GetStatus(int i, struct FingerStatus *Status);
///
///   i        finger, 1 to 3
///   Status   result; set Status->Size before the call
///
/// Works on a faulted finger too. A servo thread does not run while a thread with a higher priority
/// occupies its core, or while a debugger stops it. Then State stays that of the last cycle, and Cycles
/// does not grow. SkippedPeriods grows with every period, so a planner can compare it with an earlier
/// value to compute how old the pose of GetPos is.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Status is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///
/// Threads: any.
///
/// Example:
///
///     struct FingerStatus Status;
///     Status.Size = sizeof Status;
///     if (GetStatus(1, &Status) == 0)
///         printf("%.1f Hz\n", Status.MeasuredRate);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetStatus(i: c_int, Status: *mut FingerStatus) -> c_int {
    guarded("GetStatus", || {
        let least = size_up_to!(FingerStatus, DamagedFrames: c_ulong);
        // SAFETY: by the contract in the manual, `Status` is null or points to as many bytes as its first member gives.
        unsafe { fill(Status, "Status", least, |hand| hand.status(i).map(|status| to_c(&status))) }
    })
}

/// Converts everything except `Size`. [`fill`] sets `Size`, because it depends on the room of the caller.
fn to_c(status: &hand::FingerStatus) -> FingerStatus {
    FingerStatus {
        Size: 0,
        State: state(&status.stage),
        Realtime: status.realtime.into(),
        Rate: status.rate,
        MeasuredRate: status.measured_rate,
        WakeUpMedian: status.wake_up.median,
        WakeUp99: status.wake_up.p99,
        WakeUpMaximum: status.wake_up.maximum,
        TorqueScale: status.torque_scale,
        Cycles: count(status.losses.cycles),
        SkippedPeriods: count(status.losses.skipped_periods),
        LostReplies: count(status.losses.lost_replies),
        DamagedFrames: count(status.losses.damaged_frames),
        Calibration: status.calibration,
        MemoryLocked: status.memory_locked.into(),
        OnCore: status.on_core.into(),
        StiffnessScale: status.stiffness_scale,
    }
}

/// One of the constants FINGER_RUNNING to FINGER_CLOSED.
pub(super) fn state(stage: &Stage) -> c_int {
    match stage {
        Stage::Faulted(_) => FINGER_FAULTED,
        Stage::Limp => FINGER_LIMP,
        Stage::Calibrating => FINGER_CALIBRATING,
        Stage::Opening => FINGER_TENSIONING,
        Stage::Running => FINGER_RUNNING,
        Stage::Closing | Stage::Closed => FINGER_CLOSED,
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
            (Stage::Opening, FINGER_TENSIONING),
            (Stage::Limp, FINGER_LIMP),
            (Stage::Calibrating, FINGER_CALIBRATING),
            (Stage::Running, FINGER_RUNNING),
            (Stage::Closing, FINGER_CLOSED),
            (Stage::Closed, FINGER_CLOSED),
            (faulted, FINGER_FAULTED),
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
        assert_eq!((converted.SkippedPeriods, converted.DamagedFrames), (20, 300));
    }
}

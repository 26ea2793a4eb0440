//! The exported function that tells how the servo of a finger is doing. As in `calls.rs`, its comments are the C
//! manual.

// Named like the calls of 1990.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::memory::{fill, size_up_to};
use crate::finger::Stage;
use crate::hand;
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

/// FingerStatus.State: ZeroFinger or IdentifyFinger moves the finger. Set points have no
/// effect.
pub const FINGER_CALIBRATING: c_int = 4;

/// FingerStatus.State: the tendons are being brought under tension, by RecoverHand or at
/// the end of a calibration. Set points have no effect.
pub const FINGER_TENSIONING: c_int = 5;

/// FingerStatus.State: the finger goes to its configured end state, or is there, because
/// the planner has called exit or returned from main without CloseHand. Only exit handlers
/// and threads that are left see it.
pub const FINGER_CLOSED: c_int = 6;

/// What GetStatus tells of a finger. Set Size = sizeof (struct FingerStatus) before the
/// call: later versions add members at the end, and a program never gets more than it
/// has room for.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerStatus {
    /// In: bytes of room, sizeof *Status. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// FINGER_RUNNING, FINGER_FAULTED, FINGER_LIMP, FINGER_CALIBRATING, FINGER_TENSIONING or
    /// FINGER_CLOSED.
    pub State: c_int,
    /// 1: every servo thread of the hand runs under SCHED_FIFO. 0: one does not, and shares
    /// its core with everybody.
    pub Realtime: c_int,
    /// Configured servo rate, Hz.
    pub Rate: f64,
    /// Measured servo rate since OpenHand, Hz. While the servo does not run, the periods that
    /// are missing up to now count too, so the rate falls.
    pub MeasuredRate: f64,
    /// How late cycles began since OpenHand or ResetTiming, microseconds: half of them no
    /// later than this. The servo's jitter.
    pub WakeUpMedian: f64,
    /// The same, microseconds: 99 of 100 cycles no later than this.
    pub WakeUp99: f64,
    /// The same, microseconds: the latest.
    pub WakeUpMaximum: f64,
    /// The part of the joint torque that the tension limits let through in the last cycle,
    /// 0 to 1. Its direction is kept.
    pub TorqueScale: f64,
    /// Cycles since OpenHand.
    pub Cycles: c_ulong,
    /// Whole periods in which no cycle began, because the cycle before was not over or the
    /// servo thread did not run, up to now. One such cycle may skip many.
    pub SkippedPeriods: c_ulong,
    /// Cycles without a valid reply in time.
    pub LostReplies: c_ulong,
    /// Pieces of bytes on the finger's port that were no frame: damaged, cut short, noise.
    /// FingerTiming.ForeignFrames counts whole frames that nobody waited for.
    pub DamagedFrames: c_ulong,
    /// How much of a calibration is done, 0 to 1. 0 if the finger is not being calibrated.
    pub Calibration: f64,
    /// 1: OpenHand has locked the memory of every servo thread, so that it never waits for a
    /// page. 0: one is not locked. If the planner calls munlockall later, this memory is
    /// unlocked too, and this member stays 1. CloseHand and OpenHand lock it again.
    pub MemoryLocked: c_int,
    /// 1: every servo thread runs on its configured core, or has none. 0: one does not.
    pub OnCore: c_int,
    /// The part of Kx that the finger was given in the last cycle, 0 to 1: less than 1 where
    /// its tendons carry no more in this pose, for example near the straight one.
    pub StiffnessScale: f64,
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
/// A servo thread does not run while a thread with a higher priority occupies its core, or
/// while a debugger holds it. Then State is that of its last cycle and Cycles stands still.
/// SkippedPeriods grows with every period, so a planner that compares it with an earlier
/// value knows how old the pose of GetPos is.
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
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Status, "Status", least, |hand| hand.status(i).map(|status| told(&status))) }
    })
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
        SkippedPeriods: count(status.losses.skipped_periods),
        LostReplies: count(status.losses.lost_replies),
        DamagedFrames: count(status.losses.damaged_frames),
        Calibration: status.calibration,
        MemoryLocked: status.memory_locked.into(),
        OnCore: status.on_core.into(),
        StiffnessScale: status.stiffness_scale,
    }
}

/// FINGER_...
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

/// Where `unsigned long` has 32 bits a count stops at its largest value.
pub(super) fn count(count: u64) -> c_ulong {
    c_ulong::try_from(count).unwrap_or(c_ulong::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finger::{Fault, FaultKind, Losses};
    use crate::realtime::Distribution;

    #[test]
    fn only_a_spring_reads_running_and_only_a_calibration_reads_calibrating() {
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
    fn foreign_frames_are_no_damaged_ones_and_periods_no_cycles() {
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
        let told = told(&status);
        assert_eq!((told.SkippedPeriods, told.DamagedFrames), (20, 300));
    }
}

//! The exported function that tells how the servo of a finger is doing. As in `calls.rs`, its comments are the C manual.

// Named like the calls of 1990.
#![allow(non_snake_case)]

use crate::capi::memory::{fill, size_up_to};
use crate::capi::refusal::guarded;
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
    /// The part of Kx that the finger was given in the last cycle, 0 to 1: less than 1 where
    /// its tendons carry no more in this pose, so near straight.
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
        StiffnessScale: status.stiffness_scale,
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

/// Where `unsigned long` has 32 bits a count stops at its largest value.
pub(super) fn count(count: u64) -> c_ulong {
    c_ulong::try_from(count).unwrap_or(c_ulong::MAX)
}

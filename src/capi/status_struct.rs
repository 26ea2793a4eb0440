//! The states of a finger, and the struct of sun2xp_status. Their doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use std::ffi::{c_int, c_ulong};

/// The fingertip is the spring that the planner has commanded.
pub const SUN2XP_STATE_RUNNING: c_int = 1;

/// The finger has stopped because of a fault. Its motors are in the configured end state. Calls that command the
/// finger or read its pose are refused with EIO until sun2xp_recover, or sun2xp_close and sun2xp_open.
pub const SUN2XP_STATE_FAULTED: c_int = 2;

/// The motors are off after a failed calibration. Set points have no effect. The finger becomes a spring
/// again after another calibration, or after sun2xp_close and sun2xp_open.
pub const SUN2XP_STATE_LIMP: c_int = 3;

/// sun2xp_zero or sun2xp_identify moves the finger. Set points have no effect.
pub const SUN2XP_STATE_CALIBRATING: c_int = 4;

/// sun2xp_open, sun2xp_recover or the end of a calibration brings the tendons under tension. Set points have no effect.
pub const SUN2XP_STATE_TENSIONING: c_int = 5;

/// The process exits without sun2xp_close, and the finger goes to its configured end state or is already there. Only
/// exit handlers and remaining threads see this state.
pub const SUN2XP_STATE_CLOSED: c_int = 6;

/// Result of sun2xp_status.
///
/// The member measured_rate is the number of cycles divided by the time from sun2xp_open to this call: the
/// rate falls while the servo does not run. The members wake_up_median, wake_up_p99 and wake_up_maximum
/// cover the cycles since sun2xp_open or the last sun2xp_reset_timing. The member torque_scale applies to
/// all joints alike, so the torque keeps its direction. The member stiffness_scale is below 1 in poses in
/// which the tendons cannot provide the whole Kx, for example near the straight pose. A joint beyond its
/// limit can also reduce stiffness_scale, because the spring that pushes the joint back needs a part of what
/// the tendons provide. sun2xp_tip gives the stiffness that results.
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
    /// Fraction of the desired joint torque that the tension limits permitted in the last cycle, 0 to 1.
    pub torque_scale: f64,
    /// Cycles since sun2xp_open.
    pub cycles: c_ulong,
    /// Whole periods, up to now, in which no cycle began because the previous cycle was not over or the servo thread
    /// did not run. One late cycle may skip many.
    pub skipped_periods: c_ulong,
    /// Cycles without a valid reply in time.
    pub lost_replies: c_ulong,
    /// Pieces of bad data on the finger's port: damaged frames, truncated frames and noise. Whole frames that no finger
    /// expected count in sun2xp_timing.foreign_frames.
    pub damaged_replies: c_ulong,
    /// Progress of a calibration, 0 to 1. It is 0 if no calibration runs.
    pub calibration: f64,
    /// 1: sun2xp_open has locked the memory of every servo thread, so that no servo thread waits for a page. If the
    /// planner calls munlockall later, this memory is unlocked too, and this member stays 1. If the hand is closed and
    /// opened again, sun2xp_open locks the memory again. 0: the memory of at least one servo thread is not locked.
    pub memory_locked: c_int,
    /// 1: each servo thread with a configured core runs on this core.
    pub on_core: c_int,
    /// Fraction of Kx that was in force in the last cycle, 0 to 1.
    pub stiffness_scale: f64,
}

//! The exported functions that calibrate a finger. As in `calls.rs`, their comments are the C manual.

// Named like the calls of 1990.
#![allow(non_snake_case)]

use crate::calibration::Task;
use crate::capi::boundary::{MEMORY_OF_CALL, delegated};
use crate::capi::default_hand;
use std::ffi::c_int;

/// ZeroFinger - find the zeros of a finger's gauges and encoders
///
///     int ZeroFinger(int i);
///
///   i        finger, 1 to 3
///
/// Lets the tendons out and reads the gauges, and finds the zero of the encoders as
/// finger.zeroing.method says. "pose": the finger stands in finger.zeroing.pose_degrees.
/// It must stand still there from the call on until it has been read: a finger that is a
/// spring for 0.3 s; a finger that is limp for some seconds, held by a jig or a hand. A
/// finger that moves, or that nothing holds, is refused. "stops": each joint is led slowly
/// against both of its stops, for which the finger needs room. "kept": the configured zero
/// stays, if the board says that its counts are still good. Where no method is configured
/// it is "stops" if the configuration says where the stops are, or if the finger is
/// simulated, and else "pose". What was found is in force at once, and is written into the
/// configuration file if OpenHand has read one: these zeros and nothing else. All other keys
/// and comments stay as they are in the file by then, so that several processes may store what
/// they find. Each waits for the others, for 30 s at most.
/// Then the finger holds the pose it is in, at its initial stiffness: while it was limp a
/// free finger has moved, by up to some tenths of a radian.
///
/// Waits until it is done: seconds, up to a minute with "stops". Meanwhile GetStatus tells
/// the part that is done (FingerStatus.Calibration), other calls go on, and set points for
/// this finger have no effect.
///
/// Returns 0, or -1 with
///   EPERM      forked child
///   ENODEV     no hand is open, or it was closed meanwhile
///   EINVAL     no such finger; the configuration file has been changed and what was found
///              does not fit it: the zeros are in force until CloseHand and not stored
///   EIO        the finger is faulted
///   EBUSY      the finger is being calibrated or recovered already
///   ECANCELED  something stood in the way (the finger moved in its pose, a tendon is slack,
///              a gauge dead, a joint meets no stop or meets it early ...). No zero was
///              changed, and HandError says what to do. The finger is limp; but one that was
///              refused before anything was done to it (it moved while it was read, or its
///              counts were not kept) is what it was before
///   ETIMEDOUT  not finished within finger.zeroing.time_limit_s: the same
///   EACCES, ENOSPC ...  the configuration file cannot be written; the zeros are in force
///              until CloseHand
///
/// Threads: any.
///
/// Example:
///
///     if (ZeroFinger(1) != 0)
///         fprintf(stderr, "%s\n", HandError());
#[unsafe(no_mangle)]
pub extern "C" fn ZeroFinger(i: c_int) -> c_int {
    delegated("ZeroFinger", MEMORY_OF_CALL, || Ok(move || default_hand::calibrate(i, Task::Zero)))
}

/// IdentifyFinger - measure gauge gains, friction and tendon stiffness of a finger
///
///     int IdentifyFinger(int i);
///
///   i        finger, 1 to 3; it must have been zeroed
///
/// Moves the joints a little to and fro where they are, leads the finger to its lower
/// stops, moves each joint to and fro, presses against the stops with up to 0.6 of the
/// largest tension, and returns to where it began. Finds the gains of the gauges, the
/// stiffness of each tendon and the friction of motors, conduits and joints. What was
/// found is in force at once and is written into the configuration file, as by
/// ZeroFinger. Takes about a minute, and the room that the joints can reach.
///
/// Returns and waits as ZeroFinger.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn IdentifyFinger(i: c_int) -> c_int {
    delegated("IdentifyFinger", MEMORY_OF_CALL, || Ok(move || default_hand::calibrate(i, Task::Identify)))
}

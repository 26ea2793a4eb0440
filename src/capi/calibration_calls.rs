//! The exported functions that calibrate a finger. Their doc comments are the C manual, as in `calls.rs`.

// The names of the header.
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
/// Slackens the tendons and reads the gauges. Then finds the zero of the encoders by
/// finger.zeroing.method:
///
///   "pose"   The finger stands in finger.zeroing.pose_degrees. It must stand still from the start of
///            the call until it has been read: 0.3 s for a finger that is a spring, some seconds for a
///            limp one, which a jig or a hand must hold. A finger that moves, or that nothing holds,
///            is refused.
///   "stops"  Each joint moves slowly against both of its stops. The finger needs room for that.
///   "kept"   The configured zero stays, if the board reports that its counts are still valid.
///
/// The default is "stops" if the finger is simulated or the configuration gives the positions of its
/// stops, otherwise "pose". At the end the finger holds its present pose at its initial stiffness. A
/// free finger may have moved by up to some tenths of a radian while it was limp.
///
/// The zeros take effect at once. If OpenHand has read a configuration file, they are written into
/// that file. All its other keys and comments stay, including those that have changed since OpenHand.
/// Several processes may store their results in one file: each waits for the others, at most 30 s.
///
/// Waits until all this is done: some seconds, or up to a minute with "stops". Meanwhile
/// FingerStatus.Calibration gives the progress, other calls work, and set points for this finger have
/// no effect.
///
/// Returns 0, or -1 with
///   EPERM      forked child
///   ENODEV     no hand is open, or it was closed meanwhile
///   EINVAL     no such finger; or the configuration file has changed, and the zeros do not fit it:
///              they are in force until CloseHand and not stored
///   EIO        the finger is faulted
///   EBUSY      the finger is being calibrated or recovered already
///   ECANCELED  the calibration failed (the finger moved in its pose, a tendon is slack, a gauge is
///              dead, a joint meets no stop or meets it too early ...). No zero has changed, and
///              HandError gives the remedy. The finger is then limp. Exception: if it moved while it
///              was read, or if its counts were not valid, the calibration had not changed anything
///              yet, and the finger is in its former state. If another thread has recovered the finger
///              from a fault during the calibration, the finger holds its pose, with its former zeros
///   ETIMEDOUT  not finished within finger.zeroing.time_limit_s; otherwise as with ECANCELED
///   EACCES, ENOSPC ...  the configuration file cannot be written; the zeros are in force until
///              CloseHand
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
/// Moves the joints back and forth around their present angles, moves each joint between its two stops,
/// presses against the lower stops with up to 0.6 of the largest tension, and returns to the start.
/// Measures the gains of the gauges, the stiffness of each tendon, its moment arms, and the friction of
/// motors, conduits, pulleys and joints. The results take effect and are stored like those of ZeroFinger.
/// Takes about 80 s, and needs free space over the whole range of the joints.
///
/// Returns and waits as ZeroFinger does.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn IdentifyFinger(i: c_int) -> c_int {
    delegated("IdentifyFinger", MEMORY_OF_CALL, || Ok(move || default_hand::calibrate(i, Task::Identify)))
}

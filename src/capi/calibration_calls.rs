//! The exported functions that calibrate a finger. Their doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use crate::calibration::Task;
use crate::capi::boundary::{MEMORY_OF_CALL, delegated};
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::long_operations;
use std::ffi::c_int;

/// sun2xp_zero - find the zeros of a finger's gauges and encoders
///
///   finger   1 to 3
///
/// Slackens the tendons and reads the gauges. Finds the zero of the encoders by finger.zeroing.method:
///
///   "pose"   The finger must be in the pose finger.zeroing.pose_degrees, and must stand still there from
///            the start of the call until its encoders have been read. For a finger that is a spring,
///            this takes 0.3 s, because its encoders are read before its tendons are slackened. For a
///            limp finger, it takes some seconds. A jig or a person must hold a limp finger. A finger
///            that moves is refused, and so is a limp finger that nothing holds.
///   "stops"  Each joint moves slowly against both of its stops. The finger needs room for that.
///   "kept"   The configured zero stays, if the board reports that its counts are still valid.
///
/// The default is "stops" if the finger is simulated or the configuration gives the positions of its stops,
/// otherwise "pose". At the end the finger holds its present pose at its initial stiffness. A free finger
/// may have moved by up to some tenths of a radian while it was limp.
///
/// The zeros take effect at once. If sun2xp_open has read a configuration file, they are written into that
/// file. All its other keys and comments stay, including those that have changed since sun2xp_open. Several
/// processes may store their results in one file: each waits for the others, at most 30 s.
///
/// Waits until all this is done: some seconds, or up to a minute with "stops". Meanwhile
/// sun2xp_status.calibration gives the progress, other calls work, and set points for this finger have no
/// effect.
///
/// Returns 0, or a negative number with
///   EPERM      forked child
///   ENODEV     no such hand, or it was closed meanwhile
///   EINVAL     no such finger; or the configuration file has changed, and the zeros do not fit it:
///              they are in force until sun2xp_close and not stored
///   EIO        the finger is faulted. If it faulted after its zeros were found, they are in force. The next
///              sun2xp_identify that succeeds for this finger stores them. If a sun2xp_zero succeeds before
///              that, its own zeros replace them and are stored
///   EBUSY      the finger is being calibrated or recovered already
///   ECANCELED  the calibration failed (the finger moved in its pose, a tendon is slack, a gauge is dead, a
///              joint meets no stop or meets it too early ...). sun2xp_error_text gives the remedy. The finger
///              is then limp and has its previous zeros, with two exceptions. (1) If the finger moved while its
///              encoders were read ("pose"), or if the counts were not valid ("kept"), the zeros stay, and the
///              finger stays a spring or limp, as it was before the call. But a path or an interpolated motion
///              (finger.motion.interpolate_ms) that it followed has ended. (2) If another thread has recovered
///              the finger from a fault during the calibration, the finger holds its pose. If its new zeros
///              had been found before the fault, they are in force. Otherwise its zeros have not changed
///   ETIMEDOUT  not finished within finger.zeroing.time_limit_s. The effects are those of ECANCELED
///   EACCES, ENOSPC, EBUSY ...  the configuration file cannot be written, or another process has kept it
///              locked for 30 s. The zeros are in force until sun2xp_close. If the results of a later
///              sun2xp_identify of this finger can be stored, these zeros are stored with them. A later
///              sun2xp_zero that succeeds replaces them
///
/// Threads: any.
///
/// Example:
///
///     if (sun2xp_zero(hand, 1) != 0)
///         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_zero(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_zero", hand, MEMORY_OF_CALL, || Ok(move || long_operations::calibrate(hand, finger, Task::Zero)))
}

/// sun2xp_identify - measure gauge gains, friction, tendon stiffness and rotor inertia of a finger
///
///   finger   1 to 3; it must have been zeroed
///
/// Moves the joints back and forth around their present angles, moves each joint between its two stops,
/// presses against the lower stops with up to 0.6 of finger.tendon.maximum, and returns to the start.
/// Measures the gains of the gauges, the stiffness of each tendon, its moment arms, the friction of motors,
/// conduits, pulleys and joints, and the inertia of the rotors. The results take effect and are stored like
/// those of sun2xp_zero.
/// Takes about 85 s, and needs free space over the whole range of the joints.
///
/// Returns and waits as sun2xp_zero does.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_identify(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_identify", hand, MEMORY_OF_CALL, || {
        Ok(move || long_operations::calibrate(hand, finger, Task::Identify))
    })
}

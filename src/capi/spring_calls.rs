//! The exported functions for springs in joint angles and for joint torques. Their doc comments are the C manual, as in
//! `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::{load, load_rows};
use std::ffi::c_int;

/// sun2xp_send_joint_stiffness - turn the joints of a finger into springs
///
///   finger      1 to 3
///   stiffness   stiffness[9] or &stiffness[0][0] of stiffness[3][3], row by row: entry [i][j] is the
///               torque of joint i for a deflection of joint j from its set point, N cm/rad
///
/// The torque of the joints is stiffness (d - p), with the desired angles d and the measured angles p of
/// joints 0, 1 and 2. The stiffness takes effect like Kx, without a jump in torque: 95 % of the change has
/// taken effect after 50 ms. It replaces the Kx or contact that was sent last. A later sun2xp_send_stiffness
/// or sun2xp_send_contact replaces it, and so does a Kx of sun2xp_send_group or sun2xp_send_path. The torque
/// of sun2xp_send_joint_torque stays. The stiffness must be symmetric and must have no negative eigenvalue,
/// as for sun2xp_send_stiffness. It may be zero.
///
/// The largest eigenvalue may be at most the bound of Kx times the square of the length of the last
/// link: by default 96 N cm/rad if the servo rate (hand.rate) is 1000 Hz or more, and 80 N cm/rad
/// otherwise. This is the stiffness that a Kx with all eigenvalues at its bound gives joint 2 in every pose.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   stiffness is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an entry is NaN or infinite
///   EDOM     stiffness is not symmetric, or has a negative eigenvalue
///   ERANGE   stiffness is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///   ERANGE   stiffness is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio
///            instead)
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     double stiffness[3][3] = {{80, 0, 0}, {0, 80, 0}, {0, 0, 50}};
///     sun2xp_send_joint_stiffness(hand, 1, &stiffness[0][0]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_joint_stiffness(
    hand: *mut sun2xp_hand,
    finger: c_int,
    stiffness: *const f64,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_joint_stiffness", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let rows = unsafe { load_rows(stiffness, "stiffness") }?;
        hand_table::command(hand, |hand| hand.send_joint_stiffness(finger, rows))
    })
}

/// sun2xp_send_joint_torque - add a constant torque to the joints of a finger
///
///   finger   1 to 3
///   torque   torque[3]: torque of joints 0, 1, 2, N cm; positive torques increase the angles
///
/// The torque acts in addition to the spring of Kx, of a contact or of sun2xp_send_joint_stiffness, until
/// the next sun2xp_send_joint_torque replaces it; zero ends it. The torque takes effect like Kx, without a
/// jump. If the stiffness is zero, the finger is controlled by torque alone: a free finger then moves to its
/// joint limits, at a speed that only damping and friction limit. The torque also ends at a fault, at a
/// calibration, when a set point expires, and when a reflex holds, retracts or softens the finger.
///
/// A torque is refused if it needs more tension than a tendon and its motor permit. If the spring, the
/// compensation of gravity and the torque together need more, the servo scales their sum down.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   torque is null
///   ENODEV   no such hand
///   EINVAL   no such finger; a torque is NaN or infinite
///   ERANGE   the tendons cannot produce this torque (hand.out_of_range = "clamp" scales it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 1 us.
///
/// Example:
///
///     double torque[3] = {0, 3, 1.5};
///     sun2xp_send_joint_torque(hand, 1, torque);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_joint_torque(hand: *mut sun2xp_hand, finger: c_int, torque: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_joint_torque", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let torque = unsafe { load::<f64, 3>(torque, "torque") }?;
        hand_table::command(hand, |hand| hand.send_joint_torque(finger, torque))
    })
}

//! The exported functions for joint angles and stiffness. Their doc comments are the C manual, as in `calls.rs`.

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::{load, load_rows, store};
use crate::hand::FingerCommand;
use std::ffi::c_int;

/// sun2xp_send_position - send desired joint angles to a finger
///
///   finger     1 to 3
///   position   position[3]: desired angles of joints 0, 1, 2, rad
///
/// All three angles take effect together. From the next cycle on, the anchor of the fingertip's spring (the
/// point toward which the spring pulls) moves to the angles in position, along a straight line in joint
/// angles and at a bounded speed. The stiffness Kx is the one sent last (sun2xp_send_stiffness). When the
/// anchor has arrived, the force of the fingertip is Kx (tip - p) at any distance: tip is the place of the
/// fingertip at the angles in position, and p is the present place of the fingertip. With
/// finger.controller.law = "report" the finger follows the law of the report, which holds for small
/// distances. The call does not wait until the finger arrives. sun2xp_limits reads the joint limits.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   position is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an angle is NaN or infinite
///   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
///
/// Example:
///
///     double position[3] = {0.0, 0.5, 0.8};
///     sun2xp_send_position(hand, 1, position);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_position(hand: *mut sun2xp_hand, finger: c_int, position: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_position", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let joints = unsafe { load::<f64, 3>(position, "position") }?;
        let command = || FingerCommand::new(finger).joints(joints);
        hand_table::send(hand, |hand| hand.send_position(finger, joints), command)
    })
}

/// sun2xp_send_stiffness - set the stiffness of a fingertip
///
///   finger      1 to 3
///   stiffness   stiffness[9] or &stiffness[0][0] of stiffness[3][3], row by row: entry [row][column] is
///               the force along axis row (x, y, z of the finger's frame) for a displacement of 1 cm
///               along axis column, N/cm
///
/// Sets Kx, the stiffness of the fingertip. All entries begin to change in the next cycle, without a jump in
/// torque: 95 % of the change has taken effect after 50 ms. The matrix must be symmetric; two mirrored entries
/// that differ by up to 1e-3 of the largest entry are averaged. No eigenvalue may be below -1e-3 times the
/// largest one. The matrix may be singular or zero: along directions without stiffness the finger is limp but
/// still damped. The largest eigenvalue may be at most the configured bound, by default 6 N/cm if the servo
/// rate (hand.rate) is 1000 Hz or more, and 5 N/cm otherwise.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   stiffness is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an entry is NaN or infinite
///   EDOM     the matrix is not symmetric, or has a negative eigenvalue
///   ERANGE   the matrix is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///   ERANGE   the matrix is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio)
///
/// Threads: any. Never waits for a servo. Takes about 1 us.
///
/// Example, softer along z:
///
///     double stiffness[9] = {3, 0, 0, 0, 3, 0, 0, 0, 1};
///     sun2xp_send_stiffness(hand, 1, stiffness);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_stiffness(hand: *mut sun2xp_hand, finger: c_int, stiffness: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_stiffness", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let rows = unsafe { load_rows(stiffness, "stiffness") }?;
        let command = || FingerCommand::new(finger).stiffness(rows);
        hand_table::send(hand, |hand| hand.send_stiffness(finger, rows), command)
    })
}

/// sun2xp_position - read the joint angles of a finger
///
///   finger     1 to 3
///   position   result: position[3]: measured angles of joints 0, 1, 2, rad, from the last cycle
///
/// While the servo thread does not run, the angles stay those of its last cycle, and the member
/// skipped_periods of sun2xp_status grows.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   position is null
///   ENODEV   no such hand
///   EINVAL   no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
///
/// Example:
///
///     double position[3];
///     if (sun2xp_position(hand, 2, position) == 0)
///         printf("%g %g %g\n", position[0], position[1], position[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_position(hand: *mut sun2xp_hand, finger: c_int, position: *mut f64) -> c_int {
    let hand = Handle::of(hand);
    // SAFETY: by the contract in the manual, the pointer is null or points to an array of three angles.
    guarded("sun2xp_position", hand, || unsafe {
        store(position, "position", || {
            hand_table::with_either(hand, |hand| hand.position(finger), |remote| remote.position(finger))
        })
    })
}

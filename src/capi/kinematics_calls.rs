//! The exported functions for the kinematics of a finger and for gravity. Their doc comments are the C manual, as in
//! `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::{load, non_null};
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::sized_struct::fill_from;
use crate::hand::{self, Hand, HandError};
use std::ffi::c_int;

/// Result of sun2xp_joint_torques.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_joint_torques {
    /// sizeof (struct sun2xp_joint_torques), set before the call.
    pub size: usize,
    /// Torques from the measured tensions: joints 0, 1, 2, N cm.
    pub measured: [f64; 3],
    /// Torques that the servo commands, N cm, within the tension limits.
    pub commanded: [f64; 3],
}

/// Result of sun2xp_palm_pose. Positions and axes are in the palm's frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_palm_pose {
    /// sizeof (struct sun2xp_palm_pose), set before the call.
    pub size: usize,
    /// Origin of the finger's frame: x, y, z, cm.
    pub base: [f64; 3],
    /// Matrix, row by row. Its columns are the axes of the finger's frame.
    pub rotation: [[f64; 3]; 3],
    /// Position of the tip, from the measured joint angles: x, y, z, cm.
    pub tip: [f64; 3],
    /// Axes of the last link as columns; z points to the tip.
    pub tip_rotation: [[f64; 3]; 3],
}

/// sun2xp_jacobian - compute the Jacobian of a fingertip
///
///   finger     1 to 3
///   position   position[3]: angles of joints 0, 1, 2, rad. Null: the measured angles
///   jacobian   result: jacobian[9], row by row: entry [row][column] is the motion of the tip
///              along axis row (x, y, z of the finger's frame) when joint column turns, cm/rad (eq. 8 of the report)
///
/// A force f on the tip, N, exerts this torque on joint k, N cm: entry [0][k] times f[0], plus entry [1][k]
/// times f[1], plus entry [2][k] times f[2].
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   jacobian is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an angle is NaN or infinite
///   EIO      position is null and the finger is faulted
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double jacobian[3][3];
///     if (sun2xp_jacobian(hand, 1, NULL, &jacobian[0][0]) == 0)
///         printf("%g cm/rad\n", jacobian[0][0]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_jacobian(
    hand: *mut sun2xp_hand,
    finger: c_int,
    position: *const f64,
    jacobian: *mut f64,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_jacobian", hand, || {
        non_null(jacobian, "jacobian", Wanted::Array(9))?;
        // SAFETY: by the contract in the manual, `position` is null or points to the array that the manual describes.
        let joints = if position.is_null() { None } else { Some(unsafe { load::<f64, 3>(position, "position") }?) };
        let computed = hand_table::with(hand, |hand| hand.jacobian(finger, joints))?;
        // SAFETY: `jacobian` is not null, as checked above, and by the contract in the manual it has room for nine
        // entries.
        unsafe { jacobian.cast::<[[f64; 3]; 3]>().write_unaligned(computed) };
        Ok(())
    })
}

/// sun2xp_forward_kinematics - compute where a tip is at given joint angles
///
///   finger     1 to 3
///   position   position[3]: angles of joints 0, 1, 2, rad; they may be outside the joint limits
///   tip        result: tip[3]: x, y, z of the tip in the finger's frame, cm
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   position or tip is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an angle is NaN or infinite
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double position[3] = {0.0, 0.5, 0.8}, tip[3];
///     sun2xp_forward_kinematics(hand, 1, position, tip);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_forward_kinematics(
    hand: *mut sun2xp_hand,
    finger: c_int,
    position: *const f64,
    tip: *mut f64,
) -> c_int {
    let hand = Handle::of(hand);
    // SAFETY: by the contract in the manual, the pointers are null or point to the arrays of their descriptions.
    guarded("sun2xp_forward_kinematics", hand, || unsafe {
        convert(hand, (position, "position"), (tip, "tip"), |hand, joints| hand.tip_at(finger, joints))
    })
}

/// sun2xp_inverse_kinematics - compute the joint angles at which a tip is at a position
///
///   finger     1 to 3
///   tip        tip[3]: x, y, z of the tip in the finger's frame, cm
///   position   result: position[3]: angles of joints 0, 1, 2, rad
///
/// If several joint solutions are within the joint limits, the result is the one nearest to the present
/// pose, as with sun2xp_send_tip.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   tip or position is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an entry is NaN or infinite
///   ERANGE   tip is too far, too near, or outside the joint limits
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double tip[3] = {0.0, -6.0, 8.0}, position[3];
///     if (sun2xp_inverse_kinematics(hand, 1, tip, position) == 0)
///         printf("%g %g %g\n", position[0], position[1], position[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_inverse_kinematics(
    hand: *mut sun2xp_hand,
    finger: c_int,
    tip: *const f64,
    position: *mut f64,
) -> c_int {
    let hand = Handle::of(hand);
    // SAFETY: by the contract in the manual, the pointers are null or point to the arrays of their descriptions.
    guarded("sun2xp_inverse_kinematics", hand, || unsafe {
        convert(hand, (tip, "tip"), (position, "position"), |hand, tip| hand.joints_at(finger, tip))
    })
}

/// sun2xp_joint_torques - read the joint torques of a finger
///
///   finger    1 to 3
///   torques   result, from the last cycle of the servo; set torques->size before the call
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   torques is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_joint_torques(
    hand: *mut sun2xp_hand,
    finger: c_int,
    torques: *mut sun2xp_joint_torques,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_joint_torques", hand, || {
        let read = |hand: &Hand| {
            let hand::JointTorques { measured, commanded, .. } = hand.joint_torques(finger)?;
            Ok(sun2xp_joint_torques { size: 0, measured, commanded })
        };
        // SAFETY: by the contract in the manual, `torques` is null or points to as many bytes as its first member
        // gives.
        unsafe { fill_from(hand, torques, "torques", read) }
    })
}

/// sun2xp_palm_pose - read where a finger and its tip are in the palm
///
///   finger   1 to 3
///   pose     result, from the last cycle of the servo; set pose->size before the call
///
/// The members base and rotation follow from finger.base and finger.turn_degrees of the configuration. By
/// default two fingers are side by side, and the thumb is opposite to them.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   pose is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_palm_pose(hand: *mut sun2xp_hand, finger: c_int, pose: *mut sun2xp_palm_pose) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_palm_pose", hand, || {
        let read = |hand: &Hand| {
            let hand::PalmPose { base, rotation, tip, tip_rotation, .. } = hand.palm_pose(finger)?;
            Ok(sun2xp_palm_pose { size: 0, base, rotation, tip, tip_rotation })
        };
        // SAFETY: by the contract in the manual, `pose` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, pose, "pose", read) }
    })
}

/// sun2xp_set_gravity - set gravity in the palm's frame, for a hand on a moving arm
///
///   gravity   gravity[3]: gravity along x, y, z of the palm's frame, m/s^2
///
/// Replaces hand.gravity until sun2xp_close. Every finger that compensates gravity compensates the new one
/// within a cycle (finger.controller.gravity_compensation, default true). If gravity changes by more than
/// 2 m/s^2 in a millisecond, this takes several cycles, so that the torque does not jump. The new gravity
/// also acts on simulated fingers and on a simulated object. Gravity is an input of the servos, as a set
/// point is, so a planner can send it in every cycle.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   gravity is null
///   ENODEV   no such hand
///   EINVAL   an entry is NaN, infinite or beyond 100 m/s^2
///   EIO      a finger is faulted; the other fingers have the new gravity, and this finger takes it when
///            it recovers
///
/// Threads: any. Never waits for a servo. Takes a few us; a simulated finger may keep the call waiting while
/// it computes.
///
/// Example, a palm whose x axis points down:
///
///     double gravity[3] = {9.81, 0, 0};
///     sun2xp_set_gravity(hand, gravity);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_set_gravity(hand: *mut sun2xp_hand, gravity: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_set_gravity", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let gravity = unsafe { load::<f64, 3>(gravity, "gravity") }?;
        hand_table::command(hand, |hand| hand.set_gravity(gravity))
    })
}

/// Converts an array of three numbers to another such array. Each pointer comes with the name of its argument in the
/// exported call.
///
/// # Safety
/// Each pointer is null or points to three numbers.
unsafe fn convert(
    hand: Handle,
    (from, from_name): (*const f64, &'static str),
    (to, to_name): (*mut f64, &'static str),
    convert: impl FnOnce(&Hand, [f64; 3]) -> Result<[f64; 3], HandError>,
) -> Result<(), Refusal> {
    // SAFETY: by the contract of this function.
    let from = unsafe { load::<f64, 3>(from, from_name) }?;
    non_null(to, to_name, Wanted::Array(3))?;
    let converted = hand_table::with(hand, |hand| convert(hand, from))?;
    // SAFETY: `to` is not null, as checked above, and by the contract of this function it has room for three numbers.
    unsafe { to.cast::<[f64; 3]>().write_unaligned(converted) };
    Ok(())
}

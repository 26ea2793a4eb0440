//! The exported functions for the kinematics of a finger and for gravity. Their doc comments are the C manual, as in
//! `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded};
use crate::capi::default_hand;
use crate::capi::memory::{fill, load, non_null, size_up_to};
use crate::capi::refusal::{Refusal, Wanted};
use crate::hand::{self, Hand, HandError};
use std::ffi::{c_int, c_uint};

/// Result of GetJointTorques.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct JointTorques {
    /// In: sizeof (struct JointTorques). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Torques of joints 0, 1, 2 from the measured tensions, N cm. They include friction, weight and inertia.
    pub Measured: [f64; 3],
    /// Torques that the servo commands, N cm, within the tension limits.
    pub Commanded: [f64; 3],
}

/// Result of GetPalmPose. Positions and axes are in the palm's frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PalmPose {
    /// In: sizeof (struct PalmPose). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Origin of the finger's frame: x, y, z, cm.
    pub Base: [f64; 3],
    /// Axes of the finger's frame as columns, row by row. It turns a vector of the finger's frame into one of the
    /// palm's.
    pub Rotation: [[f64; 3]; 3],
    /// Position of the tip, from the measured joint angles: x, y, z, cm.
    pub Tip: [f64; 3],
    /// Axes of the last link as columns, row by row. Its z axis points from joint 2 to the tip.
    pub TipRotation: [[f64; 3]; 3],
}

/// GetJacobian - compute the Jacobian of a fingertip
///
///     int GetJacobian(int i, const double *Pos, double *J);
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: angles of joints 0, 1, 2, rad; always double. Null: the measured angles
///   J     result: J[3][3] or J[9], row by row; always double. J[row][column] is the motion of the tip
///         along axis row (x, y, z of the finger's frame) for joint column, cm/rad (eq. 8)
///
/// A force f on the tip acts on joint k as the sum over the axes of J[axis][k] f[axis], N cm.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   J is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an angle is NaN or infinite
///   EIO      Pos is null and the finger is faulted
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double J[3][3];
///     if (GetJacobian(1, NULL, &J[0][0]) == 0)
///         printf("%g cm/rad\n", J[0][0]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetJacobian(i: c_int, Pos: *const f64, J: *mut f64) -> c_int {
    guarded("GetJacobian", || {
        non_null(J, "J", Wanted::Array(9))?;
        // SAFETY: by the contract in the manual, `Pos` is null or points to the array of the synopsis.
        let joints = if Pos.is_null() { None } else { Some(unsafe { load::<f64, 3>(Pos, "Pos") }?) };
        let jacobian = default_hand::with(|hand| hand.jacobian(i, joints))?;
        // SAFETY: `J` is not null, as checked above, and by the contract in the manual it has room for nine entries.
        unsafe { J.cast::<[[f64; 3]; 3]>().write_unaligned(jacobian) };
        Ok(())
    })
}

/// FindTip - compute where a tip is at given joint angles
///
///     int FindTip(int i, const double *Pos, double *Tip);
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: angles of joints 0, 1, 2, rad; they may be outside the joint limits. Always double
///   Tip   result: Tip[3]: x, y, z of the tip in the finger's frame, cm. Always double
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Pos or Tip is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an angle is NaN or infinite
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double Pos[3] = {0.0, 0.5, 0.8}, Tip[3];
///     FindTip(1, Pos, Tip);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn FindTip(i: c_int, Pos: *const f64, Tip: *mut f64) -> c_int {
    // SAFETY: by the contract in the manual, the pointers are null or point to the arrays of the synopsis.
    guarded("FindTip", || unsafe { convert((Pos, "Pos"), (Tip, "Tip"), |hand, joints| hand.tip_at(i, joints)) })
}

/// FindPos - compute the joint angles at which a tip is at a position
///
///     int FindPos(int i, const double *Tip, double *Pos);
///
///   i     finger, 1 to 3
///   Tip   Tip[3]: x, y, z of the tip in the finger's frame, cm. Always double
///   Pos   result: Pos[3]: angles of joints 0, 1, 2, rad. Always double
///
/// If several joint solutions are within the joint limits, the result is the one nearest to the
/// present pose, as with SendTip.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Tip or Pos is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   ERANGE   Tip is too far, too near, or outside the joint limits
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     double Tip[3] = {0.0, -6.0, 8.0}, Pos[3];
///     if (FindPos(1, Tip, Pos) == 0)
///         printf("%g %g %g\n", Pos[0], Pos[1], Pos[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn FindPos(i: c_int, Tip: *const f64, Pos: *mut f64) -> c_int {
    // SAFETY: by the contract in the manual, the pointers are null or point to the arrays of the synopsis.
    guarded("FindPos", || unsafe { convert((Tip, "Tip"), (Pos, "Pos"), |hand, tip| hand.joints_at(i, tip)) })
}

/// GetJointTorques - read the joint torques of a finger
///
///     int GetJointTorques(int i, struct JointTorques *Torques);
///
///   i         finger, 1 to 3
///   Torques   result, from the last cycle of the servo; set Torques->Size before the call
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Torques is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetJointTorques(i: c_int, Torques: *mut JointTorques) -> c_int {
    guarded("GetJointTorques", || {
        let least = size_up_to!(JointTorques, Commanded: [f64; 3]);
        let read = |hand: &Hand| {
            let hand::JointTorques { measured, commanded, .. } = hand.joint_torques(i)?;
            Ok(JointTorques { Size: 0, Measured: measured, Commanded: commanded })
        };
        // SAFETY: by the contract in the manual, `Torques` is null or points to as many bytes as its Size gives.
        unsafe { fill(Torques, "Torques", least, read) }
    })
}

/// GetPalmPose - read where a finger and its tip are in the palm
///
///     int GetPalmPose(int i, struct PalmPose *Pose);
///
///   i      finger, 1 to 3
///   Pose   result, from the last cycle of the servo; set Pose->Size before the call
///
/// Base and Rotation follow from the configuration, finger.base and finger.turn_degrees. By default
/// two fingers are side by side, and the thumb is opposite to them.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Pose is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPalmPose(i: c_int, Pose: *mut PalmPose) -> c_int {
    guarded("GetPalmPose", || {
        let least = size_up_to!(PalmPose, TipRotation: [[f64; 3]; 3]);
        let read = |hand: &Hand| {
            let hand::PalmPose { base, rotation, tip, tip_rotation, .. } = hand.palm_pose(i)?;
            Ok(PalmPose { Size: 0, Base: base, Rotation: rotation, Tip: tip, TipRotation: tip_rotation })
        };
        // SAFETY: by the contract in the manual, `Pose` is null or points to as many bytes as its Size gives.
        unsafe { fill(Pose, "Pose", least, read) }
    })
}

/// SetGravity - set gravity in the palm's frame, for a hand on a moving arm
///
///     int SetGravity(const double *Gravity);
///
///   Gravity   Gravity[3]: gravity along x, y, z of the palm's frame, m/s^2. Always double
///
/// Replaces hand.gravity until CloseHand. Every finger compensates the new gravity within a cycle and
/// without a jump in torque. It also acts on simulated fingers and on a simulated object. The monitors
/// begin again with every change, so a planner should not change gravity more often than it needs.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Gravity is null
///   ENODEV   no hand is open
///   EINVAL   an entry is NaN, infinite or beyond 100 m/s^2
///   EIO      a finger is faulted; the other fingers have the new gravity, and this finger needs another
///            call after RecoverHand
///
/// Threads: any. Never waits for a servo. Takes some hundred us, and allocates memory.
///
/// Example, a palm whose x axis points down:
///
///     double Gravity[3] = {9.81, 0, 0};
///     SetGravity(Gravity);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SetGravity(Gravity: *const f64) -> c_int {
    delegated("SetGravity", MEMORY_OF_CALL, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let gravity = unsafe { load::<f64, 3>(Gravity, "Gravity") }?;
        Ok(move || default_hand::command(|hand| hand.set_gravity(gravity)))
    })
}

/// Converts an array of three numbers to another. The arguments are the pointers with their names.
///
/// # Safety
/// Both pointers are null or point to three numbers.
unsafe fn convert(
    (from, from_name): (*const f64, &'static str),
    (to, to_name): (*mut f64, &'static str),
    convert: impl FnOnce(&Hand, [f64; 3]) -> Result<[f64; 3], HandError>,
) -> Result<(), Refusal> {
    // SAFETY: by the contract of this function.
    let from = unsafe { load::<f64, 3>(from, from_name) }?;
    non_null(to, to_name, Wanted::Array(3))?;
    let converted = default_hand::with(|hand| convert(hand, from))?;
    // SAFETY: `to` is not null, as checked above, and by the contract of this function it has room for three numbers.
    unsafe { to.cast::<[f64; 3]>().write_unaligned(converted) };
    Ok(())
}

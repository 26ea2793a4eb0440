//! The exported functions for the fingertip. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::fingertip_struct::sun2xp_tip;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::{load, non_null};
use crate::capi::refusal::Wanted;
use crate::capi::sized_struct::fill_from_either;
use crate::hand::{FingerCommand, Hand, HandError, SetPointError};
use crate::model::{Contact, ContactError};
use nalgebra::{Matrix3, Matrix4, Vector3};
use std::ffi::c_int;

/// sun2xp_send_tip - send a desired fingertip position to a finger
///
///   finger   1 to 3
///   tip      tip[3]: desired x, y, z of the tip in the finger's frame (chapter 3), cm
///
/// From the next cycle on, the anchor of the fingertip's spring moves to tip, along a straight line in joint
/// angles and at a bounded speed. The stiffness Kx is the one sent last (sun2xp_send_stiffness). When the
/// anchor is at tip and p is the position of the fingertip, the force is Kx (tip - p) at any distance,
/// whatever the configured finger.controller.law. If several joint solutions are within the joint limits, the
/// call takes the one nearest to the present pose.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   tip is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an entry is NaN or infinite
///   ERANGE   tip is too far, too near, or outside the joint limits; it is never clamped
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes less than 1 us.
///
/// Example:
///
///     double tip[3] = {0.0, -6.0, 8.0};
///     sun2xp_send_tip(hand, 1, tip);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_tip(hand: *mut sun2xp_hand, finger: c_int, tip: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_tip", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let tip = unsafe { load::<f64, 3>(tip, "tip") }?;
        let command = || FingerCommand::new(finger).tip(tip);
        hand_table::send(hand, |hand| hand.send_tip(finger, tip), command)
    })
}

/// sun2xp_tip - read position, force and stiffness of a fingertip, and the tendon tensions
///
///   finger   1 to 3
///   tip      result, from the last cycle of the servo; set tip->size before the call
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   tip is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 1 us.
///
/// Example:
///
///     struct sun2xp_tip tip;
///     tip.size = sizeof tip;
///     if (sun2xp_tip(hand, 1, &tip) == 0)
///         printf("%g N along z\n", tip.force[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_tip(hand: *mut sun2xp_hand, finger: c_int, tip: *mut sun2xp_tip) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_tip", hand, || {
        // SAFETY: by the contract in the manual, `tip` is null or points to as many bytes as its first member gives.
        unsafe {
            let local = |hand: &Hand| hand.fingertip(finger).map(|tip| tip.into());
            fill_from_either(hand, tip, "tip", local, |remote| remote.tip(finger))
        }
    })
}

/// sun2xp_send_contact - give a fingertip the stiffness of a contact type
///
///   finger       1 to 3
///   dimensions   number of dimensions of the contact (section 4.2 of the report):
///                1   frictionless point: a force along the normal
///                3   hard finger with friction: three forces; the same as sun2xp_send_stiffness
///                4   soft finger: three forces and a moment about the normal
///   stiffness    a matrix of dimensions x dimensions, row by row. 1: N/cm along the normal. 3 and 4: rows
///                and columns 0 to 2 are x, y, z of the finger's frame, N/cm. 4: row 3 and column 3 belong
///                to the rotation about the normal: the entry on the diagonal is in N cm/rad, the other
///                entries of this row and column are in N/rad
///   normal       normal[3]: the contact normal in the finger's frame, of any length but zero. Not used
///                for 3 dimensions, and may be null there
///
/// The contact takes effect as a whole, without a jump in torque. It replaces the stiffness sent last,
/// and a later sun2xp_send_stiffness replaces it. In directions in which the contact exerts no force, the
/// finger is limp but still damped. The matrix must be symmetric and must have no negative eigenvalue, as for
/// sun2xp_send_stiffness. For the comparison with the bound, a rotational stiffness of k N cm/rad is
/// converted to k / (l2 l2) N/cm, where l2 is the length of the last link.
///
/// A soft finger is not a spring in four independent directions, because three joints cannot turn the tip
/// without moving it. If the tip moves by a vector v, cm, it turns about normal by the dot product c . v,
/// rad. The vector c depends on the pose. A rotational stiffness of k N cm/rad therefore stiffens the tip
/// along c, by k |c| |c| N/cm, and the tip exerts no moment that is independent of its force. In the pose
/// 0, 0.5, 0.8 rad the example below gives 3.24, 3 and 3 N/cm along x, y and z. With normal along x it
/// gives 3, 3.56 and 4.87 N/cm, and -1.02 N/cm between y and z. sun2xp_tip reads the stiffness that
/// results.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   stiffness is null; normal is null for 1 or 4 dimensions
///   ENODEV   no such hand
///   EINVAL   no such finger; dimensions is not 1, 3 or 4; an entry is NaN or infinite
///   EDOM     stiffness is not symmetric, or has a negative eigenvalue; normal is zero
///   ERANGE   stiffness is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///   ERANGE   stiffness is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio
///            instead)
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, a soft finger:
///
///     double stiffness[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
///     double normal[3] = {0, -1, 0};
///     sun2xp_send_contact(hand, 1, 4, &stiffness[0][0], normal);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_contact(
    hand: *mut sun2xp_hand,
    finger: c_int,
    dimensions: c_int,
    stiffness: *const f64,
    normal: *const f64,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_contact", hand, || {
        // `dimensions`, which determines the size of the matrix, is checked later. So this error names no size.
        non_null(stiffness, "stiffness", Wanted::Matrix)?;
        // SAFETY: here and below, by the contract in the manual, the pointer is null or points to the array that the
        // manual describes for this value of `dimensions`.
        let normal = || unsafe { load::<f64, 3>(normal, "normal") }.map(Vector3::from);
        let contact = match dimensions {
            1 => Contact::frictionless_point(unsafe { load::<f64, 1>(stiffness, "stiffness") }?[0], normal()?),
            3 => Contact::hard_finger(Matrix3::from_row_slice(&unsafe { load::<f64, 9>(stiffness, "stiffness") }?)),
            4 => Contact::soft_finger(
                Matrix4::from_row_slice(&unsafe { load::<f64, 16>(stiffness, "stiffness") }?),
                normal()?,
            ),
            _ => {
                return hand_table::command(hand, |hand| {
                    hand.report(finger).and(Err(SetPointError::NoSuchContact(dimensions).into()))
                });
            }
        };
        hand_table::command(hand, |hand| -> Result<(), HandError> {
            // Reports a wrong finger number before an unusable contact.
            hand.report(finger)?;
            let number = finger.try_into()?;
            let refused = |source: ContactError| SetPointError::Contact { finger: number, source };
            hand.send_contact(finger, contact.map_err(refused)?)
        })
    })
}

/// sun2xp_send_damping - set the damping of a fingertip
///
///   finger   1 to 3
///   ratio    damping relative to the damping that the controller chooses for the stiffness; 1 after sun2xp_open
///
/// The ratio changes without a jump in torque and stays until another ratio is sent. It becomes 1 again when
/// the finger becomes a spring after a fault or a calibration, when a set point expires, and when a reflex
/// with the reaction SUN2XP_THEN_SOFTEN fires. A reflex with SUN2XP_THEN_DAMP replaces the ratio. A finger
/// whose ratio is much below or much above 1 does not come to rest. The permitted range depends on the
/// controller (finger.controller.scheme: state feedback, or figure 9, 10 or 11 of the report), the servo
/// rate (hand.rate) and the largest eigenvalue k of the stiffness, N/cm:
///
///                                     1000 Hz and above    below 1000 Hz
///   state feedback         smallest   0.40 + 0.09 k        0.70 + 0.07 k
///                          largest    2.10 - 0.19 k        2.00 - 0.20 k
///   figures 9, 10, 11      smallest   1                    1
///                          largest    2.50 - 0.22 k        2.00 - 0.20 k
///
/// The limits are rounded inward to multiples of 0.01: with 1.5 N/cm the largest ratio is 1.81, not 1.815.
/// By default the range is 0.67 to 1.53 at 3 N/cm and 0.94 to 1 at 6 N/cm. If the smallest ratio of the
/// table is above 1, or the largest is below 1, the limit is 1 instead: 1 is always admitted. For a
/// finger with other links or tendons, k is first multiplied by 12.3 N/cm divided by S. S is the smallest
/// stiffness that the tendons give the tip in any direction, with locked motors and with the joints in the
/// middle of their ranges. For the default finger S is 12.3 N/cm. For the stiffness of
/// sun2xp_send_joint_stiffness, k is its largest eigenvalue divided by l2 l2, where l2 is the length of the
/// last link. While a path changes Kx, k is that of the stiffest Kx from the beginning to the end of the
/// path. Every call that sends a stiffness is refused if the range for this stiffness does not include the
/// ratio sent last. With hand.out_of_range = "clamp" the ratio is clamped instead.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EINVAL   no such finger; ratio is NaN or infinite
///   EIO      the finger is faulted
///   ERANGE   ratio is outside the range that sun2xp_error_text gives (hand.out_of_range = "clamp" clamps
///            it)
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_send_damping(hand: *mut sun2xp_hand, finger: c_int, ratio: f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_damping", hand, || {
        let command = || FingerCommand::new(finger).damping(ratio);
        hand_table::send(hand, |hand| hand.send_damping(finger, ratio), command)
    })
}

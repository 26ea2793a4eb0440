//! The exported function for the limits of a finger. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::limits_struct::sun2xp_limits;
use crate::capi::sized_struct::fill_from_either;
use crate::hand::{FingerLimits, Hand};
use std::ffi::c_int;

/// sun2xp_limits - read the limits of a finger
///
///   finger   1 to 3
///   limits   result; set limits->size before the call
///
/// The limits come from the configuration. sun2xp_adjust can change all of them except motor_torque.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   limits is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     struct sun2xp_limits limits;
///     limits.size = sizeof limits;
///     if (sun2xp_limits(hand, 1, &limits) == 0)
///         printf("joint 1 bends to %g rad\n", limits.joint_maximum[1]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_limits(hand: *mut sun2xp_hand, finger: c_int, limits: *mut sun2xp_limits) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_limits", hand, || {
        // SAFETY: by the contract in the manual, `limits` is null or points to as many bytes as its first member gives.
        unsafe {
            let local = |hand: &Hand| hand.limits(finger).map(|limits| to_c(&limits));
            fill_from_either(hand, limits, "limits", local, |remote| remote.limits(finger))
        }
    })
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(limits: &FingerLimits) -> sun2xp_limits {
    let FingerLimits { joint_minimum, joint_maximum, tension_minimum, tension_maximum, motor_torque, stiffness } =
        *limits;
    sun2xp_limits { size: 0, joint_minimum, joint_maximum, tension_minimum, tension_maximum, motor_torque, stiffness }
}

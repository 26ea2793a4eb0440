//! The exported functions for the fingertip, and for other changes while a finger runs. Their doc comments are the C
//! manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded};
use crate::capi::default_hand;
use crate::capi::memory::{fill, load, non_null, size_up_to};
use crate::capi::refusal::Wanted;
use crate::hand::{ConfigurationError, HandError, SetPointError};
use crate::model::{Contact, ContactError};
use nalgebra::{Matrix3, Matrix4, Vector3};
use std::ffi::{CStr, c_char, c_int, c_uint};

/// Result of GetTip. Vectors are in the finger's frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerTip {
    /// In: sizeof (struct FingerTip). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Number of directions of Force that the joints can measure: 3, or fewer near singular poses.
    pub Felt: c_int,
    /// Position of the tip: x, y, z, cm.
    pub Tip: [f64; 3],
    /// Force of the tip on the object that it touches: x, y, z, N. It is computed from the measured tensions, so it
    /// includes friction, weight and inertia of the finger. It is never NaN, and is zero along directions that the
    /// joints cannot measure.
    pub Force: [f64; 3],
    /// Measured tendon tensions, N.
    pub Tensions: [f64; 4],
    /// Stiffness of the tip in its present pose, N/cm, row by row: the fraction of Kx that is in force, plus
    /// what joint limits, nearness to the axis of joint 0 and the rotational stiffness of a contact add. It is zero
    /// along directions that the joints cannot measure, and while the finger is not running.
    pub Stiffness: [[f64; 3]; 3],
    /// Force of the tip on the object that it touches: x, y, z, N, without friction, weight and inertia of the
    /// finger, and without constant errors of the gauges. It is zero while the finger is not running.
    pub Contact: [f64; 3],
    /// Speed of the tip perpendicular to Contact, cm/s, while Touching: the tip slides on the object, or moves it.
    pub Slide: f64,
    /// 1: according to tensions and motion, the finger touches something. 0: it does not.
    pub Touching: c_int,
    /// Always zero.
    pub Unused: c_int,
}

/// SendTip - send a desired fingertip position to a finger
///
///     int SendTip(int i, const double *Tip);
///
///   i     finger, 1 to 3
///   Tip   Tip[3]: desired x, y, z of the tip in the finger's frame (chapter 3), cm. Always double
///
/// From the next cycle on the anchor of the fingertip's spring moves to Tip, along a straight line in
/// joint angles and at a bounded speed. The stiffness is the one sent last. When the anchor is at Tip
/// and p is the position of the fingertip, the force is Kx (Tip - p) at any distance, whatever the
/// configured controller.law. If several joint solutions are within the joint limits, the call takes
/// the one nearest to the present pose.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Tip is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   ERANGE   Tip is too far, too near, or outside the joint limits; it is never clamped
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes less than 1 us.
///
/// Example:
///
///     double Tip[3] = {0.0, -6.0, 8.0};
///     SendTip(1, Tip);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendTip(i: c_int, Tip: *const f64) -> c_int {
    guarded("SendTip", || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let tip = unsafe { load::<f64, 3>(Tip, "Tip") }?;
        default_hand::command(|hand| hand.send_tip(i, tip))
    })
}

/// GetTip - read position, force and stiffness of a fingertip, and the tendon tensions
///
///     int GetTip(int i, struct FingerTip *Tip);
///
///   i     finger, 1 to 3
///   Tip   result, from the last cycle of the servo; set Tip->Size before the call
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Tip is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 1 us.
///
/// Example:
///
///     struct FingerTip Tip;
///     Tip.Size = sizeof Tip;
///     if (GetTip(1, &Tip) == 0)
///         printf("%g N along z\n", Tip.Force[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetTip(i: c_int, Tip: *mut FingerTip) -> c_int {
    guarded("GetTip", || {
        let least = size_up_to!(FingerTip, Tensions: [f64; 4]);
        // SAFETY: by the contract in the manual, `Tip` is null or points to as many bytes as its first member gives.
        unsafe { fill(Tip, "Tip", least, |hand| hand.fingertip(i).map(|tip| tip.into())) }
    })
}

/// SendContact - make a fingertip the spring of a contact type
///
///     int SendContact(int i, int D, const double *K, const double *Normal);
///
///   i        finger, 1 to 3
///   D        dimensions of the contact (section 4.2 of the report):
///            1   frictionless point: a force along the normal
///            3   hard finger with friction: three forces; SendContact (i, 3, Kx, 0) is the same as
///                SendKx (i, Kx)
///            4   soft finger: three forces and a moment about the normal
///   K        K[D][D] or K[D * D], row by row. Always double. For D = 1: N/cm along the normal. For
///            D = 3 and 4, rows and columns 0 to 2 are x, y, z of the finger's frame, N/cm. For D = 4,
///            row and column 3 are the rotation about the normal: N cm/rad on the diagonal, else N/rad
///   Normal   Normal[3]: the contact normal in the finger's frame, of any length but zero. Always
///            double. Not used for D = 3, and may be null there
///
/// The contact takes effect as a whole, without a jump in torque. It replaces the stiffness sent last,
/// and a later SendKx replaces it. In directions outside the contact, the finger is limp but still
/// damped. K must be symmetric and must have no negative eigenvalue, as for SendKx. To compare it with
/// the bound, a rotational stiffness of k N cm/rad is converted to k / (l2 l2) N/cm, where l2 is the
/// length of the last link.
///
/// D = 4 is not a spring in four independent directions, because three joints turn the tip only by
/// moving it. A tip that moves by v cm turns about Normal by c . v rad, and the vector c depends on the
/// pose. A rotational stiffness of k N cm/rad therefore stiffens the tip along c, by k |c| |c| N/cm, and
/// the tip exerts no moment that is independent of its force. In the pose 0, 0.5, 0.8 rad the example
/// below gives 3.24, 3 and 3 N/cm along x, y and z. With Normal along x it gives 3, 3.56 and 4.87 N/cm,
/// and -1.02 N/cm between y and z. Stiffness of GetTip is the stiffness that results.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   K is null; Normal is null for D = 1 or 4
///   ENODEV   no hand is open
///   EINVAL   no such finger; no such D; an entry is NaN or infinite
///   EDOM     K is not symmetric, or has a negative eigenvalue; Normal is zero
///   ERANGE   K is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///   ERANGE   K is too stiff for the ratio of SendDamping ("clamp" clamps the ratio instead)
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, a soft finger:
///
///     double K[4][4] = {{3, 0, 0, 0}, {0, 3, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 20}};
///     double Normal[3] = {0, -1, 0};
///     SendContact(1, 4, &K[0][0], Normal);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendContact(i: c_int, D: c_int, K: *const f64, Normal: *const f64) -> c_int {
    guarded("SendContact", || {
        // K is checked before D, which determines the size of K.
        non_null(K, "K", Wanted::Matrix)?;
        // SAFETY: here and below, by the contract in the manual, the pointer is null or points to the array for this D.
        let normal = || unsafe { load::<f64, 3>(Normal, "Normal") }.map(Vector3::from);
        let contact = match D {
            1 => Contact::frictionless_point(unsafe { load::<f64, 1>(K, "K") }?[0], normal()?),
            3 => Contact::hard_finger(Matrix3::from_row_slice(&unsafe { load::<f64, 9>(K, "K") }?)),
            4 => Contact::soft_finger(Matrix4::from_row_slice(&unsafe { load::<f64, 16>(K, "K") }?), normal()?),
            _ => return default_hand::command(|hand| hand.report(i).and(Err(SetPointError::NoSuchContact(D).into()))),
        };
        default_hand::command(|hand| -> Result<(), HandError> {
            // Reports a wrong finger number before an unusable contact.
            hand.report(i)?;
            let finger = i.try_into()?;
            hand.send_contact(i, contact.map_err(|source: ContactError| SetPointError::Contact { finger, source })?)
        })
    })
}

/// SendDamping - set the damping of a fingertip
///
///     int SendDamping(int i, double Ratio);
///
///   i       finger, 1 to 3
///   Ratio   damping relative to what the controller chooses from the stiffness; 1 after OpenHand
///
/// The ratio changes without a jump in torque and stays until another ratio is sent. A finger with
/// much less or much more damping does not come to rest. The range therefore depends on controller,
/// rate and the largest eigenvalue k of the stiffness, N/cm:
///
///                                     1000 Hz and above    below 1000 Hz
///   state feedback         smallest   0.40 + 0.09 k        0.70 + 0.07 k
///                          largest    2.50 - 0.22 k        2.00 - 0.20 k
///   figures 9, 10, 11      smallest   1                    1
///                          largest    2.50 - 0.22 k        2.00 - 0.20 k
///
/// By default the range is 0.67 to 1.84 at 3 N/cm and 0.94 to 1.18 at 6 N/cm. It always includes 1.
/// For a finger with other links or tendons, k is first multiplied by 12.3 N/cm divided by S. S is
/// the smallest stiffness that the tendons give the tip in any direction, with locked motors and with
/// the joints in the middle of their ranges. For the default finger S is 12.3 N/cm. SendKx and
/// SendContact refuse a stiffness whose range does not include the ratio sent last.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EINVAL   no such finger; Ratio is NaN or infinite
///   EIO      the finger is faulted
///   ERANGE   Ratio is outside the range that HandError gives (hand.out_of_range = "clamp" clamps it)
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
#[unsafe(no_mangle)]
pub extern "C" fn SendDamping(i: c_int, Ratio: f64) -> c_int {
    guarded("SendDamping", || default_hand::command(|hand| hand.send_damping(i, Ratio)))
}

/// AdjustFinger - change the configuration of a finger while it runs
///
///     int AdjustFinger(int i, const char *Keys);
///
///   i      finger, 1 to 3
///   Keys   lines of TOML, in UTF-8, as under [finger.i] of the configuration file (chapter 8)
///
/// All keys take effect together, within a cycle and without a jump in torque; other keys stay as they
/// are. The change lasts until CloseHand: the file is not written. A new controller.law applies from
/// the next SendPos on. These keys cannot change while the hand is open: port, baud, reconnect,
/// address, thread, core, priority, base, turn_degrees, encoder, motor.sign, motor.torque_limit,
/// motor.torque_constant, stiffness.initial and simulation.
///
/// A configured stiffness.bound was chosen for the configured controller.scheme. If Keys changes
/// controller.scheme but does not set stiffness.bound, the smaller of the configured bound and the
/// default bound applies.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Keys is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; Keys is not TOML
///   EBUSY    a key cannot change while the hand is open
///   EINVAL   an unknown key; an unusable configuration
///   ERANGE   the position or stiffness sent last is outside the new limits (hand.out_of_range =
///            "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 200 us, and allocates memory.
///
/// Example:
///
///     AdjustFinger(1, "tendon.minimum = 6\ncontroller.tension_gain = 3");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn AdjustFinger(i: c_int, Keys: *const c_char) -> c_int {
    delegated("AdjustFinger", MEMORY_OF_CALL, || {
        non_null(Keys, "Keys", Wanted::Text)?;
        // SAFETY: `Keys` is not null, as checked above, and by the contract in the manual it is a C string.
        let keys = unsafe { CStr::from_ptr(Keys) }.to_owned();
        Ok(move || {
            default_hand::command(|hand| -> Result<(), HandError> {
                hand.report(i)?;
                let reason = "is not UTF-8".to_string();
                let finger = i.try_into()?;
                let refused = |_| ConfigurationError::Adjustment { finger, line: 1, reason };
                hand.adjust(i, keys.to_str().map_err(refused)?)
            })
        })
    })
}

/// PushFinger - push the fingertip of a simulated finger
///
///     int PushFinger(int i, const double *Force);
///
///   i       finger, 1 to 3
///   Force   Force[3]: force on the fingertip along x, y, z of the finger's frame, N. Always double. It
///           acts until the next call; zero ends it
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Force is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   ENOTSUP  the finger is on a real port
///   ERANGE   a component is beyond 1000 N
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn PushFinger(i: c_int, Force: *const f64) -> c_int {
    guarded("PushFinger", || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let force = unsafe { load::<f64, 3>(Force, "Force") }?;
        default_hand::command(|hand| hand.push_simulated(i, force))
    })
}

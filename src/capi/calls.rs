//! The five calls of 1990, their forms for arrays of double, and HandError. Their doc comments are the C manual:
//! cbindgen copies them into `include/Sun2Xp.h`, below the chapters of `src/capi/header/manual.txt`. The comments are
//! written for C programmers. They keep their indentation in the header, and must not contain the end of a C comment.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_HAND, delegated, delegated_or_done_here, guarded, uncancelled};
use crate::capi::hand_events::in_callback;
use crate::capi::hand_table::{self, default_handle};
use crate::capi::handle::Handle;
use crate::capi::loaded_hand;
use crate::capi::memory::{load, load_rows, non_null};
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::thread_errors::find;
use crate::hand::FingerCommand;
use std::ffi::{c_char, c_int};

/// OpenHand - start the hand
///
///     int OpenHand(void);
///
/// Reads the configuration (chapter 7), opens the ports, starts the servos and brings the tendons
/// under tension. Returns when every finger has answered and holds its present pose at the configured
/// initial stiffness. From then on GetPos is valid, and nothing moves until SendPos. Takes at most
/// about a second for the simulated hand.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENOMEM   there is not enough memory
///   EBUSY    a hand is open and stays open, or another thread is opening or closing one
///   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
///   EINVAL   the configuration is unusable; HandError names file, line and reason
///   ENOENT, EACCES, EBUSY ...  a port cannot be opened; errno of the system
///   ETIMEDOUT ...  a board does not answer, or the device at the port is not a board. The errno is
///            ENODEV if the board that finger.board names is not found, or is found at several ports
///   EIO      the tendons of a finger do not come under tension in time, the finger faults before
///            that, or the self-test finds wrong wiring (hand.self_test)
///   EPERM, ENOMEM, EINVAL ...  hand.real_time is "enforce", and SCHED_FIFO, locked memory or the
///            configured core is not available; HandError says what to change
///
/// Threads: any. The calls of sun2xp.h open further hands.
///
/// Example:
///
///     if (OpenHand() != 0) {
///         fprintf(stderr, "%s\n", HandError());
///         exit(1);
///     }
#[unsafe(no_mangle)]
pub extern "C" fn OpenHand() -> c_int {
    delegated("OpenHand", default_handle(), MEMORY_OF_HAND, || {
        // `in_callback` examines the calling thread, but the returned function runs in another thread.
        let in_callback = in_callback();
        Ok(move || hand_table::open_default(loaded_hand::open, in_callback))
    })
}

/// CloseHand - stop the hand
///
///     int CloseHand(void);
///
/// Brings every finger to the configured end state and stops the servos. With hand.end_state =
/// "release" the torque ramps to zero. With "hold" the board keeps the last torque, up to
/// hand.hold_torque_limit, for hand.hold_time_ms, also after this call has returned. If no hand is
/// open, the call does nothing and returns 0. OpenHand may be called again afterwards. At exit the
/// library closes a hand that is still open.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EBUSY    the call was made in an event callback (sun2xp_on_event) of any hand, while another thread
///            was opening or closing this hand
///
/// Threads: any. Waits for an OpenHand or CloseHand of another thread, then closes. Waits until the
/// callback of this hand has returned, unless the call was made in an event callback of any hand.
#[unsafe(no_mangle)]
pub extern "C" fn CloseHand() -> c_int {
    delegated_or_done_here("CloseHand", default_handle(), || {
        if in_callback() { hand_table::close_default_in_callback } else { hand_table::close_default }
    })
}

/// SendPos - send desired joint angles to a finger
///
///     int SendPos(int i, const float *Pos);      also takes const double *Pos (chapter 4)
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: desired angles of joints 0, 1, 2, rad (chapter 3)
///
/// All three angles take effect together. From the next cycle on, the anchor (rest position) of the
/// fingertip's spring moves to Pos, along a straight line in joint angles and at a bounded speed. The
/// stiffness is the one sent last. When the anchor is at Pos, the force of the fingertip is Kx (Tip - p)
/// at any distance: Tip is the position of the fingertip at the angles Pos, and p is its present
/// position. With finger.controller.law = "report" the finger follows the law of the report, which holds
/// for small distances. The call does not wait until the finger arrives; GetPos reads where it is. The
/// limits are the configured joint limits, by default -1.0472 to 1.0472 rad for joint 0, -0.5236 to
/// 1.7453 rad for joint 1 and 0.0873 to 2.0944 rad for joint 2.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Pos is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an angle is NaN or infinite
///   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
///
/// Example:
///
///     float Pos[3] = {0.0, 0.5, 0.8};
///     SendPos(1, Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPos(i: c_int, Pos: *const f32) -> c_int {
    guarded("SendPos", default_handle(), || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let joints = unsafe { load::<f32, 3>(Pos, "Pos") }?;
        send_joints(i, joints.map(f64::from))
    })
}

/// SendPosD - SendPos for an array of double
///
///     int SendPosD(int i, const double *Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPosD(i: c_int, Pos: *const f64) -> c_int {
    // Refusals use the name in the planner's source. The header or a compiler flag has added the D.
    guarded("SendPos", default_handle(), || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let joints = unsafe { load::<f64, 3>(Pos, "Pos") }?;
        send_joints(i, joints)
    })
}

/// SendKx - set the stiffness of a fingertip
///
///     int SendKx(int i, const float *Kx);        also takes const double *Kx (chapter 4)
///
///   i     finger, 1 to 3
///   Kx    Kx[3][3] or Kx[9], row by row: entry [row][column] is the force along axis row (x, y, z of
///         the finger's frame, chapter 3) for a displacement of 1 cm along axis column, N/cm
///
/// All entries begin to change in the next cycle, without a jump in torque: 95 % of the change has
/// taken effect after 50 ms. Kx must be symmetric; two mirrored entries that differ by up to 1e-3 of
/// the largest entry are averaged. No eigenvalue may be below -1e-3 times the largest one. Kx may be
/// singular or zero: along directions without stiffness the finger is limp but still damped. The
/// largest eigenvalue may be at most the configured bound, by default 6 N/cm if the servo rate
/// (hand.rate) is 1000 Hz or more, and 5 N/cm otherwise.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Kx is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   EDOM     Kx is not symmetric, or has a negative eigenvalue
///   ERANGE   Kx is stiffer than the bound (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///   ERANGE   Kx is too stiff for the damping ratio of sun2xp_send_damping ("clamp" clamps this ratio
///            instead)
///
/// Threads: any. Never waits for a servo. Takes about 1 us.
///
/// Example, softer along z:
///
///     double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 1}};
///     SendKx(1, Kx);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendKx(i: c_int, Kx: *const f32) -> c_int {
    guarded("SendKx", default_handle(), || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let rows = unsafe { load_rows(Kx, "Kx") }?;
        send_rows(i, rows.map(|row| row.map(f64::from)))
    })
}

/// SendKxD - SendKx for an array of double
///
///     int SendKxD(int i, const double *Kx);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendKxD(i: c_int, Kx: *const f64) -> c_int {
    // Refusals use the name in the planner's source. The header or a compiler flag has added the D.
    guarded("SendKx", default_handle(), || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let rows = unsafe { load_rows(Kx, "Kx") }?;
        send_rows(i, rows)
    })
}

/// GetPos - read the joint angles of a finger
///
///     int GetPos(int i, float *Pos);             also takes double *Pos (chapter 4)
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: measured angles of joints 0, 1, 2, rad, from the last cycle of the servo
///
/// While the servo thread does not run, the angles stay those of its last cycle.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Pos is null
///   ENODEV   no hand is open
///   EINVAL   no such finger
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 100 ns.
///
/// Example:
///
///     double Pos[3];
///     if (GetPos(2, Pos) == 0)
///         printf("%g %g %g\n", Pos[0], Pos[1], Pos[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPos(i: c_int, Pos: *mut f32) -> c_int {
    guarded("GetPos", default_handle(), || {
        let joints = non_null(Pos, "Pos", Wanted::Array(3)).and_then(|_| position(i))?;
        // SAFETY: `Pos` is not null, as checked above, and by the contract in the manual it has room for three angles.
        unsafe { Pos.cast::<[f32; 3]>().write_unaligned(joints.map(|joint| joint as f32)) };
        Ok(())
    })
}

/// GetPosD - GetPos for an array of double
///
///     int GetPosD(int i, double *Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPosD(i: c_int, Pos: *mut f64) -> c_int {
    // Refusals use the name in the planner's source. The header or a compiler flag has added the D.
    guarded("GetPos", default_handle(), || {
        let joints = non_null(Pos, "Pos", Wanted::Array(3)).and_then(|_| position(i))?;
        // SAFETY: `Pos` is not null, as checked above, and by the contract in the manual it has room for three angles.
        unsafe { Pos.cast::<[f64; 3]>().write_unaligned(joints) };
        Ok(())
    })
}

/// HandError - why a call was refused, and the remedy
///
///     const char *HandError(void);
///
/// Returns the text of the calling thread's last refused call, or an empty string if no call was
/// refused. A call that succeeds changes neither the text nor errno. So read the text only after a call
/// has returned -1. The pointer is never null. Do not free the text: it belongs to the library, and is
/// valid until the next refused call of the same thread.
///
/// Threads: any; each has its own text. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn HandError() -> *const c_char {
    uncancelled(|| find(Handle::NULL).text)
}

#[inline]
fn send_joints(finger: c_int, joints: [f64; 3]) -> Result<(), Refusal> {
    let command = || FingerCommand::new(finger).joints(joints);
    hand_table::send(default_handle(), |hand| hand.send_position(finger, joints), command)
}

#[inline]
fn send_rows(finger: c_int, rows: [[f64; 3]; 3]) -> Result<(), Refusal> {
    let command = || FingerCommand::new(finger).stiffness(rows);
    hand_table::send(default_handle(), |hand| hand.send_stiffness(finger, rows), command)
}

#[inline]
fn position(finger: c_int) -> Result<[f64; 3], Refusal> {
    hand_table::with_either(default_handle(), |hand| hand.position(finger), |remote| remote.position(finger))
}

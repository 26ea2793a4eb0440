//! The exported functions for stop and recovery. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded, uncancelled};
use crate::capi::fingers::fingers;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::loaded_hand;
use crate::capi::long_operations;
use crate::hand;
use std::ffi::c_int;

/// sun2xp_stop_all - emergency stop
///
/// Every finger of every open hand faults (SUN2XP_FAULT_EMERGENCY_STOP_CALL) at the start of its next cycle. The servo
/// commands its board to bring the motors of the finger into the configured end state. Calls that command the
/// finger or read its pose are refused with EIO until sun2xp_recover, or sun2xp_close and sun2xp_open. A hand
/// that is opened later is not affected.
///
/// With hand.end_state = "release", the default, the torque goes to zero at once. With "hold" the motors
/// keep their last torque, up to hand.hold_torque_limit, for hand.hold_time_ms, by default 2 s and at most
/// a minute. Configure "hold" only for objects that must not be dropped. The torque ends earlier in three
/// cases: the board detects a fault (emergency stop input, supply, driver or sensor), the board is reset or
/// loses its power, or the board is configured again. sun2xp_recover configures the board again, and so does
/// sun2xp_open after sun2xp_close.
///
/// sun2xp_stop_all is not a safety function: it needs this process, this machine and the cable.
///
/// Returns 0.
///
/// Threads: any, and signal handlers: it is async-signal-safe, does not set errno and waits for nothing. In
/// a forked child it does nothing.
///
/// Example, for Control-C:
///
///     static void on_interrupt(int signal)
///     {
///         (void)signal;
///         sun2xp_stop_all();
///     }
///
///     signal(SIGINT, on_interrupt);
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_stop_all() -> c_int {
    uncancelled(|| {
        hand::stop_all();
        loaded_hand::stop_all();
        0
    })
}

/// sun2xp_stop - stop a finger, or all fingers of a hand
///
///   finger   1 to 3, or SUN2XP_ALL_FINGERS
///
/// The finger faults (SUN2XP_FAULT_STOP_CALL) at the start of its next cycle, and its motors enter the
/// configured end state, as with sun2xp_stop_all. The other fingers continue, also those on the same board,
/// unless hand.on_fault is "hand". The finger stays stopped until sun2xp_recover, or sun2xp_close and
/// sun2xp_open. A finger that has faulted already stays as it is. Like sun2xp_stop_all, sun2xp_stop is not a
/// safety function. Unlike sun2xp_stop_all, it must not be called in a signal handler.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EINVAL   no such finger
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_stop(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_stop", hand, || {
        let local = |hand: &hand::Hand| fingers(hand, finger).try_for_each(|finger| hand.stop(finger));
        hand_table::with_either(hand, local, |remote| remote.stop(finger))
    })
}

/// sun2xp_recover - make a faulted finger a spring again
///
///   finger   1 to 3, or SUN2XP_ALL_FINGERS: one after the other, up to the first that does not recover
///
/// Queries the identity of the finger's board, configures the board again, and brings the tendons under
/// tension. If the port has failed and finger.reconnect is true, the call reopens the port first. The finger
/// holds its present pose at the configured initial stiffness. If another finger on the same port runs, it
/// continues unchanged, and only this finger recovers. Otherwise all fingers on the port recover together,
/// and the call is not refused if another one of them faults again. If the finger to be recovered is not
/// faulted, the call changes nothing. It then only waits for a recovery that another call has begun. Remove
/// the cause of the fault first: sun2xp_fault and sun2xp_fault_text name it.
///
/// Waits until the finger holds its pose or faults again, up to some seconds, also if another call has begun
/// the recovery. Other calls work meanwhile. sun2xp_close works too, and this call is then refused.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand, or it was closed meanwhile; or the port has failed and finger.reconnect
///            is false
///   EINVAL   no such finger
///   EIO      the finger faults again; or its board is not the one found by sun2xp_open, or has lost its
///            zero; or its servo thread has failed (SUN2XP_FAULT_SERVO_PANIC), which only sun2xp_close and
///            sun2xp_open remedy. sun2xp_error_text gives the reason
///   ENOENT, EACCES, ETIMEDOUT ...  the port is not there yet, the board does not answer, or the servo
///            does not run. Call again
///
/// Threads: any.
///
/// Example:
///
///     while (sun2xp_recover(hand, 1) != 0) {
///         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
///         sleep(1);
///     }
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_recover(hand: *mut sun2xp_hand, finger: c_int) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_recover", hand, MEMORY_OF_CALL, || {
        Ok(move || {
            if let Some(remote) = hand_table::remote_to_command(hand)? {
                return Ok(remote.recover(finger)?);
            }
            let mut all = hand_table::command(hand, |hand| Ok::<_, hand::HandError>(fingers(hand, finger)))?;
            all.try_for_each(|finger| long_operations::recover(hand, finger))
        })
    })
}

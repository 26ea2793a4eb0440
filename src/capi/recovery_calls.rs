//! The exported functions for stop and recovery. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded};
use crate::capi::default_hand;
use crate::hand;
use std::ffi::c_int;

/// StopHand - emergency stop
///
///     int StopHand(void);
///
/// Every finger faults (FAULT_EMERGENCY_STOP_CALL) at the start of its next cycle. The servo commands
/// its board to enter the configured end state, and calls for the finger are refused with EIO until
/// RecoverHand, or CloseHand and OpenHand. If no hand is open, the call does nothing; a hand that is
/// opened later is not affected.
///
/// With hand.end_state = "release", the default, the torque goes to zero at once. With "hold" the
/// motors keep their last torque, up to hand.hold_torque_limit, for hand.hold_time_ms, by default 2 s
/// and at most a minute. Configure "hold" only for objects that must not be dropped: no call releases
/// the torque earlier. Only the emergency stop input of the board, or cutting the board's power, does.
///
/// StopHand is not a safety function: it needs this process, this machine and the cable.
///
/// Returns 0.
///
/// Threads: any, and signal handlers: it is async-signal-safe, does not set errno and waits for
/// nothing. In a forked child it does nothing.
///
/// Example, for Control-C:
///
///     static void OnInterrupt(int Signal)
///     {
///         (void)Signal;
///         StopHand();
///     }
///
///     signal(SIGINT, OnInterrupt);
#[unsafe(no_mangle)]
pub extern "C" fn StopHand() -> c_int {
    hand::stop_all();
    0
}

/// StopFinger - stop one finger
///
///     int StopFinger(int i);
///
///   i        finger, 1 to 3
///
/// The finger faults (FAULT_STOP_CALL) at the start of its next cycle, and its board enters the
/// configured end state, as with StopHand. The other fingers continue, unless hand.on_fault is "hand".
/// The finger stays stopped until RecoverHand, or CloseHand and OpenHand. A finger that has faulted
/// already stays as it is. Like StopHand, this is not a safety function. Unlike StopHand, it must not be
/// called in a signal handler.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EINVAL   no such finger
///
/// Threads: any. Never waits for a servo.
#[unsafe(no_mangle)]
pub extern "C" fn StopFinger(i: c_int) -> c_int {
    guarded("StopFinger", || default_hand::with(|hand| hand.stop(i)))
}

/// RecoverHand - make a faulted finger a spring again
///
///     int RecoverHand(int i);
///
///   i        finger, 1 to 3
///
/// Queries the identity of the finger's board and configures the board again. If the port has failed
/// and finger.reconnect is true, reopens the port first. Then brings the tendons under tension. The
/// finger holds its present pose at the configured initial stiffness. If another finger on the same
/// port runs, it continues unchanged, and only finger i recovers. Otherwise all fingers on the port
/// recover together. A finger that is not faulted continues unchanged. Remove the cause of the fault
/// first: GetFault and FaultText name it.
///
/// Waits until the finger holds its pose or faults again, up to some seconds. Other calls work
/// meanwhile. CloseHand works too, and this call is then refused.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open, or it was closed meanwhile; or the port has failed and finger.reconnect
///            is false
///   EINVAL   no such finger
///   EIO      the finger faults again; or its board is not the one found by OpenHand, or has lost its
///            zero; or its servo thread has failed (FAULT_SERVO_PANIC), which only CloseHand and
///            OpenHand remedy. HandError says which
///   ENOENT, EACCES, ETIMEDOUT and other errnos of a port or link: the port is not there yet, the board
///            does not answer, or the servo does not run. Call again
///
/// Threads: any.
///
/// Example:
///
///     while (RecoverHand(1) != 0) {
///         fprintf(stderr, "%s\n", HandError());
///         sleep(1);
///     }
#[unsafe(no_mangle)]
pub extern "C" fn RecoverHand(i: c_int) -> c_int {
    delegated("RecoverHand", MEMORY_OF_CALL, || Ok(move || default_hand::recover(i)))
}

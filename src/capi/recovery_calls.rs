//! The exported functions about stopping and going on; their comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated};
use crate::capi::default_hand;
use crate::hand;
use std::ffi::c_int;

/// StopHand - emergency stop
///
///     int StopHand(void);
///
/// Every finger faults (FAULT_EMERGENCY_STOP_CALL) at the beginning of its next cycle: its
/// board is told to go to the configured end state, and its calls are refused with EIO.
/// With hand.end_state = "release", the default, the torque goes to zero at once. With
/// "hold" the motors keep their last torque, up to hand.hold_torque_limit, for
/// hand.hold_time_ms, by default 2 s and at most a minute: who configures "hold" has
/// something that must not be dropped. No call makes the finger limp earlier; the
/// emergency stop input of the board does, whatever the end state, and so does its power.
/// It stays so until RecoverHand, or CloseHand and OpenHand. Without a hand it does
/// nothing, and a hand that is opened later knows nothing of it. It is no safety function:
/// it needs this process, this machine and the cable.
///
/// Returns 0.
///
/// Threads: any, and signal handlers: it is async-signal-safe, sets no errno and waits for
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

/// RecoverHand - make a faulted finger a spring again
///
///     int RecoverHand(int i);
///
///   i        finger, 1 to 3
///
/// Asks the finger's board who it is and configures it anew; opens the port anew where it
/// has failed and finger.reconnect is true. Then the tendons are brought under tension,
/// and the finger holds the pose that it is found in, at the configured initial stiffness.
/// Fingers that share the port recover with it. A finger that is not faulted goes on as it
/// is. Repair the cause of the fault first: GetFault and FaultText name it.
///
/// Waits until the finger holds its pose or faults again: up to some seconds. Other calls
/// go on meanwhile. CloseHand too, and this call is refused then.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open, or it was closed meanwhile; or the port has failed and
///            finger.reconnect is false
///   EINVAL   no such finger
///   EIO      the finger faults again, or its board is another one than at OpenHand or has
///            lost its zero, or its servo thread has failed (FAULT_SERVO_PANIC), which only
///            CloseHand and OpenHand mend; HandError says which
///   EBUSY    another finger on the same port runs: stop it first (StopHand, CloseHand)
///   ENOENT, EACCES, ETIMEDOUT and other errnos of a port or link: it is not there yet, or
///            the board does not answer, or the servo does not run. Call again
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

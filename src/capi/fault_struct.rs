//! The struct of sun2xp_fault. Its doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use std::ffi::{c_int, c_ulong};

/// Result of sun2xp_fault.
///
/// The text of sun2xp_fault_text says which kind of part a fault concerns, for example a tendon. The member
/// part or warning_part is 0 if the fault or the warning concerns the whole finger.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_fault {
    /// sizeof (struct sun2xp_fault), set before the call.
    pub size: usize,
    /// Fault that has stopped the finger: SUN2XP_FAULT_..., or 0 if none has.
    pub number: c_int,
    /// Number of the joint, 0 to 2, or of the tendon, motor, gauge or encoder, 1 to 4; 0 for the whole finger.
    pub part: c_int,
    /// Newest warning of the last second: SUN2XP_FAULT_..., or 0 if there was none. If the system has refused
    /// SCHED_FIFO to the hand, SUN2XP_FAULT_REALTIME_REFUSED takes the place of 0.
    pub warning: c_int,
    /// Part that the warning concerns, numbered as in part.
    pub warning_part: c_int,
    /// Value of the fault, in its unit (docs/faults.md).
    pub value: f64,
    /// Value of the warning.
    pub warning_value: f64,
    /// Warnings since sun2xp_open. A warning that persists counts once.
    pub warnings: c_ulong,
}

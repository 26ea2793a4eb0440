//! The exported functions for faults. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::{guarded, uncancelled};
use crate::capi::fault_struct::sun2xp_fault;
use crate::capi::fault_texts::TEXTS;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill_from_either;
use crate::capi::status_calls::count;
use crate::finger;
use crate::hand::{FingerFault, Hand};
use std::ffi::{c_char, c_int};

/// sun2xp_fault - fault and warning of a finger
///
///   finger   1 to 3
///   fault    result; set fault->size before the call
///
/// Returns 0, with or without a fault, or a negative number with
///   EPERM    forked child
///   EFAULT   fault is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     struct sun2xp_fault fault;
///     fault.size = sizeof fault;
///     if (sun2xp_fault(hand, 1, &fault) == 0 && fault.number != 0)
///         fprintf(stderr, "finger 1: %s\n", sun2xp_fault_text(fault.number));
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_fault(hand: *mut sun2xp_hand, finger: c_int, fault: *mut sun2xp_fault) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_fault", hand, || {
        // SAFETY: by the contract in the manual, `fault` is null or points to as many bytes as its first member gives.
        unsafe {
            let local = |hand: &Hand| hand.fault(finger).map(|fault| to_c(&fault));
            fill_from_either(hand, fault, "fault", local, |remote| remote.fault(finger))
        }
    })
}

/// sun2xp_fault_text - description of a fault
///
///   number   SUN2XP_FAULT_...
///
/// Returns one line with the fault's name, its meaning, the likely cause and the remedy, or an empty string
/// if no fault has this number. The pointer is never null, and the text stays valid until the process ends.
/// If a call was refused because of a fault, sun2xp_error_text gives the same text with the part and the
/// values.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_fault_text(number: c_int) -> *const c_char {
    uncancelled(|| {
        let index = usize::try_from(number).ok().and_then(|number| number.checked_sub(1));
        index.and_then(|index| TEXTS.get(index)).map_or(c"".as_ptr(), |text| text.as_ptr())
    })
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(found: &FingerFault) -> sun2xp_fault {
    let parts = |fault: Option<finger::Fault>| {
        fault.map_or((0, 0, 0.0), |fault| {
            (c_int::from(fault.kind.number()), c_int::from(fault.part.number()), fault.value)
        })
    };
    let (number, part, value) = parts(found.stopped);
    let (warning, warning_part, warning_value) = parts(found.warning);
    sun2xp_fault { size: 0, number, part, warning, warning_part, value, warning_value, warnings: count(found.warnings) }
}

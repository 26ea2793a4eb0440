//! The exported functions about faults; their comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{guarded, uncancelled};
use crate::capi::fault_texts::TEXTS;
use crate::capi::memory::{fill, size_up_to};
use crate::finger;
use crate::hand::FingerFault;
use std::ffi::{c_char, c_int, c_uint, c_ulong};

/// What GetFault tells of a finger. Set Size = sizeof (struct Fault) before the call:
/// later versions add members at the end.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Fault {
    /// In: bytes of room, sizeof *Fault. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// The fault that has stopped the finger: FAULT_..., or 0 if none has.
    pub Number: c_int,
    /// Its joint (0 to 2), tendon, motor, gauge or encoder (1 to 4), as its text says;
    /// 0 where it is of the whole finger.
    pub Part: c_int,
    /// A warning of the last second: FAULT_..., or 0 if there was none.
    pub Warning: c_int,
    /// Its joint, tendon, motor, gauge or encoder.
    pub WarningPart: c_int,
    /// How much: N, ms, degrees, counts, per cent, errno or status bits, as
    /// docs/faults.md says.
    pub Value: f64,
    /// How much, of the warning.
    pub WarningValue: f64,
    /// How many warnings have been given since OpenHand; one that goes on counts once.
    pub Warnings: c_ulong,
}

/// GetFault - what is wrong with a finger
///
///     int GetFault(int i, struct Fault *Fault);
///
///   i        finger, 1 to 3
///   Fault    Fault->Size is set by the caller, all else is filled in. Written only if
///            the call returns 0
///
/// Returns 0, whether something is wrong or not, or -1 with
///   EPERM    forked child
///   EFAULT   Fault is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///
/// Threads: any. Never waits for a servo.
///
/// Example:
///
///     struct Fault Fault;
///     Fault.Size = sizeof Fault;
///     if (GetFault(1, &Fault) == 0 && Fault.Number != 0)
///         fprintf(stderr, "finger 1: %s\n", FaultText(Fault.Number));
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetFault(i: c_int, Fault: *mut Fault) -> c_int {
    guarded("GetFault", || {
        let least = size_up_to!(self::Fault, Warnings: c_ulong);
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Fault, "Fault", least, |hand| hand.fault(i).map(|fault| told(&fault))) }
    })
}

/// FaultText - a fault in words
///
///     const char *FaultText(int Number);
///
///   Number   FAULT_...
///
/// Its name, what is the case, the likely cause and the remedy, in one line. An empty
/// string for a number that is no fault. Never null, valid for ever. Where a call was
/// refused because of a fault, HandError gives the same with part and figures.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn FaultText(Number: c_int) -> *const c_char {
    uncancelled(|| {
        let index = usize::try_from(Number).ok().and_then(|number| number.checked_sub(1));
        index.and_then(|index| TEXTS.get(index)).map_or(c"".as_ptr(), |text| text.as_ptr())
    })
}

fn told(told: &FingerFault) -> Fault {
    let parts = |fault: Option<finger::Fault>| {
        fault.map_or((0, 0, 0.0), |fault| {
            (c_int::from(fault.kind.number()), c_int::from(fault.part.number()), fault.value)
        })
    };
    let (number, part, value) = parts(told.stopped);
    let (warning, warning_part, warning_value) = parts(told.warning);
    Fault {
        Size: 0, // until the caller's room is known
        Number: number,
        Part: part,
        Warning: warning,
        WarningPart: warning_part,
        Value: value,
        WarningValue: warning_value,
        Warnings: c_ulong::try_from(told.warnings).unwrap_or(c_ulong::MAX),
    }
}

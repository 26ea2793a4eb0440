//! The exported functions for faults. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{guarded, uncancelled};
use crate::capi::fault_texts::TEXTS;
use crate::capi::memory::{fill, size_up_to};
use crate::finger;
use crate::hand::FingerFault;
use std::ffi::{c_char, c_int, c_uint, c_ulong};

/// Result of GetFault.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Fault {
    /// In: sizeof (struct Fault). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Fault that has stopped the finger: FAULT_..., or 0 if none has.
    pub Number: c_int,
    /// Part that has the fault: joint (0 to 2), or tendon, motor, gauge or encoder (1 to 4). FaultText says which kind
    /// of part it is. 0 if the fault concerns the whole finger.
    pub Part: c_int,
    /// Warning of the last second: FAULT_..., or 0 if there was none.
    pub Warning: c_int,
    /// Part that the warning concerns, numbered as in Part.
    pub WarningPart: c_int,
    /// Value of the fault: N, ms, degrees, counts, per cent, errno or status bits (docs/faults.md).
    pub Value: f64,
    /// Value of the warning.
    pub WarningValue: f64,
    /// Warnings since OpenHand. A warning that persists counts once.
    pub Warnings: c_ulong,
}

/// GetFault - fault and warning of a finger
///
///     int GetFault(int i, struct Fault *Fault);
///
///   i        finger, 1 to 3
///   Fault    result; set Fault->Size before the call
///
/// Returns 0, with or without a fault, or -1 with
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
        // SAFETY: by the contract in the manual, `Fault` is null or points to as many bytes as its first member gives.
        unsafe { fill(Fault, "Fault", least, |hand| hand.fault(i).map(|fault| to_c(&fault))) }
    })
}

/// FaultText - description of a fault
///
///     const char *FaultText(int Number);
///
///   Number   FAULT_...
///
/// Returns one line with the fault's name, its meaning, the likely cause and the remedy, or an empty
/// string if no fault has this number. The pointer is never null, and the text stays valid until the
/// process ends. If a call was refused because of a fault, HandError gives the same text with the part
/// and the values.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn FaultText(Number: c_int) -> *const c_char {
    uncancelled(|| {
        let index = usize::try_from(Number).ok().and_then(|number| number.checked_sub(1));
        index.and_then(|index| TEXTS.get(index)).map_or(c"".as_ptr(), |text| text.as_ptr())
    })
}

/// Converts everything except `Size`. [`fill`] sets `Size`, because it depends on the room of the caller.
fn to_c(found: &FingerFault) -> Fault {
    let parts = |fault: Option<finger::Fault>| {
        fault.map_or((0, 0, 0.0), |fault| {
            (c_int::from(fault.kind.number()), c_int::from(fault.part.number()), fault.value)
        })
    };
    let (number, part, value) = parts(found.stopped);
    let (warning, warning_part, warning_value) = parts(found.warning);
    Fault {
        Size: 0,
        Number: number,
        Part: part,
        Warning: warning,
        WarningPart: warning_part,
        Value: value,
        WarningValue: warning_value,
        Warnings: c_ulong::try_from(found.warnings).unwrap_or(c_ulong::MAX),
    }
}

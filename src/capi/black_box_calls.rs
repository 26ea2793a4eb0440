//! The exported functions for black boxes. Their doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded};
use crate::capi::default_hand;
use crate::capi::memory::{fill, non_null, size_up_to};
use crate::capi::refusal::Wanted;
use crate::capi::status_calls::{count, state};
use crate::control::Activity;
use crate::finger::KeptRecord;
use crate::hand;
use std::ffi::{CStr, OsStr, c_char, c_int, c_uint, c_ulong};
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

/// Result of GetRecord: one cycle of a finger, from the black box.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerRecord {
    /// In: sizeof (struct FingerRecord). Out: bytes written, at most that.
    pub Size: c_uint,
    /// FINGER_RUNNING to FINGER_CLOSED, at the end of the cycle.
    pub State: c_int,
    /// The cycle, counted from OpenHand; the first is 1.
    pub Cycle: c_ulong,
    /// First cycle that is stored now. All cycles from Oldest to Newest are stored.
    pub Oldest: c_ulong,
    /// Last cycle that is stored now.
    pub Newest: c_ulong,
    /// Start of the cycle on CLOCK_MONOTONIC, s.
    pub Time: f64,
    /// 1: the board's reply arrived. 0: it was lost.
    pub Answered: c_int,
    /// Status bits of the newest reply (docs/board-protocol.md).
    pub StatusBits: c_int,
    /// 1: the controller ran and computed the members below. 0: they are 0, because the finger was already faulted or
    /// a simulated finger had not answered.
    pub Computed: c_int,
    /// 1: PosSent is the set point in force. 0: none is in force, and PosSent is 0.
    pub Follows: c_int,
    /// Measured joint angles, rad.
    pub Pos: [f64; 3],
    /// Joint angles at which the spring is anchored, rad.
    pub PosSent: [f64; 3],
    /// Measured tendon tensions, N.
    pub Tension: [f64; 4],
    /// Commanded tendon tensions, N.
    pub TensionSent: [f64; 4],
    /// Commanded motor torques, N cm. They are sent to the board in the next cycle.
    pub Torque: [f64; 4],
}

/// GetRecord - one cycle of the last two seconds of a finger
///
///     int GetRecord(int i, unsigned long Cycle, struct FingerRecord *Record);
///
///   i        finger, 1 to 3
///   Cycle    a cycle from Record->Oldest to Record->Newest of an earlier call; 0: the newest cycle
///   Record   result; set Record->Size before the call
///
/// A record is a part of what WriteBlackBox writes into a file. Every cycle adds a record and removes
/// the oldest one. A faulted finger adds none, so its records are the last ones before the fault.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Record is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   ENOENT   the cycle is no longer stored, or has not taken place yet
///
/// Threads: any. Never waits for a servo.
///
/// Example, which prints the newer half of the records:
///
///     struct FingerRecord Record;
///     unsigned long Cycle, Last;
///     Record.Size = sizeof Record;
///     if (GetRecord(1, 0, &Record) == 0) {
///         Last = Record.Newest;
///         for (Cycle = (Record.Oldest + Last) / 2; Cycle <= Last; Cycle++)
///             if (GetRecord(1, Cycle, &Record) == 0)
///                 printf("%f %f\n", Record.Time, Record.Tension[0]);
///     }
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetRecord(i: c_int, Cycle: c_ulong, Record: *mut FingerRecord) -> c_int {
    guarded("GetRecord", || {
        let least = size_up_to!(self::FingerRecord, Torque: [f64; 4]);
        #[allow(clippy::useless_conversion, reason = "`unsigned long` has 32 bits on some machines")]
        let cycle = (Cycle != 0).then_some(u64::from(Cycle));
        // SAFETY: by the contract in the manual, `Record` is null or points to as many bytes as its first member gives.
        unsafe { fill(Record, "Record", least, |hand| hand.record(i, cycle).map(|kept| to_c(&kept))) }
    })
}

/// WriteBlackBox - write the last seconds of a finger into a file
///
///     int WriteBlackBox(int i, const char *Path);
///
///   i       finger, 1 to 3
///   Path    the file; an existing file is replaced
///
/// The library stores the last two seconds of every finger: feedback, set points, motor commands,
/// timing and state. For a faulted finger these are the last two seconds before the fault.
/// docs/black-box.md describes the file, and `sun2xp replay Path` recomputes its cycles. If
/// hand.black_box is set, the library also writes such a file whenever a finger faults.
///
/// The library writes a temporary file in the same folder, whose name begins with ".sun2xp-", and
/// renames it when it is complete and on the disk. So the folder must be writable, and a refused call
/// leaves an old file unchanged. The call takes about 50 ms plus the time that the disk needs for some
/// MB. The servos continue.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Path is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; Path names something other than a regular file, such as a symbolic link,
///            a device or a folder
///   ENOENT, EACCES, ENOSPC ...  the file cannot be written
///
/// Threads: any. If two calls write to the same Path, the file of the last one remains.
///
/// Example:
///
///     WriteBlackBox(1, "finger-1.jsonl");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WriteBlackBox(i: c_int, Path: *const c_char) -> c_int {
    delegated("WriteBlackBox", MEMORY_OF_CALL, || {
        non_null(Path, "Path", Wanted::FileName)?;
        // SAFETY: `Path` is not null, as checked above. By the contract in the manual, it is a C string.
        let path = PathBuf::from(OsStr::from_bytes(unsafe { CStr::from_ptr(Path) }.to_bytes()));
        Ok(move || {
            let recording = default_hand::with(|hand| hand.recording(i))?;
            // The hand is no longer locked here, so CloseHand never waits for a slow disk.
            Ok(hand::save_recording(&recording, &path)?)
        })
    })
}

/// Converts a record to the struct of the header. [`fill`] sets `Size` when it knows the size of the caller's struct.
fn to_c(KeptRecord { record, oldest, newest }: &KeptRecord) -> FingerRecord {
    let found = record.control.map(|control| control.report).unwrap_or_default();
    let sent = match record.control.map(|control| control.input.activity) {
        Some(Activity::Follow(set_point)) => Some(set_point.joints),
        _ => None,
    };
    FingerRecord {
        Size: 0,
        State: state(&record.stage),
        Cycle: count(record.cycle),
        Oldest: count(*oldest),
        Newest: count(*newest),
        Time: record.began as f64 * 1e-9,
        Answered: record.feedback.is_some().into(),
        StatusBits: record.status.into(),
        Computed: record.control.is_some().into(),
        Follows: sent.is_some().into(),
        Pos: found.joints.into(),
        PosSent: sent.unwrap_or_default().into(),
        Tension: found.tensions.into(),
        TensionSent: found.desired_tensions.into(),
        Torque: record.control.map(|control| control.command.motor_torques).unwrap_or_default().into(),
    }
}

//! The exported functions about black boxes; their comments are the C manual, as in `calls.rs`.

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

/// One cycle of a finger, as the black box keeps it. Set Size = sizeof (struct
/// FingerRecord) before the call: later versions add members at the end.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerRecord {
    /// In: bytes of room, sizeof *Record. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// As FingerStatus.State, at the end of the cycle.
    pub State: c_int,
    /// The cycle, counted from OpenHand; the first is 1.
    pub Cycle: c_ulong,
    /// The first and the last cycle that are kept now: without a gap between them.
    pub Oldest: c_ulong,
    /// See Oldest.
    pub Newest: c_ulong,
    /// When the cycle began, s on the clock CLOCK_MONOTONIC.
    pub Time: f64,
    /// 1: the board's reply came. 0: it was lost.
    pub Answered: c_int,
    /// Status bits of the newest reply (docs/board-protocol.md).
    pub StatusBits: c_int,
    /// 1: the controller ran, and found what follows. 0: the finger was faulted before, or
    /// the simulated one waited; what follows is 0.
    pub Computed: c_int,
    /// 1: a set point is in force, and stands in PosSent. 0: none is, and there are zeros.
    pub Follows: c_int,
    /// Measured joint angles, rad.
    pub Pos: [f64; 3],
    /// The joint angles that the finger is pulled to, rad.
    pub PosSent: [f64; 3],
    /// Measured tendon tensions, N.
    pub Tension: [f64; 4],
    /// Commanded tendon tensions, N.
    pub TensionSent: [f64; 4],
    /// Commanded motor torques, N cm. They leave for the board in the next cycle.
    pub Torque: [f64; 4],
}

/// GetRecord - one cycle of the last two seconds of a finger
///
///     int GetRecord(int i, unsigned long Cycle, struct FingerRecord *Record);
///
///   i        finger, 1 to 3
///   Cycle    which one, Record->Oldest to Record->Newest of a call before; 0: the newest
///   Record   Record->Size is set by the caller, all else is filled in. Written only if the
///            call returns 0
///
/// These numbers are a part of what WriteBlackBox writes into a file. Every cycle adds a
/// record and removes the oldest one. The records of a faulted finger stay as they were at
/// the fault.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Record is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger
///   ENOENT   the cycle is no longer kept, or has not taken place yet
///
/// Threads: any. Never waits for a servo.
///
/// Example, with the younger half of what is kept:
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
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Record, "Record", least, |hand| hand.record(i, cycle).map(|kept| told(&kept))) }
    })
}

/// WriteBlackBox - write the last seconds of a finger into a file
///
///     int WriteBlackBox(int i, const char *Path);
///
///   i       finger, 1 to 3
///   Path    the file, new or to be replaced. Read during the call only
///
/// The library keeps the last two seconds of every finger: feedback, set points, motor
/// commands, timing, state. Of a faulted finger they are the last two before the fault.
/// docs/black-box.md describes the file; `sun2xp replay Path` computes it again. With
/// hand.black_box the library writes such a file by itself whenever a finger faults.
///
/// The file is written beside its place, under a temporary name that begins with ".sun2xp-",
/// and takes its place once it is whole and on the disk. A call that fails leaves an old file
/// as it was. The folder must be writable.
///
/// Takes about 50 ms, and as long as the disk needs for some MB. The servos go on.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Path is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; Path names something other than a regular file, such as a
///            symbolic link, a device or a folder
///   ENOENT, EACCES, ENOSPC ...  the file cannot be written
///
/// Threads: any. Of two calls with the same Path the last one leaves its file.
///
/// Example:
///
///     WriteBlackBox(1, "finger-1.jsonl");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WriteBlackBox(i: c_int, Path: *const c_char) -> c_int {
    delegated("WriteBlackBox", MEMORY_OF_CALL, || {
        non_null(Path, "Path", Wanted::FileName)?;
        // SAFETY: not null, and a C string by the manual's contract.
        let path = PathBuf::from(OsStr::from_bytes(unsafe { CStr::from_ptr(Path) }.to_bytes()));
        Ok(move || {
            let recording = default_hand::with(|hand| hand.recording(i))?;
            // Without the hand: a slow disk must not keep it from being closed.
            Ok(hand::save_recording(&recording, &path)?)
        })
    })
}

fn told(KeptRecord { record, oldest, newest }: &KeptRecord) -> FingerRecord {
    let found = record.control.map(|control| control.report).unwrap_or_default();
    let sent = match record.control.map(|control| control.input.activity) {
        Some(Activity::Follow(set_point)) => Some(set_point.joints),
        _ => None,
    };
    FingerRecord {
        Size: 0, // until the caller's room is known
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

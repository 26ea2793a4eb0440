//! The exported functions for black boxes. Their doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::{MEMORY_OF_CALL, delegated, guarded};
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::non_null;
use crate::capi::refusal::Wanted;
use crate::capi::sized_struct::fill_from;
use crate::capi::status_calls::{count, state};
use crate::control::Activity;
use crate::finger::KeptRecord;
use crate::hand;
use std::ffi::{CStr, OsStr, c_char, c_int, c_ulong};
use std::os::unix::ffi::OsStrExt;
use std::path::PathBuf;

/// Result of sun2xp_record: one cycle of a finger, from the black box.
///
/// The library stores all cycles from the member oldest to the member newest. The controller does not run
/// in a cycle in which the finger faults before the controller's turn, or in which a built-in simulated
/// finger or hardware with in_step does not answer. The member computed is then 0, and so are all members
/// after it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_record {
    /// sizeof (struct sun2xp_record), set before the call.
    pub size: usize,
    /// SUN2XP_STATE_RUNNING to SUN2XP_STATE_CLOSED, at the end of the cycle.
    pub state: c_int,
    /// The cycle, counted from sun2xp_open; the first is 1.
    pub cycle: c_ulong,
    /// First cycle that is stored now.
    pub oldest: c_ulong,
    /// Last cycle that is stored now.
    pub newest: c_ulong,
    /// Start of the cycle on CLOCK_MONOTONIC, s.
    pub time: f64,
    /// 1: the board's reply arrived in this cycle. 0: no reply arrived.
    pub answered: c_int,
    /// Status bits of the newest reply (docs/board-protocol.md).
    pub status_bits: c_int,
    /// 1: the controller ran and computed the members below.
    pub computed: c_int,
    /// 1: position_sent is the set point in force. 0: no set point is in force.
    pub follows: c_int,
    /// Measured joint angles, rad.
    pub position: [f64; 3],
    /// Joint angles of the set point in force, rad. The anchor of the spring moves toward them.
    pub position_sent: [f64; 3],
    /// Measured tendon tensions, N.
    pub tension: [f64; 4],
    /// Commanded tendon tensions, N.
    pub tension_sent: [f64; 4],
    /// Commanded motor torques, N cm, sent in the next cycle.
    pub torque: [f64; 4],
}

/// sun2xp_record - one cycle of the last two seconds of a finger
///
///   finger   1 to 3
///   cycle    a cycle from record->oldest to record->newest of an earlier call; 0: the newest cycle
///   record   result; set record->size before the call
///
/// A record is a part of what sun2xp_write_black_box writes into a file. Every cycle adds a record.
/// Records older than two seconds are removed, several at a time. A faulted finger adds no records, so its
/// records are the last ones before the fault.
/// If hand.black_box is set and a finger recovers right after a fault, its new cycles cannot be read until
/// the library has copied the records of the fault. This takes up to 50 ms.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   record is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger
///   ENOENT   the cycle is no longer stored, or has not taken place yet
///
/// Threads: any. Never waits for a servo.
///
/// Example, which prints the newer half of the records:
///
///     struct sun2xp_record record;
///     unsigned long cycle, last;
///     record.size = sizeof record;
///     if (sun2xp_record(hand, 1, 0, &record) == 0) {
///         last = record.newest;
///         for (cycle = (record.oldest + last) / 2; cycle <= last; cycle++)
///             if (sun2xp_record(hand, 1, cycle, &record) == 0)
///                 printf("%f %f\n", record.time, record.tension[0]);
///     }
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_record(
    hand: *mut sun2xp_hand,
    finger: c_int,
    cycle: c_ulong,
    record: *mut sun2xp_record,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_record", hand, || {
        #[allow(clippy::useless_conversion, reason = "`unsigned long` has 32 bits on some machines")]
        let cycle = (cycle != 0).then_some(u64::from(cycle));
        // SAFETY: by the contract in the manual, `record` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, record, "record", |hand| hand.record(finger, cycle).map(|kept| to_c(&kept))) }
    })
}

/// sun2xp_write_black_box - write the last seconds of a finger into a file
///
///   finger   1 to 3
///   path     the file; an existing file is replaced
///
/// The library stores the last two seconds of every finger: feedback, set points, motor commands, timing
/// and state. For a faulted finger these are the last two seconds before the fault. docs/black-box.md
/// describes the file, and `sun2xp replay path` recomputes its cycles. If hand.black_box is set, the
/// library also writes such a file whenever a finger faults.
///
/// The library writes a temporary file with a name that begins with ".sun2xp-" into the same folder, and
/// renames it when it is complete and on the disk. So the folder must be writable, and a refused call leaves
/// an old file unchanged. There is one exception: after the renaming, the library flushes the folder to the
/// disk. If this flush fails, the call is refused although the new file is in its place.
/// The call takes about 50 ms plus the time that the disk needs for some MB. The servos continue.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   path is null
///   ENODEV   no such hand
///   EINVAL   no such finger; path names something other than a regular file, such as a symbolic link,
///            a device or a folder
///   ENOENT, EACCES, ENOSPC ...  the file cannot be written
///
/// Threads: any. If two calls write to the same path, the file of the last one remains.
///
/// Example:
///
///     sun2xp_write_black_box(hand, 1, "finger-1.jsonl");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_write_black_box(hand: *mut sun2xp_hand, finger: c_int, path: *const c_char) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_write_black_box", hand, MEMORY_OF_CALL, || {
        non_null(path, "path", Wanted::FileName)?;
        // SAFETY: `path` is not null, as checked above. By the contract in the manual, it is a C string.
        let path = PathBuf::from(OsStr::from_bytes(unsafe { CStr::from_ptr(path) }.to_bytes()));
        Ok(move || {
            let recording = hand_table::with(hand, |hand| hand.recording(finger))?;
            // The hand is no longer locked here, so closing never waits for a slow disk.
            Ok(hand::save_recording(&recording, &path)?)
        })
    })
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(KeptRecord { record, oldest, newest }: &KeptRecord) -> sun2xp_record {
    let found = record.control.map(|control| control.report).unwrap_or_default();
    let sent = match record.control.map(|control| control.input.activity) {
        Some(Activity::Follow(set_point)) => Some(set_point.joints),
        _ => None,
    };
    sun2xp_record {
        size: 0,
        state: state(&record.stage),
        cycle: count(record.cycle),
        oldest: count(*oldest),
        newest: count(*newest),
        time: record.began as f64 * 1e-9,
        answered: record.feedback.is_some().into(),
        status_bits: record.status.into(),
        computed: record.control.is_some().into(),
        follows: sent.is_some().into(),
        position: found.joints.into(),
        position_sent: sent.unwrap_or_default().into(),
        tension: found.tensions.into(),
        tension_sent: found.desired_tensions.into(),
        torque: record.control.map(|control| control.command.motor_torques).unwrap_or_default().into(),
    }
}

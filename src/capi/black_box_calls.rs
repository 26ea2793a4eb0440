//! The exported function about black boxes; its comment is the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_snake_case)]

use crate::capi::default_hand;
use crate::capi::refusal::{Refusal, guarded};
use crate::hand;
use std::ffi::{CStr, OsStr, c_char, c_int};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;

/// WriteBlackBox - write the last seconds of a finger into a file
///
///     int WriteBlackBox(int i, const char *Path);
///
///   i       finger, 1 to 3
///   Path    the file, new or to be written over. Read during the call only
///
/// The library keeps the last two seconds of every finger: feedback, set points, motor
/// commands, timing, state. Of a faulted finger they are the last two before the fault.
/// docs/black-box.md describes the file; `sun2xp replay Path` computes it again. With
/// hand.black_box the library writes such a file by itself whenever a finger faults.
///
/// Takes about 50 ms, in which the servos go on.
///
/// Returns 0, or -1 with
///   EFAULT   Path is null
///   EINVAL   no such finger
///   ENODEV   no hand is open
///   EPERM    forked child
///   ENOENT, EACCES, ENOSPC ...  the file cannot be written
///
/// Threads: any, but not two at once with the same Path.
///
///     WriteBlackBox(1, "/tmp/finger-1.jsonl");
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WriteBlackBox(i: c_int, Path: *const c_char) -> c_int {
    guarded("WriteBlackBox", || {
        if Path.is_null() {
            return Err(Refusal::Null("Path"));
        }
        // SAFETY: not null, and a C string by the manual's contract.
        let path = unsafe { CStr::from_ptr(Path) };
        let recording = default_hand::with(|hand| hand.recording(i))?;
        // Without the hand: a slow disk must not keep it from being closed.
        Ok(hand::save(&recording, self::Path::new(OsStr::from_bytes(path.to_bytes())))?)
    })
}

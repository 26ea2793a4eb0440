//! The exported functions for refused calls. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::uncancelled;
use crate::capi::error_numbers::SUN2XP_ERROR_ARGUMENT;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::sized_struct::fill;
use crate::capi::thread_errors::find;
use std::ffi::{c_char, c_int};

/// A refused call (sun2xp_error). The texts are valid until the next refused call of the same thread.
///
/// The member remedy names only calls that open or close a hand, sun2xp_recover, sun2xp_zero and sun2xp_status. It may
/// be empty although another call helps. The member text always contains the whole remedy.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_error {
    /// sizeof (struct sun2xp_error), set before the call.
    pub size: usize,
    /// SUN2XP_ERROR_..., or 0 if no call was refused.
    pub number: c_int,
    /// errno of the refusal.
    pub system_errno: c_int,
    /// Name of the call; never null.
    pub call: *const c_char,
    /// One line with the call, the cause and the remedy; never null.
    pub text: *const c_char,
    /// Calls that help, separated by commas; may be empty; never null.
    pub remedy: *const c_char,
}

/// sun2xp_error - the last refused call of the calling thread
///
///   hand    a hand, open or closed; null: any hand
///   error   result; set error->size before the call
///
/// Every thread has its own refusals. A thread remembers the last refusal of each of the four hands that
/// have refused its calls most recently. Calls without a handle, such as sun2xp_open, and calls with a null
/// handle together count as one hand. sun2xp_error returns their refusal only if hand is null. A call that
/// succeeds does not change the refusals.
///
/// Returns 0, or -SUN2XP_ERROR_ARGUMENT if error is null or error->size is too small. Never sets errno.
///
/// Threads: any. Works in a forked child too.
///
/// Example:
///
///     struct sun2xp_error error;
///     error.size = sizeof error;
///     if (sun2xp_error(hand, &error) == 0 && error.number == SUN2XP_ERROR_FAULTED)
///         fprintf(stderr, "%s\n", error.text);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_error(hand: *const sun2xp_hand, error: *mut sun2xp_error) -> c_int {
    uncancelled(|| {
        // SAFETY: by the contract in the manual, `error` is null or points to as many bytes as its first member gives.
        let filled = unsafe {
            fill(error, "error", || {
                let found = find(Handle::of(hand));
                Ok(sun2xp_error {
                    size: 0,
                    number: found.number,
                    system_errno: found.errno,
                    call: found.call,
                    text: found.text,
                    remedy: found.remedy,
                })
            })
        };
        if filled.is_ok() { 0 } else { -SUN2XP_ERROR_ARGUMENT }
    })
}

/// sun2xp_error_text - the text of the last refused call of the calling thread
///
///   hand   a hand, open or closed; null: any hand
///
/// Returns the text of sun2xp_error, or an empty string if no call was refused. The pointer is never
/// null, and is valid until the next refused call of the same thread.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_error_text(hand: *const sun2xp_hand) -> *const c_char {
    uncancelled(|| find(Handle::of(hand)).text)
}

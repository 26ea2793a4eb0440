//! The exported functions that open and close hands. Their doc comments are the C manual, as in `calls.rs`.

use crate::capi::boundary::{MEMORY_OF_HAND, delegated, delegated_or_done_here, uncancelled};
use crate::capi::hand_events::in_callback;
use crate::capi::hand_table::{self, default_handle};
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::loaded_hand;
use crate::capi::memory::non_null;
use crate::capi::opened_hand::{Source, SourceWithIo};
use crate::capi::refusal::{Refusal, Wanted};
use crate::model::configuration::NamedHand;
use std::ffi::{CStr, c_char, c_int};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// sun2xp_open - open the hand of a configuration file
///
///   path   the file; null: the file that OpenHand finds (docs/configuration.md), or the simulated hand if
///          OpenHand finds none
///   hand   result: the handle of the hand
///
/// Opens the ports, starts the servos and brings the tendons under tension. Returns when every finger has
/// answered and holds its present pose at the configured initial stiffness. Takes at most about a second
/// for a simulated hand. At most 16 hands can be open at once, in addition to the hand of OpenHand.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENOMEM   there is not enough memory
///   EFAULT   hand is null
///   EMFILE   16 hands are open
///   ENOENT, EACCES ...  the configuration file cannot be read; errno of the system
///   EINVAL   the configuration is unusable; sun2xp_error_text names file, line and reason
///   ENOENT, EACCES, EBUSY ...  a port cannot be opened; errno of the system
///   ETIMEDOUT ...  a board does not answer, or the device is not a board. The errno is ENODEV if the board
///            that finger.board names is not found, or is found at several ports
///   EIO      the tendons of a finger do not come under tension in time, the finger faults before that, or
///            the self-test finds wrong wiring (hand.self_test)
///   EPERM, ENOMEM, EINVAL ...  hand.real_time is "enforce", and SCHED_FIFO, locked memory or the
///            configured core is not available
///
/// Threads: any. Several threads may open hands at the same time.
///
/// Example:
///
///     sun2xp_hand *other;
///     if (sun2xp_open(NULL, &other) != 0) {
///         fprintf(stderr, "%s\n", sun2xp_error_text(NULL));
///         exit(1);
///     }
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_open(path: *const c_char, hand: *mut *mut sun2xp_hand) -> c_int {
    // SAFETY: here and below, by the contract in the manual, each pointer is null or points to the data of its
    // description.
    unsafe { open("sun2xp_open", hand, || Ok(Source::at(path))) }
}

/// sun2xp_open_text - open the hand of a configuration in memory
///
///   configuration   the text, as in a configuration file (TOML, UTF-8)
///   hand            result: the handle of the hand
///
/// A finger for which the text names neither a port nor a board is simulated. A text is refused if it
/// leaves one finger simulated in this way and names a real port or board for another finger.
/// Calibration results are in force until the hand is closed, and are not stored.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   configuration or hand is null
///   others   as sun2xp_open
///
/// Threads: any.
///
/// Example, a hand of 500 cycles a second:
///
///     sun2xp_hand *other;
///     sun2xp_open_text("[hand]\nrate = 500\n", &other);
///     sun2xp_close(other);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_open_text(configuration: *const c_char, hand: *mut *mut sun2xp_hand) -> c_int {
    // SAFETY: as above.
    unsafe {
        open("sun2xp_open_text", hand, || {
            non_null(configuration, "configuration", Wanted::Text)?;
            Ok(Source::in_memory(configuration))
        })
    }
}

/// sun2xp_open_named - open a simulated hand by its name
///
///   name   "nominal", "worn", "sheathed" or "cheap": what the simulated tendons, gauges and motors are
///          like (docs/real-tendons.md)
///   hand   result: the handle of the hand
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   name or hand is null
///   EINVAL   no hand has this name
///   others   as sun2xp_open
///
/// Threads: any.
///
/// Example:
///
///     sun2xp_hand *other;
///     sun2xp_open_named("nominal", &other);
///     sun2xp_close(other);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_open_named(name: *const c_char, hand: *mut *mut sun2xp_hand) -> c_int {
    // SAFETY: as above.
    unsafe {
        open("sun2xp_open_named", hand, || {
            non_null(name, "name", Wanted::Text)?;
            let name = CStr::from_ptr(name).to_bytes();
            let named = NamedHand::ALL.into_iter().find(|hand| hand.name().as_bytes() == name);
            let name = named.ok_or(Refusal::NoSuchName)?.name();
            let text = format!("[finger]\nport = \"simulated\"\nsimulation.hand = \"{name}\"\n");
            Ok(Source::Text(text.into_bytes()))
        })
    }
}

/// sun2xp_close - stop a hand
///
/// Brings every finger to the configured end state (hand.end_state) and stops the servos, as CloseHand does.
/// Afterwards the handle does not belong to an open hand. No later hand has the same handle, except on 32-bit
/// machines, where a handle can occur again after 65536 further hands. At exit the library closes all hands
/// that are still open.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand, or another thread is closing it already (the call does not wait for the end)
///   EBUSY    only in an event callback (sun2xp_on_event) of any hand: another thread is just beginning to
///            close this hand, or the process exits
///
/// Threads: any. Waits until the callback of this hand has returned, unless the call was made in an event
/// callback of any hand.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_close(hand: *mut sun2xp_hand) -> c_int {
    let hand = Handle::of(hand);
    delegated_or_done_here("sun2xp_close", hand, || {
        let in_callback = in_callback();
        move || hand_table::close(hand, in_callback)
    })
}

/// sun2xp_default_hand - the hand that OpenHand has opened
///
/// Returns the handle, or null if that hand is not open. CloseHand and sun2xp_close close it.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_default_hand() -> *mut sun2xp_hand {
    uncancelled(|| default_handle().to_c())
}

/// Opens a hand and writes its handle.
///
/// # Safety
/// `out` is null or points to a handle. The pointers that `source` uses are valid.
#[inline(always)]
pub(super) unsafe fn open<S: Into<SourceWithIo>>(
    name: &'static str,
    out: *mut *mut sun2xp_hand,
    source: impl FnOnce() -> Result<S, Refusal>,
) -> c_int {
    uncancelled(|| {
        let opened = Arc::new(AtomicUsize::new(0));
        let result = {
            let opened = opened.clone();
            delegated(name, Handle::NULL, MEMORY_OF_HAND, || {
                non_null(out, "hand", Wanted::Handle)?;
                let source = source()?.into();
                Ok(move || {
                    opened.store(hand_table::open(source, loaded_hand::open)?.value(), Ordering::Relaxed);
                    Ok(())
                })
            })
        };
        if result == 0 {
            // SAFETY: `out` is not null, as checked above, and by the contract of this function it points to a handle.
            unsafe { out.write_unaligned(Handle::from_value(opened.load(Ordering::Relaxed)).to_c()) };
        }
        result
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capi::error_numbers::{SUN2XP_ERROR_CONFIGURATION, SUN2XP_ERROR_TOO_MANY};
    use crate::capi::io_calls::sun2xp_open_io_text;
    use crate::capi::process::errno;
    use std::ptr::{null, null_mut};

    /// The results of the calls that open the hand of a text, and their errnos.
    fn opened(text: &CStr) -> [(c_int, c_int); 2] {
        let mut hand = null_mut();
        // SAFETY: the text is a C string, there is no hardware, and there is room for the handle.
        let plain = unsafe { (sun2xp_open_text(text.as_ptr(), &raw mut hand), errno()) };
        // SAFETY: as above.
        let with_io = unsafe { (sun2xp_open_io_text(text.as_ptr(), 0, null(), &raw mut hand), errno()) };
        assert!(hand.is_null());
        [plain, with_io]
    }

    #[test]
    fn too_many_hands_are_reported_before_a_text_that_is_not_utf_8() {
        let places = hand_table::occupy();
        assert_eq!(opened(c"# \xff\n"), [(-SUN2XP_ERROR_TOO_MANY, libc::EMFILE); 2]);
        drop(places);
        assert_eq!(opened(c"# \xff\n"), [(-SUN2XP_ERROR_CONFIGURATION, libc::EINVAL); 2]);
    }
}

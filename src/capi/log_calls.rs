//! The exported function for messages. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::handle::Handle;
use crate::capi::planners_pointer::PlannersPointer;
use crate::capi::refusal::Refusal;
use crate::capi::text::Text;
use crate::realtime::{NoCancellation, RwLock, Severity, offer_messages_to};
use std::cell::Cell;
use std::ffi::{c_char, c_int, c_void};

/// A call was refused.
pub const SUN2XP_LOG_REFUSAL: c_int = 1;

/// The library continues, but not as the user may expect.
pub const SUN2XP_LOG_WARNING: c_int = 2;

/// A function that receives messages. Its arguments are the severity (SUN2XP_LOG_...), one line of text, and
/// the argument user of sun2xp_set_log.
pub type sun2xp_log = Option<extern "C" fn(severity: c_int, text: *const c_char, user: *mut c_void)>;

type Callback = extern "C" fn(c_int, *const c_char, *mut c_void);

/// The callback in force. It is locked for reading while the callback runs.
static CALLBACK: RwLock<Option<(Callback, PlannersPointer)>> = RwLock::new(None);

thread_local! {
    /// Whether the calling thread is in the callback.
    static IN_CALLBACK: Cell<bool> = const { Cell::new(false) };
}

/// sun2xp_set_log - receive the messages of the library
///
///   callback   function to call with each message; null: messages go to standard error again
///   user       third argument of each call of the function
///
/// If there is a callback, the library calls it with each message, and prints nothing, except while
/// sun2xp_set_log replaces the callback. The library calls it in a thread whose call is refused, and in
/// threads of the library that are not real-time, for example in the one that opens a hand. Of the refusals,
/// only the first of each kind in a process is a message. If hand.print_refusals is false for a hand, the
/// refusals of calls for this hand are no messages. Several threads may call the callback at the same time.
/// The callback must make no calls of the library, and must return. The text is valid only until the
/// callback returns. There is one callback for all hands of the process.
///
/// When sun2xp_set_log has returned, the previous callback is not running and is not called again. A message
/// that comes while sun2xp_set_log waits for the previous callback is printed.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EBUSY    the callback itself makes this call
///
/// Threads: any. Waits until the previous callback has returned.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_set_log(callback: sun2xp_log, user: *mut c_void) -> c_int {
    guarded("sun2xp_set_log", Handle::NULL, || {
        if IN_CALLBACK.get() {
            return Err(Refusal::InLogCallback);
        }
        offer_messages_to(pass_on);
        *CALLBACK.write() = callback.map(|callback| (callback, PlannersPointer(user)));
        Ok(())
    })
}

/// Passes a message to the callback. Returns false if there is no callback, or if the callback is being replaced. Drops
/// a message that the callback itself causes, and returns true.
fn pass_on(severity: Severity, message: &str) -> bool {
    // A callback that writes is a cancellation point. A cancellation must not end the thread inside a call of the
    // library.
    let _whole = NoCancellation::begin();
    // This function must not wait for the lock: in a forked child, nothing releases a lock that another thread of the
    // parent held. While sun2xp_set_log waits for the previous callback, the message is printed instead.
    let Some(callback) = CALLBACK.try_read() else { return false };
    let Some((callback, user)) = &*callback else { return false };
    let mut text = Text::<2048>::EMPTY;
    text.compose(format_args!("{message}"));
    let severity = match severity {
        Severity::Refusal => SUN2XP_LOG_REFUSAL,
        Severity::Warning => SUN2XP_LOG_WARNING,
    };
    if !IN_CALLBACK.replace(true) {
        callback(severity, text.as_c_string(), user.0);
        IN_CALLBACK.set(false);
    }
    true
}

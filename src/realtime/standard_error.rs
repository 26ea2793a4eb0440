//! Messages on standard error, for users whose planners do not check results.
#![allow(unsafe_code, reason = "the raw descriptor of standard error")]

use super::cancellation::NoCancellation;
use super::signals::{SignalsBlocked, is_pending, take_back};
use std::ffi::c_int;
use std::io;
use std::sync::OnceLock;

/// Errors of a write that come with a signal: no process reads the pipe, or the file has reached the size limit of the
/// process.
const RAISING: [(c_int, c_int); 2] = [(libc::EPIPE, libc::SIGPIPE), (libc::EFBIG, libc::SIGXFSZ)];

/// What a message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The library continues, but not as the user may expect.
    Warning,
    /// A call was refused.
    Refusal,
}

/// A function that receives the messages that otherwise go to standard error. It returns false for a message that it
/// does not accept.
pub type MessageReceiver = fn(Severity, &str) -> bool;

static RECEIVER: OnceLock<MessageReceiver> = OnceLock::new();

/// Offers all later messages to `receiver`. If there already is a receiver, that receiver stays.
pub fn offer_messages_to(receiver: MessageReceiver) {
    RECEIVER.get_or_init(|| receiver);
}

/// Passes a message of one line to the receiver. Prints it if there is no receiver or if the receiver does not accept
/// it.
pub fn report(severity: Severity, text: &str) {
    if !RECEIVER.get().is_some_and(|receiver| receiver(severity, text)) {
        print_line(text);
    }
}

/// Writes one line to standard error with a single system call, so that the lines of several threads do not mix.
/// Allocates nothing. The thread is not cancelled during the write.
///
/// If standard error accepts no more data, the line is lost, and the process receives neither SIGPIPE nor SIGXFSZ.
/// `eprintln!` is not used: it would panic in this case, and its lock could stay locked forever in a forked child.
fn print_line(text: &str) {
    let parts = ["sun2xp: ", text, "\n"]
        .map(|part| libc::iovec { iov_base: part.as_ptr().cast_mut().cast(), iov_len: part.len() });
    let _whole = NoCancellation::begin();
    let _blocked = SignalsBlocked::these(&RAISING.map(|(_, signal)| signal));
    let planners = RAISING.map(|(_, signal)| is_pending(signal));
    // SAFETY: each part points to a live string of its length. A short or failed write cannot be repaired.
    let written = unsafe { libc::writev(libc::STDERR_FILENO, parts.as_ptr(), parts.len() as c_int) };
    let error = if written < 0 { io::Error::last_os_error().raw_os_error() } else { None };
    for ((raising, signal), planners) in RAISING.into_iter().zip(planners) {
        if error == Some(raising) && !planners {
            // This write raised the signal; it was not pending before.
            take_back(signal);
        }
    }
}

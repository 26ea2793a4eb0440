//! Lines on standard error, for people who do not look at results.
#![allow(unsafe_code, reason = "the raw descriptor of standard error")]

use super::cancellation::NoCancellation;
use super::signals::{SignalsBlocked, is_pending, take_back};
use std::io;

/// Writes one line on standard error, at once, so that the lines of several threads do not mix.
///
/// Where nobody reads standard error the line is lost, and the process gets no SIGPIPE. `eprintln!` would panic there, and its lock
/// would be taken for ever in a forked child. The thread is not cancelled meanwhile.
pub fn print_line(text: &str) {
    let line = format!("sun2xp: {text}\n");
    let _whole = NoCancellation::begin();
    let _blocked = SignalsBlocked::one(libc::SIGPIPE);
    let planners = is_pending(libc::SIGPIPE);
    // SAFETY: the pointer and the length are those of a live string. A short or failed write has no remedy.
    let written = unsafe { libc::write(libc::STDERR_FILENO, line.as_ptr().cast(), line.len()) };
    if written < 0 && io::Error::last_os_error().raw_os_error() == Some(libc::EPIPE) && !planners {
        // This write has raised it.
        take_back(libc::SIGPIPE);
    }
}

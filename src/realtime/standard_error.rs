//! Lines on standard error, for people who do not look at results.
#![allow(unsafe_code, reason = "the raw descriptor of standard error")]

use super::cancellation::NoCancellation;
use super::signals::{SignalsBlocked, is_pending, take_back};
use std::ffi::c_int;
use std::io;

/// The errors with which a write raises a signal: nobody reads the pipe, or the file is as large as the process may
/// make it.
const RAISING: [(c_int, c_int); 2] = [(libc::EPIPE, libc::SIGPIPE), (libc::EFBIG, libc::SIGXFSZ)];

/// Writes one line on standard error, at once, so that the lines of several threads do not mix. Allocates nothing.
///
/// Where standard error takes no more the line is lost, and the process gets neither SIGPIPE nor SIGXFSZ. `eprintln!`
/// would panic there, and its lock would be taken for ever in a forked child. The thread is not cancelled meanwhile.
pub fn print_line(text: &str) {
    let parts = ["sun2xp: ", text, "\n"]
        .map(|part| libc::iovec { iov_base: part.as_ptr().cast_mut().cast(), iov_len: part.len() });
    let _whole = NoCancellation::begin();
    let _blocked = SignalsBlocked::these(&RAISING.map(|(_, signal)| signal));
    let planners = RAISING.map(|(_, signal)| is_pending(signal));
    // SAFETY: each part points to a live string of its length. A short or failed write has no remedy.
    let written = unsafe { libc::writev(libc::STDERR_FILENO, parts.as_ptr(), parts.len() as c_int) };
    let error = if written < 0 { io::Error::last_os_error().raw_os_error() } else { None };
    for ((raising, signal), planners) in RAISING.into_iter().zip(planners) {
        if error == Some(raising) && !planners {
            // This write has raised it.
            take_back(signal);
        }
    }
}

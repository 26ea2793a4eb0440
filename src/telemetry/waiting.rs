//! Waiting for a message, for the end of a connection, or for the end of a process.
#![allow(unsafe_code, reason = "a system call")]

use super::process::Process;
use super::socket::Socket;
use std::time::Duration;

/// Waits until the socket can be read, the process has ended, or the time has passed. May return early.
pub(super) fn wait(socket: &Socket, process: Option<&Process>, timeout: Duration) {
    let entry = |fd| libc::pollfd { fd, events: libc::POLLIN, revents: 0 };
    // The system ignores entries with a negative number. If other code has closed the socket, the next read reports it.
    let mut polled = [entry(socket.number().unwrap_or(-1)), entry(process.map_or(-1, Process::number))];
    let milliseconds = libc::c_int::try_from(timeout.as_micros().div_ceil(1000)).unwrap_or(libc::c_int::MAX);
    // SAFETY: `polled` has this number of entries. The results are not used, because the caller reads the socket.
    unsafe { libc::poll(polled.as_mut_ptr(), polled.len() as libc::nfds_t, milliseconds) };
}

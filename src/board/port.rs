//! A serial port for a servo.
//!
//! The port is read and written through its raw descriptor. The servo thread blocks all signals, and no wait here
//! unblocks one, so no signal handler of a planner runs on this thread. No read or write allocates memory or waits past
//! its deadline. Every read, write and flush of an open port first checks the descriptor: if another part of the
//! program has closed it, its number may now belong to a file of the planner. The wait for input begins without this
//! check, because it changes no file.
#![allow(unsafe_code, reason = "the raw descriptor of the port")]

mod input;
mod opening;

use super::descriptor::Descriptor;
use super::port_error::PortError;
use super::transport::Transport;
use crate::realtime;
use input::{Event, Input};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// An open serial port: exclusive, raw, eight data bits, no parity, one stop bit, no flow control.
#[derive(Debug)]
pub struct Port {
    descriptor: Descriptor,
    input: Input,
    /// Whether there may be something to read: an event has arrived whose bytes may not all be read yet, or the port
    /// has hung up. [`Input`] returns an event only once, so a wait would not end for bytes that are left.
    unread: bool,
    hung_up: bool,
    path: PathBuf,
    /// When the port last became readable, ns.
    ready_at: u64,
    /// The process that opened the port. A forked child inherits this `Port` and the open file.
    process: u32,
    /// Whether this `Port` has locked the serial port. If it has not, another program may be using the port.
    locked: bool,
}

impl Port {
    /// Returns the path that was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the latency timer of an FTDI bridge, ms, or `None` if the port has none. A value above 1 delays
    /// replies by up to this time.
    pub fn latency_timer_ms(&self) -> Option<u32> {
        // Ports are often opened through a link in /dev/serial/by-id.
        let device = std::fs::canonicalize(&self.path).ok()?;
        let name = device.file_name()?.to_str()?;
        let text = std::fs::read_to_string(format!("/sys/class/tty/{name}/device/latency_timer")).ok()?;
        text.trim().parse().ok()
    }

    /// Checks that the descriptor still refers to the port. This check comes directly before every read, write and
    /// flush. It takes 0.25 us.
    fn check_own(&self) -> Result<(), PortError> {
        if self.descriptor.is_own() { Ok(()) } else { Err(PortError::Closed) }
    }

    /// Waits until a read may return bytes, or may find that the port has vanished. Returns false at the deadline.
    fn wait_for_input(&mut self, deadline: u64) -> Result<bool, PortError> {
        while !self.unread {
            let left = Duration::from_nanos(deadline.saturating_sub(realtime::now()));
            match self.input.wait(left) {
                Ok(Some(event)) => {
                    self.ready_at = realtime::now();
                    (self.unread, self.hung_up) = (true, event == Event::HangUp);
                }
                Ok(None) if realtime::now() >= deadline => return Ok(false),
                Ok(None) => {}
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error.into()),
            }
        }
        self.check_own().map(|()| true)
    }
}

impl Transport for Port {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.check_own()?;
        loop {
            // SAFETY: `bytes` is readable for its length.
            let sent = unsafe { libc::write(self.descriptor.number(), bytes.as_ptr().cast(), bytes.len()) };
            if sent >= 0 {
                return Ok(sent as usize);
            }
            match self.descriptor.error() {
                error if error.kind() == io::ErrorKind::Interrupted => {}
                error if error.kind() == io::ErrorKind::WouldBlock => return Ok(0),
                error => return Err(error.into()),
            }
        }
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        while self.wait_for_input(deadline)? {
            // SAFETY: `buffer` is writable for its length.
            let taken = unsafe { libc::read(self.descriptor.number(), buffer.as_mut_ptr().cast(), buffer.len()) };
            match usize::try_from(taken) {
                Ok(0) => return Err(PortError::Vanished),
                Ok(taken) => {
                    self.unread = self.hung_up || taken == buffer.len();
                    return Ok(taken);
                }
                Err(_) => match self.descriptor.error() {
                    error if error.kind() == io::ErrorKind::Interrupted => {}
                    error if error.kind() == io::ErrorKind::WouldBlock && !self.hung_up => self.unread = false,
                    error if error.kind() == io::ErrorKind::WouldBlock => return Err(PortError::Vanished),
                    error => return Err(error.into()),
                },
            }
        }
        Ok(0)
    }

    fn ready_at(&self) -> u64 {
        self.ready_at
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.check_own()?;
        // SAFETY: the call takes no pointer.
        match unsafe { libc::tcflush(self.descriptor.number(), libc::TCIFLUSH) } {
            0 => Ok(()),
            _ => Err(self.descriptor.error().into()),
        }
    }

    fn now(&self) -> u64 {
        realtime::now()
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        if self.locked && self.process == std::process::id() && self.descriptor.is_own() {
            // Closing a UART waits up to 30 s for bytes that cannot leave. These bytes are discarded, because all
            // requests that matter have been answered before. The mark of exclusive use is removed, because it would
            // otherwise remain while another process has the port open. The lock is released, because it would
            // otherwise remain while a forked child runs.
            // SAFETY: no call takes a pointer.
            unsafe {
                libc::tcflush(self.descriptor.number(), libc::TCOFLUSH);
                libc::ioctl(self.descriptor.number(), libc::TIOCNXCL);
                libc::flock(self.descriptor.number(), libc::LOCK_UN);
            }
        }
    }
}

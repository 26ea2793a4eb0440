//! Sends single bytes through a pseudo-terminal, and measures how long the kernel takes to carry them.

use serialport::{SerialPort, TTYPort};
use std::io::{ErrorKind, Read, Write};
use std::os::fd::AsRawFd;
use std::time::{Duration, Instant};

/// A pseudo-terminal that carries one byte at a time.
///
/// A worker of the kernel carries the byte. The kernel's accounts of this worker do not show the whole delay: the byte
/// can also wait until a worker is free, and the host of a virtual machine can stop the core of the worker.
pub struct CarriedByte {
    near: TTYPort,
    far: TTYPort,
    /// Whether a byte was sent and has not arrived.
    underway: bool,
}

impl CarriedByte {
    pub fn new(near: TTYPort, far: TTYPort) -> Self {
        Self { near, far, underway: false }
    }

    /// Opens a pseudo-terminal, or returns `None` if the process can open no more descriptors.
    ///
    /// The terminal is locked, so that nobody else can open it. Otherwise a hand that waits for its unplugged board
    /// could find this terminal at the path of the board and read the byte, because a new pseudo-terminal gets the
    /// number of one that was closed before.
    pub fn open() -> Option<Self> {
        let (near, far) = TTYPort::pair().ok()?;
        let locked: libc::c_int = 1;
        // SAFETY: both descriptors are open. TIOCSPTLCK reads an integer, which outlives the call.
        let results = unsafe {
            [
                libc::ioctl(near.as_raw_fd(), libc::TIOCSPTLCK, &raw const locked),
                // Somebody may have opened the terminal before it was locked. If somebody else reads the byte, `delay`
                // must not block.
                libc::fcntl(far.as_raw_fd(), libc::F_SETFL, libc::O_NONBLOCK),
            ]
        };
        (results == [0, 0]).then(|| Self::new(near, far))
    }

    /// Path of the terminal's file.
    pub fn path(&self) -> Option<String> {
        self.far.name()
    }

    /// Sends a byte unless one is underway, and waits for at most `longest` until the byte arrives. Returns the
    /// duration of this wait, or zero if the byte could not be sent.
    pub fn delay(&mut self, longest: Duration) -> Duration {
        if !self.underway && self.near.write_all(&[0]).is_err() {
            return Duration::ZERO;
        }
        let begun = Instant::now();
        self.underway = match self.far.set_timeout(longest).and_then(|()| Ok(self.far.read_exact(&mut [0])?)) {
            Ok(()) => false,
            Err(error) => std::io::Error::from(error).kind() == ErrorKind::TimedOut,
        };
        begun.elapsed()
    }
}

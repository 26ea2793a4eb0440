//! Sends single bytes through a pseudo-terminal, and measures how long the kernel takes to carry them.

use serialport::{SerialPort, TTYPort};
use std::io::{ErrorKind, Read, Write};
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
    pub fn open() -> Option<Self> {
        TTYPort::pair().ok().map(|(near, far)| Self::new(near, far))
    }

    /// Sends a byte unless one is underway, and waits for it for at most `longest`. Returns for how long it was
    /// underway.
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

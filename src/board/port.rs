//! A serial port for a servo: opened, configured and locked with `serialport`, then read and written on its raw descriptor.
//!
//! `serialport`'s own read and write do not serve here: they wait with an empty signal mask, so that a planner's signal
//! handlers would run on the servo thread; a read that times out allocates; a write may block long past its timeout.
#![allow(unsafe_code, reason = "the raw descriptor of the port")]

use super::transport::Transport;
use crate::realtime;
use serialport::{ClearBuffer, SerialPort, TTYPort};
use std::io;
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What is wrong with a port.
#[derive(Debug, Error)]
pub enum PortError {
    /// ENOENT.
    #[error("{0} does not exist: check the cable, the board's power and the configured port (ls -l /dev/serial/by-id)")]
    Missing(PathBuf),
    /// EACCES.
    #[error("no permission to open {0}: add the user to the port's group (usually dialout) and log in again")]
    Forbidden(PathBuf),
    /// EBUSY.
    #[error("{0} is in use by another program: close it (fuser -v {0} names it), or configure another port")]
    Busy(PathBuf),
    /// ENOTTY.
    #[error("{0} is not a serial port: check the configured port")]
    NotASerialPort(PathBuf),
    /// EINVAL.
    #[error("{path} cannot run at {wanted} baud, it offers {offered}: configure a rate that the adapter has")]
    Baud {
        /// The port.
        path: PathBuf,
        /// As configured, bits a second.
        wanted: u32,
        /// What the driver chose, bits a second.
        offered: u32,
    },
    /// What opening or setting up the port said beyond these.
    #[error("cannot set up {path}: {text}")]
    SetUp {
        /// The port.
        path: PathBuf,
        /// What the system says.
        text: String,
    },
    /// EIO: hang-up.
    #[error("the port has vanished: the cable was pulled, the adapter lost its power, or the simulated board ended")]
    Vanished,
    /// A read or write failed.
    #[error("reading or writing the port failed: {0}")]
    Failed(io::Error),
}

impl PortError {
    /// The nearest errno.
    pub fn errno(&self) -> i32 {
        match self {
            PortError::Missing(_) => libc::ENOENT,
            PortError::Forbidden(_) => libc::EACCES,
            PortError::Busy(_) => libc::EBUSY,
            PortError::NotASerialPort(_) => libc::ENOTTY,
            PortError::Baud { .. } => libc::EINVAL,
            PortError::SetUp { .. } | PortError::Vanished => libc::EIO,
            PortError::Failed(error) => error.raw_os_error().unwrap_or(libc::EIO),
        }
    }
}

/// An open serial port: exclusive, raw, eight data bits, no parity, one stop bit, no flow control.
#[derive(Debug)]
pub struct Port {
    // Owns the descriptor, and with it the locks (TIOCEXCL and flock; root passes the first, but not the second).
    tty: TTYPort,
    path: PathBuf,
    /// When there was last something to read, ns.
    ready_at: u64,
}

impl Port {
    /// Opens, locks and configures the port at `path` for `baud` bits a second, and throws away what had come in.
    pub fn open(path: &Path, baud: u32) -> Result<Self, PortError> {
        let tty = serialport::new(path.to_string_lossy(), baud)
            .exclusive(true)
            .open_native()
            .map_err(|error| opening_failed(path, &error))?;
        let port = Self { tty, path: path.to_owned(), ready_at: 0 };
        let set_up = |text: String| PortError::SetUp { path: path.to_owned(), text };
        let offered = port.tty.baud_rate().map_err(|error| set_up(error.to_string()))?;
        // A UART tolerates 3 %; a driver that cannot do the rate at all offers something quite different.
        if offered.abs_diff(baud) > baud / 33 {
            return Err(PortError::Baud { path: path.to_owned(), wanted: baud, offered });
        }
        port.keep_board_powered_at_close().map_err(|error| set_up(error.to_string()))?;
        port.set_non_blocking().map_err(|error| set_up(error.to_string()))?;
        port.ask_for_low_latency();
        port.tty.clear(ClearBuffer::Input).map_err(|error| set_up(error.to_string()))?;
        Ok(port)
    }

    /// Where it was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The latency timer of an FTDI bridge, ms; None where the port has none. Above 1 every reply waits for it.
    pub fn latency_timer_ms(&self) -> Option<u32> {
        // Ports are often opened through a link in /dev/serial/by-id.
        let device = std::fs::canonicalize(&self.path).ok()?;
        let name = device.file_name()?.to_str()?;
        let text = std::fs::read_to_string(format!("/sys/class/tty/{name}/device/latency_timer")).ok()?;
        text.trim().parse().ok()
    }

    fn descriptor(&self) -> RawFd {
        self.tty.as_raw_fd()
    }

    /// Without HUPCL: with it, closing the port drops DTR, which resets many boards before they reach their end state.
    fn keep_board_powered_at_close(&self) -> io::Result<()> {
        // SAFETY: all zeros is a valid termios, which tcgetattr fills in before it is used.
        let mut settings: libc::termios2 = unsafe { std::mem::zeroed() };
        // SAFETY: the descriptor is open and `settings` is a termios2, as TCGETS2 and TCSETS2 want. They, rather than
        // tcgetattr and tcsetattr, because those do not keep an unusual baud rate.
        check(unsafe { libc::ioctl(self.descriptor(), libc::TCGETS2, &mut settings) })?;
        settings.c_cflag &= !libc::HUPCL;
        // SAFETY: as above.
        check(unsafe { libc::ioctl(self.descriptor(), libc::TCSETS2, &settings) })?;
        Ok(())
    }

    fn set_non_blocking(&self) -> io::Result<()> {
        // SAFETY: the descriptor is open; these commands take and return integers.
        let flags = check(unsafe { libc::fcntl(self.descriptor(), libc::F_GETFL) })?;
        // SAFETY: as above.
        check(unsafe { libc::fcntl(self.descriptor(), libc::F_SETFL, flags | libc::O_NONBLOCK) })?;
        Ok(())
    }

    /// FTDI bridges keep bytes back for 16 ms unless asked not to. Drivers that do not know the request refuse it, and need
    /// not know it; so failure is no error here, and [`Port::latency_timer_ms`] tells what became of it.
    fn ask_for_low_latency(&self) {
        let mut serial = SerialStruct([0; SERIAL_STRUCT_WORDS]);
        // SAFETY: the descriptor is open, and `serial` is at least as large and as aligned as the kernel's serial_struct.
        let known = unsafe { libc::ioctl(self.descriptor(), libc::TIOCGSERIAL, &mut serial) } == 0;
        if known {
            serial.0[SERIAL_STRUCT_FLAGS] |= ASYNC_LOW_LATENCY;
            // SAFETY: as above.
            unsafe { libc::ioctl(self.descriptor(), libc::TIOCSSERIAL, &serial) };
        }
    }

    /// Waits with the signal mask as it is. False at the deadline.
    fn wait_for_input(&mut self, deadline: u64) -> Result<bool, PortError> {
        loop {
            let left = deadline.saturating_sub(realtime::now());
            let timeout = libc::timespec {
                tv_sec: (left / 1_000_000_000) as libc::time_t,
                tv_nsec: (left % 1_000_000_000) as libc::c_long,
            };
            let mut poll = libc::pollfd { fd: self.descriptor(), events: libc::POLLIN, revents: 0 };
            // SAFETY: one pollfd and a timespec, both alive; a null mask leaves the signal mask alone.
            let ready = unsafe { libc::ppoll(&mut poll, 1, &timeout, std::ptr::null()) };
            match ready {
                0 => return Ok(false),
                // Hang-up is reported beside the last bytes; the read after them meets it again.
                1 if poll.revents & libc::POLLIN != 0 => {
                    self.ready_at = realtime::now();
                    return Ok(true);
                }
                1 => return Err(PortError::Vanished),
                _ => match io::Error::last_os_error() {
                    error if error.kind() == io::ErrorKind::Interrupted => {}
                    error => return Err(PortError::Failed(error)),
                },
            }
        }
    }
}

impl Transport for Port {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        loop {
            // SAFETY: the descriptor is open and `bytes` is readable for its length.
            let sent = unsafe { libc::write(self.descriptor(), bytes.as_ptr().cast(), bytes.len()) };
            if sent >= 0 {
                return Ok(sent as usize);
            }
            match io::Error::last_os_error() {
                error if error.kind() == io::ErrorKind::Interrupted => {}
                error if error.kind() == io::ErrorKind::WouldBlock => return Ok(0),
                error => return Err(failed(error)),
            }
        }
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        while self.wait_for_input(deadline)? {
            // SAFETY: the descriptor is open and `buffer` is writable for its length.
            let taken = unsafe { libc::read(self.descriptor(), buffer.as_mut_ptr().cast(), buffer.len()) };
            match taken {
                0 => return Err(PortError::Vanished),
                1.. => return Ok(taken as usize),
                _ => match io::Error::last_os_error() {
                    // A driver that announces bytes and has none must not hold anybody past the deadline.
                    error if matches!(error.kind(), io::ErrorKind::Interrupted | io::ErrorKind::WouldBlock) => {
                        if realtime::now() >= deadline {
                            break;
                        }
                    }
                    error => return Err(failed(error)),
                },
            }
        }
        Ok(0)
    }

    fn ready_at(&self) -> u64 {
        self.ready_at
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        // SAFETY: the descriptor is open.
        check(unsafe { libc::tcflush(self.descriptor(), libc::TCIFLUSH) }).map(|_| ()).map_err(failed)
    }

    fn now(&self) -> u64 {
        realtime::now()
    }
}

impl Drop for Port {
    fn drop(&mut self) {
        // Closing a UART waits up to 30 s for bytes that cannot leave. What mattered was answered long ago.
        // SAFETY: the descriptor is open until `tty` is dropped, after this.
        unsafe { libc::tcflush(self.descriptor(), libc::TCOFLUSH) };
    }
}

/// The kernel's `struct serial_struct`, of which only `flags` matters here: the fifth int (after type, line, port and irq).
/// 72 bytes on 64-bit machines; the rest is room.
#[repr(C, align(8))]
struct SerialStruct([libc::c_int; SERIAL_STRUCT_WORDS]);

const SERIAL_STRUCT_WORDS: usize = 32;
const SERIAL_STRUCT_FLAGS: usize = 4;
const ASYNC_LOW_LATENCY: libc::c_int = 1 << 13;

fn check(result: libc::c_int) -> io::Result<libc::c_int> {
    if result < 0 { Err(io::Error::last_os_error()) } else { Ok(result) }
}

fn failed(error: io::Error) -> PortError {
    // EIO and ENXIO are what a vanished adapter answers, according to its driver.
    match error.raw_os_error() {
        Some(libc::EIO | libc::ENXIO | libc::ENODEV) => PortError::Vanished,
        _ => PortError::Failed(error),
    }
}

/// `serialport` keeps only part of what the system said, so the file is looked at again.
fn opening_failed(path: &Path, error: &serialport::Error) -> PortError {
    use serialport::ErrorKind;
    let path = path.to_owned();
    match error.kind {
        ErrorKind::Io(io::ErrorKind::NotFound) => PortError::Missing(path),
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => PortError::Forbidden(path),
        ErrorKind::NoDevice => PortError::Busy(path),
        _ => match std::fs::metadata(&path) {
            Err(_) => PortError::Missing(path),
            Ok(file) if !file.file_type().is_char_device() => PortError::NotASerialPort(path),
            Ok(_) if error.description.contains("typewriter") || error.description.contains("ioctl") => {
                PortError::NotASerialPort(path)
            }
            Ok(_) => PortError::SetUp { path, text: error.description.clone() },
        },
    }
}

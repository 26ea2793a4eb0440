//! A pseudo-terminal, which is the port of a simulated board.
#![allow(unsafe_code, reason = "raw descriptors")]

use crate::board::descriptor::{Descriptor, check};
use crate::model::configuration::FINGERS;
use std::ffi::CStr;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::sleep;
use std::time::Duration;

/// Both ends of a pseudo-terminal. The host's end is also open here. If it were closed, every hang-up of a host would
/// cause read errors at the board's end.
#[derive(Debug)]
pub(super) struct PseudoTerminal {
    board_end: Descriptor,
    host_end: Descriptor,
    path: PathBuf,
}

/// Another part of the program has closed a descriptor of the pseudo-terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Closed;

impl PseudoTerminal {
    pub fn open() -> io::Result<Self> {
        const FLAGS: libc::c_int = libc::O_RDWR | libc::O_NOCTTY | libc::O_CLOEXEC;
        // SAFETY: the call takes only an integer.
        let board_end = Descriptor::opened(unsafe { libc::posix_openpt(FLAGS) })?;
        // SAFETY: both calls take only the descriptor.
        check(unsafe { libc::grantpt(board_end.number()) })?;
        // SAFETY: as above.
        check(unsafe { libc::unlockpt(board_end.number()) })?;
        let mut name = [0u8; 64];
        // SAFETY: `name` is writable for the given length.
        match unsafe { libc::ptsname_r(board_end.number(), name.as_mut_ptr().cast(), name.len()) } {
            0 => {}
            error => return Err(io::Error::from_raw_os_error(error)),
        }
        let name = CStr::from_bytes_until_nul(&name).map_err(io::Error::other)?;
        // SAFETY: `name` is a C string.
        let host_end = Descriptor::opened(unsafe { libc::open(name.as_ptr(), FLAGS) })?;
        // The terminal must be raw before a host knows its path. A terminal that is not raw echoes what it receives,
        // and removes some byte values.
        make_raw(&host_end)?;
        // SAFETY: the command takes an integer.
        check(unsafe { libc::fcntl(board_end.number(), libc::F_SETFL, libc::O_RDWR | libc::O_NONBLOCK) })?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        Ok(Self { board_end, host_end, path })
    }

    /// Returns the path of the host's end.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Waits for bytes, at most for `timeout`, and reads what has arrived. Returns 0 only after the whole `timeout`. If
    /// the read fails, sleeps for `timeout` and then returns 0.
    ///
    /// # Errors
    /// Returns [`Closed`] if another part of the program has closed a descriptor.
    pub fn read(&self, buffer: &mut [u8], timeout: Duration) -> Result<usize, Closed> {
        let mut poll = libc::pollfd { fd: self.board_end.number(), events: libc::POLLIN, revents: 0 };
        // SAFETY: the pollfd lives during the call.
        let ready = unsafe { libc::poll(&mut poll, 1, timeout.as_millis() as libc::c_int) };
        if !self.board_end.is_own() {
            return Err(Closed);
        }
        if ready == 0 {
            return Ok(0);
        }
        // SAFETY: `buffer` is writable for its length.
        let taken = unsafe { libc::read(self.board_end.number(), buffer.as_mut_ptr().cast(), buffer.len()) };
        if taken > 0 {
            return Ok(taken as usize);
        }
        // Without the host's end the system reports a hang-up at once, at every call.
        if !self.host_end.is_own() {
            return Err(Closed);
        }
        sleep(timeout);
        Ok(0)
    }

    /// Waits at most for `timeout` until one of these terminals has bytes or has failed. Returns false if the time has
    /// passed without either.
    pub fn wait_for_any(terminals: &[Option<Arc<Self>>; FINGERS], timeout: Duration) -> bool {
        // `ppoll` ignores descriptors with negative numbers.
        let number = |terminal: &Option<Arc<Self>>| terminal.as_ref().map_or(-1, |own| own.board_end.number());
        let mut polled = terminals.each_ref().map(|terminal| libc::pollfd {
            fd: number(terminal),
            events: libc::POLLIN,
            revents: 0,
        });
        let limit =
            libc::timespec { tv_sec: timeout.as_secs() as libc::time_t, tv_nsec: timeout.subsec_nanos().into() };
        // SAFETY: the pollfds and the time limit live during the call, and the mask of signals may be null.
        let ready = unsafe { libc::ppoll(polled.as_mut_ptr(), FINGERS as libc::nfds_t, &limit, std::ptr::null()) };
        if ready < 0 {
            sleep(timeout);
        }
        ready > 0
    }

    /// Sends bytes without waiting, as a UART does. Bytes are lost if the buffer of the terminal is full, because the
    /// host does not read.
    pub fn write(&self, bytes: &[u8]) {
        if self.board_end.is_own() {
            // SAFETY: `bytes` is readable for its length.
            unsafe { libc::write(self.board_end.number(), bytes.as_ptr().cast(), bytes.len()) };
        }
    }

    /// Removes what a dead host has left: the mark of exclusive use, and answers that the host did not read. Both
    /// outlive the host, because the host's end is also open here.
    pub fn forget_last_host(&self) {
        if self.host_end.is_own() {
            // SAFETY: neither request takes a pointer.
            unsafe {
                libc::ioctl(self.host_end.number(), libc::TIOCNXCL);
                libc::tcflush(self.host_end.number(), libc::TCIFLUSH);
            }
        }
    }
}

fn make_raw(terminal: &Descriptor) -> io::Result<()> {
    // SAFETY: all zeros is a valid termios; tcgetattr fills it in before it is used.
    let mut settings: libc::termios = unsafe { std::mem::zeroed() };
    // SAFETY: the descriptor is open, and `settings` is a termios.
    check(unsafe { libc::tcgetattr(terminal.number(), &mut settings) })?;
    // SAFETY: as above.
    unsafe { libc::cfmakeraw(&mut settings) };
    // SAFETY: as above.
    check(unsafe { libc::tcsetattr(terminal.number(), libc::TCSANOW, &settings) })?;
    Ok(())
}

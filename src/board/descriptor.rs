//! Descriptors that other parts of the program may close although they are not theirs.
//!
//! A program that makes itself a daemon closes every number from 3 to 255, or to its limit. The system then gives
//! these numbers to the next files that the program opens. A servo that kept on writing would write its commands into
//! them.
#![allow(unsafe_code, reason = "raw descriptors")]

use std::io;
use std::os::fd::{AsRawFd, FromRawFd, IntoRawFd, OwnedFd, RawFd};

/// Above the numbers that such programs close by habit, and above those that a program without very many files ever
/// gets.
const LOWEST: RawFd = 512;

/// The part of the descriptors that the process may have which stays below ours, where it may have few.
const BELOW: (libc::rlim_t, libc::rlim_t) = (3, 4);

// The same numbers on every Linux.
const F_SETSIG: libc::c_int = 10;
const F_GETSIG: libc::c_int = 11;

/// Marks a file that was opened here: the signal that would announce input, were that asked for, which it never is.
/// Nobody else has a reason to choose this one. Unlike device and inode, it tells a pseudo-terminal from the next one
/// of the same number, and all controlling ends from each other, which are all /dev/ptmx; and it costs half as much
/// to look at.
const MARK: libc::c_int = libc::SIGPWR;

/// An open descriptor that is looked at before it is used.
#[derive(Debug)]
pub(crate) struct Descriptor {
    number: RawFd,
}

impl Descriptor {
    /// Takes the result of a call that opens a file, or returns a negative number and sets errno; marks the file and
    /// moves it to a high number.
    ///
    /// # Errors
    /// What the system reports.
    pub fn opened(result: RawFd) -> io::Result<Self> {
        check(result)?;
        // SAFETY: the call has just made the descriptor, and nobody else knows it.
        let low = unsafe { OwnedFd::from_raw_fd(result) };
        // SAFETY: an open descriptor; the command takes an integer.
        check(unsafe { libc::fcntl(low.as_raw_fd(), F_SETSIG, MARK) })?;
        // SAFETY: as above.
        let high = unsafe { libc::fcntl(low.as_raw_fd(), libc::F_DUPFD_CLOEXEC, lowest()) };
        // Where no high number is free a low one serves too.
        Ok(Self { number: if high < 0 { low.into_raw_fd() } else { high } })
    }

    /// The number. To be used only where [`Descriptor::is_own`] has just been true.
    pub fn number(&self) -> RawFd {
        self.number
    }

    /// Whether the number still means the file that was opened here.
    pub fn is_own(&self) -> bool {
        // SAFETY: the command takes and changes nothing; any number may be asked about.
        unsafe { libc::fcntl(self.number, F_GETSIG) == MARK }
    }

    /// What an error of this descriptor means: EBADF where somebody else has closed it.
    pub fn error(&self) -> io::Error {
        let error = io::Error::last_os_error();
        if self.is_own() { error } else { io::Error::from_raw_os_error(libc::EBADF) }
    }
}

impl Drop for Descriptor {
    fn drop(&mut self) {
        if self.is_own() {
            // SAFETY: the number means the file that was opened here, and nobody uses it after this.
            unsafe { libc::close(self.number) };
        }
    }
}

/// The least number for a descriptor of ours.
fn lowest() -> RawFd {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: `limit` is writable. Should the call fail, the lowest number is 0.
    unsafe { libc::getrlimit(libc::RLIMIT_NOFILE, &mut limit) };
    // The soft limit of very many systems is 1024.
    RawFd::try_from(limit.rlim_cur / BELOW.1 * BELOW.0).map_or(LOWEST, |below| below.min(LOWEST))
}

/// The result of a system call, or what errno says.
pub(crate) fn check(result: libc::c_int) -> io::Result<libc::c_int> {
    if result < 0 { Err(io::Error::last_os_error()) } else { Ok(result) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;

    fn open() -> Descriptor {
        // SAFETY: a constant path.
        Descriptor::opened(unsafe { libc::open(c"/dev/null".as_ptr(), libc::O_RDWR | libc::O_CLOEXEC) }).expect("open")
    }

    #[test]
    fn it_has_a_high_number_and_closes_at_exec() {
        let descriptor = open();
        assert!(descriptor.number() >= 256 && descriptor.is_own(), "{descriptor:?}");
        // SAFETY: an open descriptor.
        assert_eq!(unsafe { libc::fcntl(descriptor.number(), libc::F_GETFD) }, libc::FD_CLOEXEC);
    }

    #[test]
    fn a_closed_one_is_not_taken_for_another_file_of_its_number_and_leaves_that_open() {
        // A number that no other test gets when it is free.
        const ALONE: RawFd = 900;
        // SAFETY: the descriptor is open, and nobody uses the number.
        assert_eq!(unsafe { libc::dup2(open().number(), ALONE) }, ALONE);
        let descriptor = Descriptor { number: ALONE };
        assert!(descriptor.is_own());
        // SAFETY: its owner looks at it before it uses it.
        unsafe { libc::close(ALONE) };
        assert!(!descriptor.is_own());
        assert_eq!(descriptor.error().raw_os_error(), Some(libc::EBADF));
        // The same device and inode.
        let other = File::open("/dev/null").expect("open");
        // SAFETY: both are open, or free.
        assert_eq!(unsafe { libc::dup2(other.as_raw_fd(), ALONE) }, ALONE);
        assert!(!descriptor.is_own());
        drop(descriptor);
        // SAFETY: the number of the duplicate, which is still open.
        assert_eq!(unsafe { libc::close(ALONE) }, 0);
    }

    #[test]
    fn a_call_that_failed_says_why() {
        // SAFETY: a constant path.
        let result = unsafe { libc::open(c"/nonexistent/file".as_ptr(), libc::O_RDWR) };
        assert_eq!(Descriptor::opened(result).expect_err("refused").raw_os_error(), Some(libc::ENOENT));
    }
}

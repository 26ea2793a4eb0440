//! File descriptors that other parts of the program may close although they do not own them.
//!
//! A program that becomes a daemon closes every descriptor from 3 to 255, or to its limit. The system then gives these
//! numbers to the next files that the program opens. A servo that continued to write would put its commands into those
//! files.
#![allow(unsafe_code, reason = "raw descriptors")]

use std::io;
use std::os::fd::{AsRawFd, FromRawFd, IntoRawFd, OwnedFd, RawFd};
use std::sync::atomic::{AtomicU32, Ordering};

/// The lowest number for our descriptors. It is above the numbers that most daemons close, and above those that a
/// program with a usual number of open files uses.
const LOWEST: RawFd = 512;

/// If the process may have only few descriptors, our numbers begin at this fraction (numerator, denominator) of the
/// permitted number.
const SHARE_OF_LIMIT: (libc::rlim_t, libc::rlim_t) = (3, 4);

// These numbers are the same on every Linux architecture except parisc.
const F_SETSIG: libc::c_int = 10;
const F_GETSIG: libc::c_int = 11;

/// Marks a file that was opened here. The mark is stored as the signal that announces input (F_SETSIG). These files
/// never send such a signal, so the value is free for this use. No other code has a reason to select SIGPWR. Device and
/// inode would be worse marks: a new pseudo-terminal may have those of an old one, the controlling ends of all
/// pseudo-terminals share those of /dev/ptmx, and reading them takes twice as long.
const MARK: libc::c_int = libc::SIGPWR;

/// How many files of this library have had each descriptor number. The mark says only that a file belongs to this
/// library. If other code closes a descriptor, its number may be given to another file that is opened here. The count
/// distinguishes these two files.
static GENERATIONS: [AtomicU32; NUMBERED] = [const { AtomicU32::new(0) }; NUMBERED];

/// Descriptor numbers below this one have a generation count. The system assigns the lowest free number, so only a
/// process with thousands of open files has higher ones.
const NUMBERED: usize = 4096;

/// An open descriptor that is checked before each use.
#[derive(Debug)]
pub(crate) struct Descriptor {
    number: RawFd,
    generation: u32,
}

impl Descriptor {
    /// Takes the result of a system call that opens a file: the descriptor, or a negative number with errno set. Marks
    /// the file and moves it to a high descriptor number.
    ///
    /// # Errors
    /// Returns the error that the system reports if the file was not opened or cannot be marked.
    pub fn opened(result: RawFd) -> io::Result<Self> {
        check(result)?;
        // SAFETY: the call has just created the descriptor, and no other code knows it.
        let low = unsafe { OwnedFd::from_raw_fd(result) };
        // SAFETY: the descriptor is open, and the command takes an integer.
        let high = unsafe { libc::fcntl(low.as_raw_fd(), libc::F_DUPFD_CLOEXEC, lowest()) };
        // If no high number is free, the low one stays in use.
        // SAFETY: the call has just created the descriptor, and no other code knows it.
        let file = if high < 0 { low } else { unsafe { OwnedFd::from_raw_fd(high) } };
        // The file is marked after the generation has changed. An earlier `Descriptor` with this number therefore never
        // finds both the mark and its own generation.
        let generation = next_generation(file.as_raw_fd());
        // SAFETY: the descriptor is open, and the command takes an integer.
        check(unsafe { libc::fcntl(file.as_raw_fd(), F_SETSIG, MARK) })?;
        Ok(Self { number: file.into_raw_fd(), generation })
    }

    /// Returns the number. Read, write or change the file only directly after [`Descriptor::is_own`] returned true, or
    /// while the file is being opened.
    pub fn number(&self) -> RawFd {
        self.number
    }

    /// Returns whether the number still refers to the file that was opened here.
    pub fn is_own(&self) -> bool {
        // SAFETY: the command takes no pointer and changes nothing. Any number is permitted.
        let marked = unsafe { libc::fcntl(self.number, F_GETSIG) == MARK };
        marked && generations(self.number).is_none_or(|all| all.load(Ordering::SeqCst) == self.generation)
    }

    /// Returns the last error of this descriptor, or EBADF if other code has closed it.
    pub fn error(&self) -> io::Error {
        let error = io::Error::last_os_error();
        if self.is_own() { error } else { io::Error::from_raw_os_error(libc::EBADF) }
    }
}

impl Drop for Descriptor {
    fn drop(&mut self) {
        if self.is_own() {
            // SAFETY: the number refers to the file that was opened here, and is not used after this.
            unsafe { libc::close(self.number) };
        }
    }
}

/// Returns the counter of the files that have had this descriptor number. Numbers from [`NUMBERED`] up have no counter.
fn generations(number: RawFd) -> Option<&'static AtomicU32> {
    GENERATIONS.get(usize::try_from(number).ok()?)
}

/// Counts a file with this descriptor number, and returns the count.
fn next_generation(number: RawFd) -> u32 {
    generations(number).map_or(0, |all| all.fetch_add(1, Ordering::SeqCst).wrapping_add(1))
}

/// Returns the lowest number for our descriptors.
fn lowest() -> RawFd {
    let mut limit = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: `limit` is writable. If the call fails, `limit` stays 0, and this function returns 0.
    unsafe { libc::getrlimit(libc::RLIMIT_NOFILE, &mut limit) };
    // On most systems the soft limit is 1024, so the share is above `LOWEST`.
    let share = limit.rlim_cur / SHARE_OF_LIMIT.1 * SHARE_OF_LIMIT.0;
    RawFd::try_from(share).map_or(LOWEST, |share| share.min(LOWEST))
}

/// Returns the result of a system call, or the error in errno.
pub(crate) fn check(result: libc::c_int) -> io::Result<libc::c_int> {
    if result < 0 { Err(io::Error::last_os_error()) } else { Ok(result) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::File;

    fn open() -> Descriptor {
        // SAFETY: the path is a constant C string.
        Descriptor::opened(unsafe { libc::open(c"/dev/null".as_ptr(), libc::O_RDWR | libc::O_CLOEXEC) }).expect("open")
    }

    #[test]
    fn a_descriptor_has_a_high_number_and_closes_at_exec() {
        let descriptor = open();
        assert!(descriptor.number() >= 256 && descriptor.is_own(), "{descriptor:?}");
        // SAFETY: the descriptor is open.
        assert_eq!(unsafe { libc::fcntl(descriptor.number(), libc::F_GETFD) }, libc::FD_CLOEXEC);
    }

    #[test]
    fn a_closed_descriptor_does_not_match_or_close_another_file_with_its_number() {
        // No other test gets such a high number: all tests together open too few files.
        const ALONE: RawFd = 900;
        // SAFETY: the descriptor is open, and nothing else uses the number.
        assert_eq!(unsafe { libc::dup2(open().number(), ALONE) }, ALONE);
        let descriptor = Descriptor { number: ALONE, generation: next_generation(ALONE) };
        assert!(descriptor.is_own());
        // SAFETY: `descriptor` checks the number before it uses it.
        unsafe { libc::close(ALONE) };
        assert!(!descriptor.is_own());
        assert_eq!(descriptor.error().raw_os_error(), Some(libc::EBADF));
        // This file has the same device and inode as the closed one.
        let other = File::open("/dev/null").expect("open");
        // SAFETY: the first number is open, and the second is open or free.
        assert_eq!(unsafe { libc::dup2(other.as_raw_fd(), ALONE) }, ALONE);
        assert!(!descriptor.is_own());
        drop(descriptor);
        // SAFETY: the number is that of the duplicate, which is still open.
        assert_eq!(unsafe { libc::close(ALONE) }, 0);
    }

    #[test]
    fn a_closed_descriptor_does_not_match_or_close_another_file_of_the_library_with_its_number() {
        let first = open();
        // SAFETY: `first` checks the number before it uses it.
        unsafe { libc::close(first.number()) };
        // Other tests open files too, so the number may be given to one of those.
        let mut others: Vec<Descriptor> = (0..100).map(|_| open()).collect();
        let Some(second) = others.iter().position(|other| other.number() == first.number()) else { return };
        let second = others.swap_remove(second);
        assert!(!first.is_own() && second.is_own());
        drop(first);
        assert!(second.is_own(), "the second file was closed");
    }

    #[test]
    fn a_failed_call_returns_its_errno() {
        // SAFETY: the path is a constant C string.
        let result = unsafe { libc::open(c"/nonexistent/file".as_ptr(), libc::O_RDWR) };
        assert_eq!(Descriptor::opened(result).expect_err("refused").raw_os_error(), Some(libc::ENOENT));
    }
}

//! The process of a hand, which a reader watches to learn when it ends. The end of the connection does not show this:
//! forked children of the process have copies of its sockets, and keep the connection open.
#![allow(unsafe_code, reason = "system calls")]

use crate::board::descriptor::Descriptor;
use std::os::fd::RawFd;

/// A process.
pub(super) struct Process(Descriptor);

impl Process {
    /// Opens the process with this number. Returns `None` if the calling process cannot see that process, or if the
    /// system does not support process descriptors.
    pub fn open(number: i32) -> Option<Self> {
        if number <= 0 {
            return None;
        }
        // SAFETY: the call takes numbers only.
        let result = unsafe { libc::syscall(libc::SYS_pidfd_open, number, 0) };
        Descriptor::opened(result as RawFd).ok().map(Self)
    }

    /// The descriptor, which is readable when the process has ended.
    pub fn number(&self) -> RawFd {
        if self.0.is_own() { self.0.number() } else { -1 }
    }

    /// Whether the process has ended.
    pub fn has_ended(&self) -> bool {
        let mut poll = libc::pollfd { fd: self.number(), events: libc::POLLIN, revents: 0 };
        // SAFETY: there is one entry. With the time limit 0 the call does not wait.
        unsafe { libc::poll(&mut poll, 1, 0) > 0 }
    }
}

//! Waits for input of a port, no longer than asked.
//!
//! A poll(2) of a terminal that has no bytes waits for the kernel worker that carries bytes to the terminal. This wait
//! has no time limit, and the worker has no real-time priority: on a busy machine, the wait lasted for more than a
//! second. The port is therefore registered with an epoll(7), and the epoll is polled instead of the terminal. The
//! worker itself makes the epoll readable, so this poll does not wait for the worker. The epoll is edge-triggered:
//! otherwise it would poll the terminal again after every event.
#![allow(unsafe_code, reason = "the raw descriptors of the port and of the epoll")]

use crate::board::descriptor::{Descriptor, check};
use std::io;
use std::time::Duration;

/// The wait for input of one port.
#[derive(Debug)]
pub(super) struct Input {
    epoll: Descriptor,
}

/// What has happened at a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// Bytes have arrived.
    Bytes,
    /// The port has no other end any more. The last bytes may have arrived with this event, which is not repeated.
    HangUp,
}

impl Input {
    /// Creates a wait that knows no port yet.
    ///
    /// # Errors
    /// Returns the error of the system, for example if the process has no free descriptor.
    pub fn new() -> io::Result<Self> {
        // SAFETY: the call takes only flags.
        let epoll = Descriptor::opened(unsafe { libc::epoll_create1(libc::EPOLL_CLOEXEC) })?;
        Ok(Self { epoll })
    }

    /// Registers the port, so that [`Input::wait`] returns its events from now on. Bytes that the port already has are
    /// an event. Changing the settings of the port is an event too, although there may be no bytes.
    ///
    /// # Errors
    /// Returns the error of the system.
    pub fn watch(&self, port: &Descriptor) -> io::Result<()> {
        let mut wanted = libc::epoll_event { events: (libc::EPOLLIN | libc::EPOLLET) as u32, u64: 0 };
        // SAFETY: both descriptors are open, and `wanted` is an event.
        check(unsafe { libc::epoll_ctl(self.epoll.number(), libc::EPOLL_CTL_ADD, port.number(), &mut wanted) })?;
        Ok(())
    }

    /// Waits for at most `timeout`, with an unchanged signal mask. Returns none if nothing has happened meanwhile. An
    /// event is returned once, so the caller must read everything before the next wait.
    ///
    /// # Errors
    /// Returns the error of the system, or EBADF if other code has closed the descriptor of the epoll.
    pub fn wait(&self, timeout: Duration) -> io::Result<Option<Event>> {
        let timeout =
            libc::timespec { tv_sec: timeout.as_secs() as libc::time_t, tv_nsec: timeout.subsec_nanos().into() };
        let mut poll = libc::pollfd { fd: self.epoll.number(), events: libc::POLLIN, revents: 0 };
        // SAFETY: the pointers refer to one pollfd and one timespec. A null mask leaves the signal mask unchanged.
        match unsafe { libc::ppoll(&mut poll, 1, &timeout, std::ptr::null()) } {
            0 => return Ok(None),
            1 if self.epoll.is_own() => {}
            _ => return Err(self.epoll.error()),
        }
        let mut event = libc::epoll_event { events: 0, u64: 0 };
        // The ppoll above does the waiting, because the timeout of epoll_wait is in milliseconds. epoll_pwait2 has
        // nanoseconds, but older kernels do not have it.
        // SAFETY: `event` has room for one event.
        match unsafe { libc::epoll_wait(self.epoll.number(), &mut event, 1, 0) } {
            0 => Ok(None),
            1 if event.events & (libc::EPOLLHUP | libc::EPOLLERR) as u32 != 0 => Ok(Some(Event::HangUp)),
            1 => Ok(Some(Event::Bytes)),
            _ => Err(self.epoll.error()),
        }
    }
}

//! Signals are the planner's: none reaches a thread of this library, and none comes from what it does in a planner's thread.
#![allow(unsafe_code, reason = "signal masks")]

use std::ffi::c_int;
use std::mem::MaybeUninit;

/// Signals that the calling thread takes only when this is dropped. Threads that are started meanwhile have them blocked for good.
pub struct SignalsBlocked(libc::sigset_t);

impl SignalsBlocked {
    /// Every signal.
    pub fn all() -> Self {
        let mut all = MaybeUninit::uninit();
        // SAFETY: sigfillset initialises what it is given.
        let all = unsafe {
            libc::sigfillset(all.as_mut_ptr());
            all.assume_init()
        };
        Self::these(&all)
    }

    /// One signal.
    pub fn one(signal: c_int) -> Self {
        Self::these(&set_of(signal))
    }

    /// Runs `wait` with the mask that the thread had, and blocks the same signals again.
    pub fn lifted<T>(&self, wait: impl FnOnce() -> T) -> T {
        let mut blocked = MaybeUninit::uninit();
        // SAFETY: the mask that this thread had, and room for the one that it has.
        unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, &self.0, blocked.as_mut_ptr()) };
        let waited = wait();
        // SAFETY: initialised above.
        unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, blocked.as_ptr(), std::ptr::null_mut()) };
        waited
    }

    fn these(signals: &libc::sigset_t) -> Self {
        let mut before = MaybeUninit::uninit();
        // SAFETY: a valid set, and room for the mask before, which is written: the call cannot fail with valid arguments.
        Self(unsafe {
            libc::pthread_sigmask(libc::SIG_BLOCK, signals, before.as_mut_ptr());
            before.assume_init()
        })
    }
}

impl Drop for SignalsBlocked {
    fn drop(&mut self) {
        // SAFETY: the mask that this thread had.
        unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, &self.0, std::ptr::null_mut()) };
    }
}

/// Whether a signal waits until the calling thread no longer blocks it.
pub fn is_pending(signal: c_int) -> bool {
    let mut pending = MaybeUninit::uninit();
    // SAFETY: sigpending initialises the set that it is given.
    unsafe { libc::sigpending(pending.as_mut_ptr()) == 0 && libc::sigismember(&pending.assume_init(), signal) == 1 }
}

/// Takes back a signal that is pending for the calling thread, and blocked in it.
pub fn take_back(signal: c_int) {
    let at_once = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: a valid set and time; null: what is known of the signal is of no interest.
    let taken = || unsafe { libc::sigtimedwait(&set_of(signal), std::ptr::null_mut(), &at_once) };
    while taken() < 0 && std::io::Error::last_os_error().kind() == std::io::ErrorKind::Interrupted {}
}

fn set_of(signal: c_int) -> libc::sigset_t {
    let mut set = MaybeUninit::uninit();
    // SAFETY: sigemptyset initialises what it is given.
    unsafe {
        libc::sigemptyset(set.as_mut_ptr());
        libc::sigaddset(set.as_mut_ptr(), signal);
        set.assume_init()
    }
}

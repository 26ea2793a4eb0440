//! Signals are the planner's: none reaches a thread of this library, and none comes from what it does in a planner's
//! thread.
#![allow(unsafe_code, reason = "signal masks")]

use std::ffi::c_int;
use std::mem::MaybeUninit;

/// Signals by which the system reports a fault of an instruction to the thread that executes it: an access to memory, a
/// number, a system call that a sandbox traps. Where such a signal is blocked the system ends the process and calls no
/// handler.
const FAULTS: [c_int; 6] = [libc::SIGSEGV, libc::SIGBUS, libc::SIGFPE, libc::SIGILL, libc::SIGTRAP, libc::SIGSYS];

/// Signals that the calling thread takes only when this is dropped. Threads that are started meanwhile have them
/// blocked for good.
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
        Self::set(&all)
    }

    /// These signals.
    pub fn these(signals: &[c_int]) -> Self {
        Self::set(&set_of(signals))
    }

    /// Runs `wait` with the mask that the thread had, and blocks the same signals again.
    pub fn lifted<T>(&self, wait: impl FnOnce() -> T) -> T {
        under(libc::SIG_SETMASK, &self.0, wait)
    }

    /// Runs `read`, which reads memory of the planner's, with the signals of faults let in that the thread had let in:
    /// a planner may have a handler that makes a page accessible when it is first touched.
    pub fn faults_let_in<T>(&self, read: impl FnOnce() -> T) -> T {
        let mut let_in = set_of(&[]);
        for signal in FAULTS {
            // SAFETY: two valid sets and a valid signal.
            unsafe {
                if libc::sigismember(&self.0, signal) == 0 {
                    libc::sigaddset(&mut let_in, signal);
                }
            }
        }
        under(libc::SIG_UNBLOCK, &let_in, read)
    }

    fn set(signals: &libc::sigset_t) -> Self {
        let mut before = MaybeUninit::uninit();
        // SAFETY: a valid set, and room for the mask before, which is written: the call cannot fail with valid
        // arguments.
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

/// Runs `work` with a changed signal mask, and restores the mask after it.
fn under<T>(change: c_int, signals: &libc::sigset_t, work: impl FnOnce() -> T) -> T {
    let mut before = MaybeUninit::uninit();
    // SAFETY: a valid set, and room for the mask that the thread has.
    unsafe { libc::pthread_sigmask(change, signals, before.as_mut_ptr()) };
    let result = work();
    // SAFETY: initialised above.
    unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, before.as_ptr(), std::ptr::null_mut()) };
    result
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
    let taken = || unsafe { libc::sigtimedwait(&set_of(&[signal]), std::ptr::null_mut(), &at_once) };
    while taken() < 0 && std::io::Error::last_os_error().kind() == std::io::ErrorKind::Interrupted {}
}

fn set_of(signals: &[c_int]) -> libc::sigset_t {
    let mut set = MaybeUninit::uninit();
    // SAFETY: sigemptyset initialises what it is given.
    unsafe {
        libc::sigemptyset(set.as_mut_ptr());
        for &signal in signals {
            libc::sigaddset(set.as_mut_ptr(), signal);
        }
        set.assume_init()
    }
}

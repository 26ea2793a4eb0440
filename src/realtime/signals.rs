//! Separation of signals. All signals belong to the planner: no thread of this library receives one, and nothing that
//! the library does in a planner's thread raises one.
#![allow(unsafe_code, reason = "signal masks")]

use std::ffi::c_int;
use std::mem::MaybeUninit;

/// Signals by which the system reports a fault of an instruction to the thread that executes it: an illegal memory
/// access, an arithmetic error, a system call that a sandbox traps. If such a signal is blocked, the system ends the
/// process without calling a handler.
const FAULTS: [c_int; 6] = [libc::SIGSEGV, libc::SIGBUS, libc::SIGFPE, libc::SIGILL, libc::SIGTRAP, libc::SIGSYS];

/// While this exists, the calling thread does not receive the blocked signals. They stay pending until this value is
/// dropped. A thread that is started meanwhile inherits the mask and keeps it.
pub struct SignalsBlocked(libc::sigset_t);

impl SignalsBlocked {
    /// Blocks every signal.
    pub fn all() -> Self {
        let mut all = MaybeUninit::uninit();
        // SAFETY: sigfillset initialises the set.
        let all = unsafe {
            libc::sigfillset(all.as_mut_ptr());
            all.assume_init()
        };
        Self::set(&all)
    }

    /// Blocks only `signals`.
    pub fn these(signals: &[c_int]) -> Self {
        Self::set(&set_of(signals))
    }

    /// Runs `wait` with the thread's original mask, then blocks the same signals again.
    pub fn lifted<T>(&self, wait: impl FnOnce() -> T) -> T {
        under(libc::SIG_SETMASK, &self.0, wait)
    }

    /// Runs `read`, which reads the planner's memory. Meanwhile, the fault signals that the thread itself had not
    /// blocked are unblocked. A planner may have a handler that makes a page accessible at the first access.
    pub fn with_faults_unblocked<T>(&self, read: impl FnOnce() -> T) -> T {
        let mut unblocked = set_of(&[]);
        for signal in FAULTS {
            // SAFETY: both sets and the signal are valid.
            unsafe {
                if libc::sigismember(&self.0, signal) == 0 {
                    libc::sigaddset(&mut unblocked, signal);
                }
            }
        }
        under(libc::SIG_UNBLOCK, &unblocked, read)
    }

    fn set(signals: &libc::sigset_t) -> Self {
        let mut before = MaybeUninit::uninit();
        // SAFETY: the set is valid, and there is room for the previous mask. With valid arguments the call cannot fail,
        // so the mask is written.
        Self(unsafe {
            libc::pthread_sigmask(libc::SIG_BLOCK, signals, before.as_mut_ptr());
            before.assume_init()
        })
    }
}

impl Drop for SignalsBlocked {
    fn drop(&mut self) {
        // SAFETY: the set is the thread's previous mask.
        unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, &self.0, std::ptr::null_mut()) };
    }
}

/// Runs `work` with a changed signal mask, and restores the mask after it.
fn under<T>(change: c_int, signals: &libc::sigset_t, work: impl FnOnce() -> T) -> T {
    let mut before = MaybeUninit::uninit();
    // SAFETY: the set is valid, and there is room for the current mask.
    unsafe { libc::pthread_sigmask(change, signals, before.as_mut_ptr()) };
    let result = work();
    // SAFETY: the first call has initialised the mask.
    unsafe { libc::pthread_sigmask(libc::SIG_SETMASK, before.as_ptr(), std::ptr::null_mut()) };
    result
}

/// Whether this process ignores a signal. A program that was started by nohup ignores SIGHUP until it has a handler of
/// its own for this signal.
pub fn is_ignored(signal: c_int) -> bool {
    let mut action = MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: a null action changes nothing. A call that succeeds initialises `action`.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr()) == 0
            && action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

/// Whether a signal is pending for the calling thread, which blocks it.
pub fn is_pending(signal: c_int) -> bool {
    let mut pending = MaybeUninit::uninit();
    // SAFETY: sigpending initialises the set.
    unsafe { libc::sigpending(pending.as_mut_ptr()) == 0 && libc::sigismember(&pending.assume_init(), signal) == 1 }
}

/// Removes a pending signal, which the calling thread must have blocked.
pub fn take_back(signal: c_int) {
    let at_once = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the set and the time are valid. Null means that no information about the signal is returned.
    let taken = || unsafe { libc::sigtimedwait(&set_of(&[signal]), std::ptr::null_mut(), &at_once) };
    while taken() < 0 && std::io::Error::last_os_error().kind() == std::io::ErrorKind::Interrupted {}
}

fn set_of(signals: &[c_int]) -> libc::sigset_t {
    let mut set = MaybeUninit::uninit();
    // SAFETY: sigemptyset initialises the set.
    unsafe {
        libc::sigemptyset(set.as_mut_ptr());
        for &signal in signals {
            libc::sigaddset(set.as_mut_ptr(), signal);
        }
        set.assume_init()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ignored_signal_is_known() {
        assert!(!is_ignored(libc::SIGWINCH) && !is_ignored(0));
        // SAFETY: an ignored signal calls no handler, and nothing else in this process uses SIGWINCH.
        let before = unsafe { libc::signal(libc::SIGWINCH, libc::SIG_IGN) };
        assert!(is_ignored(libc::SIGWINCH));
        // SAFETY: the action is the previous one.
        unsafe { libc::signal(libc::SIGWINCH, before) };
        assert!(!is_ignored(libc::SIGWINCH));
    }
}

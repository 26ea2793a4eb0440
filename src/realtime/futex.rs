//! The futex system call: threads wait for a change of a word in memory.
#![allow(unsafe_code, reason = "the futex system call")]

use std::sync::atomic::AtomicU32;

/// If `word` is `value`, waits until another thread calls [`wake`], but at most `limit` ns. Returns whether another
/// thread has woken the calling thread. This function is not a cancellation point.
pub(super) fn wait(word: &AtomicU32, value: u32, limit: u64) -> bool {
    let limit = libc::timespec {
        tv_sec: (limit / 1_000_000_000) as libc::time_t,
        tv_nsec: (limit % 1_000_000_000) as libc::c_long,
    };
    let operation = libc::FUTEX_WAIT | libc::FUTEX_PRIVATE_FLAG;
    // SAFETY: the word and the time limit are valid during the call. The wait may end early, so every caller checks its
    // own condition again.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), operation, value, &limit) == 0 }
}

/// Wakes at most `count` threads that wait for a change of `word`.
pub(super) fn wake(word: &AtomicU32, count: i32) {
    let operation = libc::FUTEX_WAKE | libc::FUTEX_PRIVATE_FLAG;
    // SAFETY: the word is valid during the call.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), operation, count) };
}

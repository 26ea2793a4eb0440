//! The monotonic clock, and a trait for timing code that works with any clock.
#![allow(unsafe_code)]

/// A clock that can be waited on. Times are ns since an arbitrary start.
pub trait Clock {
    /// The time, ns.
    fn now(&self) -> u64;
    /// Returns at `deadline`, ns, or later. Returns at once if `deadline` has passed.
    fn sleep_until(&self, deadline: u64);
}

/// CLOCK_MONOTONIC.
#[derive(Clone, Copy, Debug, Default)]
pub struct MonotonicClock;

impl Clock for MonotonicClock {
    fn now(&self) -> u64 {
        now()
    }

    fn sleep_until(&self, deadline: u64) {
        let until = libc::timespec {
            tv_sec: (deadline / 1_000_000_000) as libc::time_t,
            tv_nsec: (deadline % 1_000_000_000) as libc::c_long,
        };
        // SAFETY: `until` is a valid timespec. With TIMER_ABSTIME the remainder is not written, so null is allowed. Any
        // error other than EINTR means a wrong argument, and then a servo must not sleep forever.
        while unsafe { libc::clock_nanosleep(libc::CLOCK_MONOTONIC, libc::TIMER_ABSTIME, &until, std::ptr::null_mut()) }
            == libc::EINTR
        {}
    }
}

/// The time of CLOCK_MONOTONIC, ns.
pub fn now() -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is writable; CLOCK_MONOTONIC exists on every Linux, so the call cannot fail.
    unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &mut time) };
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

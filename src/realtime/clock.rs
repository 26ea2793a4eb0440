//! The monotonic clock, and a trait for clocks. Code that uses the trait works with any clock.
#![allow(unsafe_code)]

use std::io;
use std::time::{SystemTime, UNIX_EPOCH};

/// A clock that a thread can read, and by which it can sleep until a given time. Times are ns since an arbitrary start.
pub trait Clock {
    /// The time, ns.
    fn now(&self) -> u64;
    /// Returns at `deadline`, ns, or later. Returns at once if `deadline` has passed.
    fn sleep_until(&self, deadline: u64);
}

/// CLOCK_MONOTONIC.
#[derive(Clone, Copy, Debug, Default)]
pub struct MonotonicClock;

impl MonotonicClock {
    /// Checks that the system lets this process wait, which a sandbox may forbid.
    ///
    /// # Errors
    /// Returns the error with which the system refuses to wait.
    pub fn check_sleep() -> io::Result<()> {
        // The deadline 0 has passed, so the call returns at once.
        match sleep(0) {
            0 | libc::EINTR => Ok(()),
            error => Err(io::Error::from_raw_os_error(error)),
        }
    }
}

impl Clock for MonotonicClock {
    fn now(&self) -> u64 {
        now()
    }

    fn sleep_until(&self, deadline: u64) {
        // Any error other than EINTR ends the loop. It is caused by a wrong argument or a sandbox, and a servo must not
        // repeat the call forever.
        while sleep(deadline) == libc::EINTR {}
    }
}

/// Sleeps until `deadline`, ns. Returns 0, or the errno of the system.
fn sleep(deadline: u64) -> libc::c_int {
    let until = libc::timespec {
        tv_sec: (deadline / 1_000_000_000) as libc::time_t,
        tv_nsec: (deadline % 1_000_000_000) as libc::c_long,
    };
    // SAFETY: `until` is a valid timespec. With TIMER_ABSTIME the remainder is not written, so null is allowed.
    unsafe { libc::clock_nanosleep(libc::CLOCK_MONOTONIC, libc::TIMER_ABSTIME, &until, std::ptr::null_mut()) }
}

/// The time of CLOCK_MONOTONIC, ns.
pub fn now() -> u64 {
    read(libc::CLOCK_MONOTONIC)
}

/// The time of CLOCK_BOOTTIME, ns. It also passes while the machine is suspended.
pub fn boot_time() -> u64 {
    read(libc::CLOCK_BOOTTIME)
}

fn read(clock: libc::clockid_t) -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is writable. Both clocks exist on every Linux, so the call cannot fail.
    unsafe { libc::clock_gettime(clock, &mut time) };
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// The time since 1970 minus the time of CLOCK_MONOTONIC, ns.
pub fn clock_offset() -> i64 {
    (since_1970() as i64).wrapping_sub(now() as i64)
}

/// Converts a past time of CLOCK_BOOTTIME, ns, to s since 1970, with the system's clock as it is set now. So the
/// difference to the present time is right, even if the clock has been corrected since.
pub fn seconds_since_1970(past: u64) -> u64 {
    since_1970().saturating_sub(boot_time().saturating_sub(past)) / 1_000_000_000
}

/// The time since 1970, ns.
fn since_1970() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_nanos() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_converted_time_is_as_long_ago_as_on_the_boot_clock() {
        let present = seconds_since_1970(boot_time());
        assert!(present.abs_diff(since_1970() / 1_000_000_000) <= 1);
        // A machine in a test may have been started less than a minute ago.
        let past = boot_time().saturating_sub(60_000_000_000);
        let passed = (boot_time() - past) / 1_000_000_000;
        assert!((present - seconds_since_1970(past)).abs_diff(passed) <= 1);
    }
}

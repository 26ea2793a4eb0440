//! What the kernel says of this process, from /proc/self/status (proc(5)).

use crate::ServeError;
use std::fs::read_to_string;

/// Returns the effective user ID of this process.
///
/// # Errors
/// Returns an error if /proc cannot be read.
pub fn effective_user() -> Result<u32, ServeError> {
    let (doing, status) = ("find the user of this process", "/proc/self/status");
    let text = read_to_string(status);
    let text = text.map_err(|error| ServeError::System { doing, reason: format!("{status}: {error}. Mount /proc") })?;
    user_in(&text).ok_or_else(|| ServeError::System { doing, reason: format!("{status} has no line Uid. Mount /proc") })
}

/// Returns whether this process was started with this signal ignored, as nohup does with SIGHUP.
#[must_use]
pub fn ignores(signal: i32) -> bool {
    read_to_string("/proc/self/status").is_ok_and(|text| ignored_in(&text, signal))
}

fn user_in(status: &str) -> Option<u32> {
    // The real ID is before the effective one.
    status.lines().find_map(|line| line.strip_prefix("Uid:"))?.split_whitespace().nth(1)?.parse().ok()
}

fn ignored_in(status: &str, signal: i32) -> bool {
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    (1..=64).contains(&signal) && (mask >> (signal - 1)) & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use signal_hook::consts::{SIGHUP, SIGTERM};

    const STATUS: &str = "Name:\tserve\nUid:\t1000\t1001\t1002\t1003\nSigIgn:\t0000000000001001\n";

    #[test]
    fn the_effective_user_and_ignored_signals_are_read() {
        assert_eq!(user_in(STATUS), Some(1001));
        assert_eq!(user_in("Name:\tserve\n"), None);
        assert!(ignored_in(STATUS, SIGHUP) && !ignored_in(STATUS, SIGTERM) && !ignored_in(STATUS, 0));
        assert!(!ignored_in("SigIgn:\tx\n", SIGHUP));
        assert!(effective_user().is_ok());
    }
}

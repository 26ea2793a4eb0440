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
    user_in(&text).ok_or_else(|| ServeError::System {
        doing,
        reason: format!("{status} has no line Uid. Mount a file system of the type proc at /proc"),
    })
}

fn user_in(status: &str) -> Option<u32> {
    // The real ID is before the effective one.
    status.lines().find_map(|line| line.strip_prefix("Uid:"))?.split_whitespace().nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_effective_user_is_read() {
        assert_eq!(user_in("Name:\tserve\nUid:\t1000\t1001\t1002\t1003\n"), Some(1001));
        assert_eq!(user_in("Name:\tserve\n"), None);
        assert!(effective_user().is_ok());
    }
}

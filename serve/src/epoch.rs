//! Epochs: random numbers that nobody can guess. A client that acquires the hand gets a new epoch, a secret that its
//! Targets (the messages with its set points) must contain.

use crate::ServeError;

/// Returns a random number that is not 0.
///
/// # Errors
/// Returns an error if the system has no random numbers.
pub fn new_epoch() -> Result<u64, ServeError> {
    loop {
        let epoch = getrandom::u64().map_err(|error| ServeError::System {
            doing: "get a random number for an epoch",
            reason: format!("{error}: permit the server to use the system call getrandom and to read /dev/urandom"),
        })?;
        if epoch != 0 {
            return Ok(epoch);
        }
    }
}

//! Finds the hands behind a router.

use crate::configuration::RemoteConfiguration;
use crate::connection;
use crate::error::RemoteError;
use std::time::Duration;
use sun2xp_remote_protocol::{EVERY_STATUS, HandName, Status, hand_of_status};
use zenoh::Wait;

/// The time for which answers are collected.
const LIMIT: Duration = Duration::from_secs(2);

/// A hand that was found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Discovered {
    /// Its name.
    pub name: HandName,
    /// Its Status. It names the owner.
    pub status: Status,
}

/// Lists the hands that can be reached at the endpoint of the configuration. If the endpoint is a server, this is the
/// hand of the server. If it is a router, these are the hands of all servers behind the router. The name of the hand in
/// the configuration is not used. Waits at most 5 s. Hands whose answer is not of this version of the protocol are left
/// out.
///
/// # Errors
/// Returns an error if the configuration or a certificate cannot be used, or if the endpoint cannot be reached.
pub fn discover(configuration: &RemoteConfiguration) -> Result<Vec<Discovered>, RemoteError> {
    configuration.checked_client()?;
    let session = connection::open(configuration)?;
    let replies = connection::get(&session, EVERY_STATUS, None, (LIMIT, usize::MAX));
    // An error of `close` is ignored, because the session is closed even then.
    let _ = session.close().wait();
    let replies = replies.map_err(|error| {
        let endpoint = &configuration.endpoint;
        RemoteError::NotConnected(format!("cannot ask for the hands at {endpoint}: {error}. Check the line"))
    })?;
    let found = |(key, payload): &(String, Vec<u8>)| {
        let (name, status) = (hand_of_status(key)?, Status::decode(payload).ok()?);
        Some(Discovered { name, status })
    };
    let mut hands: Vec<_> = replies.iter().filter_map(found).collect();
    hands.sort_by(|one, other| one.name.cmp(&other.name));
    Ok(hands)
}

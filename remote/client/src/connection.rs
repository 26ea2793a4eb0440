//! The connection to a server or a router over Zenoh.

use crate::configuration::RemoteConfiguration;
use crate::error::RemoteError;
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::mpsc;
use std::time::Duration;
use zenoh::{Config, Session, Wait};

/// The time limit for making a connection, ms.
const CONNECT_MS: u64 = 3000;

/// The lease of a connection, ms. Zenoh considers a connection dead after this time without a message. The lease only
/// decides when the connection is made again. It does not protect the hand: the limit on the age of Targets does.
const LEASE_MS: u64 = 4000;

/// The largest message that is accepted, bytes. A State with the largest number of records has 48 032 bytes.
const LARGEST: u64 = 131_072;

/// Opens a session.
pub fn open(configuration: &RemoteConfiguration) -> Result<Session, RemoteError> {
    let config = session_configuration(configuration).map_err(|error| {
        RemoteError::NotConnected(format!(
            "Zenoh refuses its configuration ({}): check remote.endpoint and the paths of remote.tls",
            short(&error)
        ))
    })?;
    zenoh::open(config).wait().map_err(|error| RemoteError::NotConnected(unreachable(configuration, &short(&error))))
}

fn session_configuration(configuration: &RemoteConfiguration) -> zenoh::Result<Config> {
    let mut config = Config::default();
    let text = |text: &str| serde_json::to_string(text).unwrap_or_default();
    let settings = [
        ("mode", "\"client\"".to_string()),
        ("connect/endpoints", format!("[{}]", text(&configuration.endpoint))),
        ("connect/timeout_ms", CONNECT_MS.to_string()),
        ("connect/retry", "{ period_init_ms: 100, period_max_ms: 500, period_increase_factor: 2 }".into()),
        ("listen/endpoints", "[]".into()),
        ("scouting/multicast/enabled", "false".into()),
        ("scouting/gossip/enabled", "false".into()),
        ("transport/unicast/open_timeout", (CONNECT_MS / 2).to_string()),
        ("transport/link/tx/lease", LEASE_MS.to_string()),
        ("transport/link/rx/max_message_size", LARGEST.to_string()),
    ];
    for (key, value) in settings {
        config.insert_json5(key, &value)?;
    }
    if let Some(tls) = &configuration.tls {
        let file = |path: &std::path::Path| text(&path.to_string_lossy());
        config.insert_json5("transport/link/protocols", "[\"tls\"]")?;
        config.insert_json5("transport/link/tls/root_ca_certificate", &file(&tls.authority))?;
        config.insert_json5("transport/link/tls/enable_mtls", "true")?;
        config.insert_json5("transport/link/tls/connect_certificate", &file(&tls.certificate))?;
        config.insert_json5("transport/link/tls/connect_private_key", &file(&tls.key))?;
        config.insert_json5("transport/link/tls/close_link_on_expiration", "true")?;
    }
    Ok(config)
}

/// Returns the text of an error. The text of Zenoh ends with a location in Zenoh's sources. This location is left out,
/// because a planner cannot use it.
pub(crate) fn short(error: &zenoh::Error) -> String {
    let text = error.to_string();
    text.split(" at /").next().unwrap_or_default().trim_end_matches(['.', '!']).into()
}

/// Returns why there is no connection, and the remedy. Zenoh does not give the reason, so this function tries to
/// connect without Zenoh.
fn unreachable(configuration: &RemoteConfiguration, error: &str) -> String {
    let endpoint = &configuration.endpoint;
    let place = endpoint.split_once('/').map_or("", |(_, place)| place);
    let remedy = match place.to_socket_addrs().map(|mut addresses| addresses.next()) {
        Err(source) => format!("{source}: correct the host in remote.endpoint"),
        Ok(None) => "the host has no address: correct the host in remote.endpoint".into(),
        Ok(Some(address)) => match TcpStream::connect_timeout(&address, Duration::from_millis(500)) {
            Err(source) => format!(
                "{source}: start `sun2xp serve` there, correct remote.endpoint, or open the port in the firewall"
            ),
            Ok(_) if configuration.tls.is_some() => {
                "a program answers there, but the TLS handshake fails: check that it is `sun2xp serve` with TLS, that \
                 remote.tls.authority has signed the certificates of both ends, that the server's certificate names \
                 the host of remote.endpoint, and that no certificate has expired"
                    .into()
            }
            Ok(_) => {
                "a program answers there, but it is not `sun2xp serve`, or it needs TLS: check the port, or begin \
                 remote.endpoint with `tls/`"
                    .into()
            }
        },
    };
    format!("cannot connect to {endpoint} ({error}): {remedy}")
}

/// Sends a get, and collects replies until all of them have arrived, until there are `most` replies, or until `limit`
/// is over. The list is empty if nobody was reached, or if the connection was lost before the first reply.
///
/// # Errors
/// Returns the text of the error if Zenoh refuses the get, if no reply has arrived within `limit`, or if the first
/// reply is an error.
pub fn get(
    session: &Session,
    selector: &str,
    payload: Option<Vec<u8>>,
    (limit, most): (Duration, usize),
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let (to, replies) = mpsc::channel();
    let mut query = session.get(selector).timeout(limit);
    if let Some(payload) = payload {
        query = query.payload(payload);
    }
    let query = query.target(zenoh::query::QueryTarget::All).callback(move |reply| {
        let reply = match reply.result() {
            Ok(sample) => Ok((sample.key_expr().to_string(), sample.payload().to_bytes().into_owned())),
            Err(error) => Err(error.payload().try_to_string().map_or_else(|_| "an error".into(), |text| text.into())),
        };
        // An error of `send` is ignored: the receiver is gone when there are enough replies.
        let _ = to.send(reply);
    });
    query.wait().map_err(|error| short(&error))?;
    let mut received = Vec::new();
    while received.len() < most {
        // The sender is dropped when all replies have come, or when the connection is lost. After the limit, Zenoh
        // itself ends the query with an error.
        match replies.recv_timeout(limit + Duration::from_secs(1)) {
            Ok(Ok(reply)) => received.push(reply),
            Ok(Err(error)) if received.is_empty() => return Err(error),
            Ok(Err(_)) | Err(_) => break,
        }
    }
    Ok(received)
}

//! The session of zenoh: where it listens and connects, TLS, and access control. Multicast scouting and gossip are off:
//! the server listens only at the configured endpoints, and connects only to the configured ones. The threads of zenoh
//! are ordinary ones, even if this process was started with a real-time priority, because they are started by an
//! ordinary thread.

use crate::ServeError;
use crate::endpoint::Endpoint;
use crate::json::{string, strings};
use crate::settings::{Settings, TlsFiles};
use std::fs::File;
use std::io::ErrorKind;
use std::path::Path;
use sun2xp::realtime::{Priority, spawn, with_remedy};
use zenoh::{Config, Session, Wait};

/// Largest message that the server of a hand receives, bytes. The longest Target has about 3500 bytes.
pub const LARGEST_OF_HAND: u16 = 4_096;

/// Largest message that a router receives, bytes. The States of hands pass through the router.
pub const LARGEST_OF_ROUTER: u16 = u16::MAX;

/// Longest time for which a client that does not read can hold up a message, us. The other clients wait during this
/// time. Then zenoh closes the link of the client that does not read. The default of zenoh is 5 s. This value is
/// shorter than the default of catch_ms, so that the fingers are not caught (see [`crate::silence`]) while their owner
/// waits.
const LONGEST_WAIT: &str = "50000";

/// Opens a session for these settings, with this access control if it listens with TLS. The session receives messages
/// of at most `largest` bytes, [`LARGEST_OF_HAND`] or [`LARGEST_OF_ROUTER`].
///
/// # Errors
/// Returns an error if a file of TLS is missing, or if the server cannot listen. A router that cannot be reached is no
/// error: the session connects when the router starts.
pub fn open(settings: &Settings, access: &str, largest: u16) -> Result<Session, ServeError> {
    let config = config(settings, access, largest)?;
    let doing = format!(
        "{}{}",
        listed("listen at ", &settings.listen),
        listed(if settings.listen.is_empty() { "connect to " } else { " or connect to " }, &settings.connect)
    );
    let failed = |reason: String| ServeError::Network { doing: doing.clone(), reason };
    let opening = spawn("sun2xp network", Priority::default(), move |_| zenoh::open(config).wait());
    let opening = opening.map_err(|error| failed(with_remedy(&error)))?;
    let opened = opening.join().map_err(|_| {
        failed("Zenoh, the network library, has failed: please report this defect, with the message above".into())
    })?;
    opened.map_err(|error| {
        let text = error.to_string();
        // zenoh appends ` at `, and the file and line of its own source code that made the error.
        let cause = text.split(" at /").next().unwrap_or(&text).trim_end_matches('.');
        failed(format!(
            "{cause}. The server can listen only at addresses of this machine and at free ports. With TLS, it also \
             needs the right files in [serve.tls]"
        ))
    })
}

fn listed(what: &str, endpoints: &[Endpoint]) -> String {
    let texts: Vec<String> = endpoints.iter().map(Endpoint::to_string).collect();
    if texts.is_empty() { String::new() } else { format!("{what}{}", texts.join(", ")) }
}

/// Returns the configuration of zenoh.
///
/// # Errors
/// Returns an error if a file of TLS is missing.
fn config(settings: &Settings, access: &str, largest: u16) -> Result<Config, ServeError> {
    let mut config = Config::default();
    // A server that does not listen is a client of its router. A server that listens is the router of its clients.
    let mode = if settings.listen.is_empty() { "client" } else { "router" };
    let endpoints = |endpoints: &[Endpoint]| strings(endpoints.iter().map(Endpoint::to_string));
    let listen = endpoints(&settings.listen);
    let connect = endpoints(&settings.connect);
    let mut entries = vec![
        ("mode", string(mode)),
        ("listen/endpoints", listen),
        ("connect/endpoints", connect),
        // The router may start later than the hand.
        ("connect/timeout_ms", "-1".into()),
        ("connect/exit_on_failure", "false".into()),
        ("scouting/delay", "0".into()),
        ("scouting/multicast/enabled", "false".into()),
        ("scouting/gossip/enabled", "false".into()),
        // When zenoh receives a declaration, it calls functions that recurse once for each part of the key, before
        // access control checks the declaration. So a long key with many parts would exhaust the stack. Two limits
        // bound the length of a key: the size of a batch, which the two sides agree on when they connect, and the size
        // of a message of several batches.
        ("transport/link/tx/batch_size", largest.to_string()),
        ("transport/link/rx/max_message_size", largest.to_string()),
        ("transport/link/tx/queue/congestion_control/block/wait_before_close", LONGEST_WAIT.into()),
    ];
    if largest == LARGEST_OF_HAND {
        // These batches are smaller than those of zenoh's default, so a State can need several batches. The default
        // queue of 2 batches may not hold a State.
        entries.push(("transport/link/tx/queue/size/data", "16".into()));
    }
    if let Some(files) = &settings.tls {
        entries.push(("transport/link/protocols", r#"["tls"]"#.into()));
        entries.push(("transport/link/tls", tls(files)?));
        // A hand that is only a client of a router trusts the access control of the router.
        if !settings.listen.is_empty() {
            entries.push(("access_control", access.into()));
        }
    } else {
        entries.push(("transport/link/protocols", r#"["tcp"]"#.into()));
    }
    for (key, value) in entries {
        config.insert_json5(key, &value).map_err(|error| ServeError::Network {
            doing: format!("configure {key} of zenoh"),
            reason: format!("{error}. This is a defect of the server: please report it"),
        })?;
    }
    Ok(config)
}

fn tls(files: &TlsFiles) -> Result<String, ServeError> {
    let path = |path: &Path| {
        File::open(path).map_err(|error| {
            let remedy = match error.kind() {
                ErrorKind::PermissionDenied => "This user needs permission to read the file and to enter its folder",
                _ => "`sun2xp serve --make-certificates` makes such files",
            };
            ServeError::Certificate { path: path.into(), reason: format!("{error}. {remedy}") }
        })?;
        Ok::<_, ServeError>(string(&path.to_string_lossy()))
    };
    let (authority, certificate, key) = (path(&files.authority)?, path(&files.certificate)?, path(&files.key)?);
    Ok(format!(
        r#"{{"root_ca_certificate":{authority},"enable_mtls":true,"verify_name_on_connect":true,
            "close_link_on_expiration":true,"listen_certificate":{certificate},"listen_private_key":{key},
            "connect_certificate":{certificate},"connect_private_key":{key}}}"#
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Overrides;

    #[test]
    fn what_a_client_may_send_and_hold_up_is_limited() {
        let settings = Settings::from_text("", Path::new("sun2xp.toml"), &Overrides::default()).expect("usable");
        for (largest, text) in [(LARGEST_OF_HAND, "4096"), (LARGEST_OF_ROUTER, "65535")] {
            let config = config(&settings, "", largest).expect("a configuration");
            let value = |key: &str| config.get_json(key).expect("a value");
            assert_eq!(value("transport/link/tx/batch_size"), text);
            assert_eq!(value("transport/link/rx/max_message_size"), text);
            let wait = value("transport/link/tx/queue/congestion_control/block/wait_before_close");
            assert_eq!(wait, LONGEST_WAIT);
        }
    }
}

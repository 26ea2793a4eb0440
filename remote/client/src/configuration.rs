//! The tables `[remote]` and `[remote.tls]` of a configuration file.

mod certificate;
mod text;

pub use certificate::client_of;

use crate::error::RemoteError;
use std::path::{Path, PathBuf};
use sun2xp_remote_protocol::{ClientName, HandName};
use text::Wrong;

/// The default of `remote.stale_ms`, ms.
const STALE_MS: u32 = 100;

/// Largest configuration file, bytes.
const LARGEST: u64 = 1 << 20;

/// The configuration of a client: which hand it uses, how it reaches the hand, and its own name.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RemoteConfiguration {
    /// `tls/HOST:PORT` of the server or a router, or `tcp/HOST:PORT` on this machine.
    pub endpoint: String,
    /// The name of the hand.
    pub hand: HandName,
    /// The name of this client. With TLS it is the common name of the certificate, and may be left out here.
    pub client: Option<ClientName>,
    /// Largest age of a measured position that calls return, ms: 1 to 60000.
    pub stale_ms: u32,
    /// Whether opening takes the hand over from another owner.
    pub take_over: bool,
    /// The certificates. They are needed with `tls/`.
    pub tls: Option<RemoteTls>,
}

/// The files of mutual TLS, in PEM.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RemoteTls {
    /// The certificate of the authority that has signed the server's certificate.
    pub authority: PathBuf,
    /// The certificate of this client.
    pub certificate: PathBuf,
    /// The private key of this client.
    pub key: PathBuf,
}

impl RemoteConfiguration {
    /// A configuration without TLS.
    #[must_use]
    pub fn new(endpoint: &str, hand: HandName, client: ClientName) -> Self {
        let client = Some(client);
        Self { endpoint: endpoint.into(), hand, client, stale_ms: STALE_MS, take_over: false, tls: None }
    }

    /// Reads the tables of a configuration file. Returns none if the file has no table `[remote]`. Relative names of
    /// files are relative to the folder of the configuration file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read. If its text is wrong, returns an error with the line.
    pub fn read(path: &Path) -> Result<Option<Self>, RemoteError> {
        let unreadable = |source| RemoteError::System { doing: format!("read {}", path.display()), source };
        let metadata = std::fs::metadata(path).map_err(unreadable)?;
        let unsuitable =
            |reason: &str| Err(RemoteError::Configuration { file: path.into(), line: None, reason: reason.into() });
        if !metadata.is_file() {
            return unsuitable("it is not a regular file: name the configuration file of a hand");
        }
        if metadata.len() > LARGEST {
            return unsuitable("it is larger than 1 MiB: name the configuration file of a hand");
        }
        let text = std::fs::read_to_string(path).map_err(unreadable)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::parse(&text, folder).map_err(|wrong| wrong.in_file(path, &text))
    }

    /// Reads the tables from the text of a configuration file. Relative names of files are relative to `folder`.
    ///
    /// # Errors
    /// Returns an error with the line if the text is wrong.
    pub fn from_text(text: &str, folder: &Path) -> Result<Option<Self>, RemoteError> {
        Self::parse(text, folder).map_err(|wrong| wrong.in_file(Path::new("the text of the configuration"), text))
    }

    fn parse(text: &str, folder: &Path) -> Result<Option<Self>, Wrong> {
        let Some((read, lines)) = text::read(text)? else { return Ok(None) };
        let tls = read.tls.map(|tls| RemoteTls {
            authority: folder.join(tls.authority),
            certificate: folder.join(tls.certificate),
            key: folder.join(tls.key),
        });
        let configuration = Self {
            endpoint: read.endpoint,
            hand: read.hand,
            client: read.client,
            stale_ms: read.stale_ms.unwrap_or(STALE_MS),
            take_over: read.take_over.unwrap_or(false),
            tls,
        };
        configuration.check().map_err(|(key, reason)| Wrong::at(lines.of(key), reason))?;
        Ok(Some(configuration))
    }

    /// Checks the endpoint, `stale_ms`, and whether the configuration keys fit together. The error contains the
    /// configuration key, which is empty for the whole table, and the reason.
    fn check(&self) -> Result<(), (&'static str, String)> {
        let (protocol, host) = self.endpoint.split_once('/').unwrap_or(("", &self.endpoint));
        let (host, port) = host.rsplit_once(':').unwrap_or((host, ""));
        let usable = !host.is_empty() && port.parse::<u16>().is_ok() && !host.contains(['/', '#', '?', ',', ' ']);
        if !matches!(protocol, "tcp" | "tls") || !usable {
            let reason = format!("remote.endpoint = {:?} is not `tls/HOST:PORT` or `tcp/HOST:PORT`", self.endpoint);
            return Err(("endpoint", reason));
        }
        if !(1..=60_000).contains(&self.stale_ms) {
            return Err(("stale_ms", format!("remote.stale_ms = {} must be 1 to 60000", self.stale_ms)));
        }
        if self.tls.is_some() != (protocol == "tls") {
            let reason = "a `tls/` endpoint needs a table [remote.tls] with authority, certificate and key, and a \
                          `tcp/` endpoint must not have one: change remote.endpoint, or add or remove the table";
            return Err(("endpoint", reason.into()));
        }
        if protocol == "tcp" && !is_loopback(host) {
            let reason = "remote.endpoint has no TLS, and is not on this machine: use `tls/` with certificates of \
                          `sun2xp serve --make-certificates`";
            return Err(("endpoint", reason.into()));
        }
        if self.tls.is_none() && self.client.is_none() {
            return Err(("", "remote.client is missing: without TLS, set it to a name for this client".into()));
        }
        Ok(())
    }

    /// Checks the configuration and its certificate. Returns the name of this client.
    pub(crate) fn checked_client(&self) -> Result<ClientName, RemoteError> {
        let wrong = |reason| RemoteError::Configuration { file: "the configuration".into(), line: None, reason };
        self.check().map_err(|(_, reason)| wrong(reason))?;
        match (&self.tls, &self.client) {
            (Some(tls), given) => client_of(tls, given.as_ref()),
            (None, Some(client)) => Ok(client.clone()),
            (None, None) => Err(wrong("remote.client is missing: set it to a name for this client".into())),
        }
    }
}

fn is_loopback(host: &str) -> bool {
    let bare = host.trim_start_matches('[').trim_end_matches(']');
    host == "localhost" || bare.parse::<std::net::IpAddr>().is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests;

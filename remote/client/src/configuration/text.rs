//! Reads the tables `[remote]` and `[remote.tls]` from the text of a file, and finds the line of an error.

use crate::error::RemoteError;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::ops::Range;
use std::path::{Path, PathBuf};
use sun2xp_remote_protocol::{ClientName, HandName};
use toml_edit::Document;

/// A configuration file. Its other tables are those of the library and the server.
#[derive(Deserialize)]
struct ConfigurationFile {
    remote: Option<Read>,
}

/// The table `[remote]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Read {
    pub endpoint: String,
    #[serde(deserialize_with = "hand_name")]
    pub hand: HandName,
    #[serde(default, deserialize_with = "client_name")]
    pub client: Option<ClientName>,
    pub stale_ms: Option<u32>,
    pub take_over: Option<bool>,
    pub tls: Option<ReadTls>,
}

/// The table `[remote.tls]`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ReadTls {
    pub authority: PathBuf,
    pub certificate: PathBuf,
    pub key: PathBuf,
}

fn hand_name<'de, D: Deserializer<'de>>(from: D) -> Result<HandName, D::Error> {
    String::deserialize(from)?.parse().map_err(|error| D::Error::custom(format!("remote.hand: {error}")))
}

fn client_name<'de, D: Deserializer<'de>>(from: D) -> Result<Option<ClientName>, D::Error> {
    let name = String::deserialize(from)?.parse();
    name.map(Some).map_err(|error| D::Error::custom(format!("remote.client: {error}")))
}

/// The places of the values of `[remote]` in the text. A place is a range of bytes.
pub struct Places(Document<String>);

impl Places {
    /// Returns the place of a key's value. If the table has no such key, returns the place of the table.
    pub fn of(&self, key: &str) -> Option<Range<usize>> {
        let table = self.0.get("remote")?;
        table.get(key).and_then(toml_edit::Item::span).or_else(|| table.span())
    }
}

/// Reads the tables of a text. Returns none if it has no table `[remote]`.
pub fn read(text: &str) -> Result<Option<(Read, Places)>, Wrong> {
    let document =
        Document::parse(text.to_string()).map_err(|error| Wrong::at(error.span(), error.message().into()))?;
    let read: ConfigurationFile = toml_edit::de::from_str(text).map_err(|error| {
        let message = error.message();
        let table = if message.starts_with("remote.") { "" } else { "[remote]: " };
        Wrong::at(error.span(), format!("{table}{message}. docs/remote.md lists the keys"))
    })?;
    Ok(read.remote.map(|remote| (remote, Places(document))))
}

/// What is wrong with a text, and where.
pub struct Wrong {
    span: Option<Range<usize>>,
    reason: String,
}

impl Wrong {
    pub fn at(span: Option<Range<usize>>, reason: String) -> Self {
        Self { span, reason }
    }

    /// Converts this to the error of a file whose text is `text`.
    pub fn in_file(self, file: &Path, text: &str) -> RemoteError {
        let before = self.span.and_then(|span| text.get(..span.start));
        let line = before.map(|before| before.matches('\n').count() + 1);
        RemoteError::Configuration { file: file.into(), line, reason: self.reason }
    }
}

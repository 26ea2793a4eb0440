//! The tables `[serve]`, `[serve.clients]` and `[serve.tls]` of the configuration file.

use crate::ServeError;
use crate::endpoint::Endpoint;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use sun2xp::ConfigurationError;
use sun2xp::files::read_regular_file;
use sun2xp::hand::{Wrong, deserialize};
use sun2xp_remote_protocol::{ClientName, HandName};
use toml_edit::{Document, Item};

/// Largest configuration file, bytes, as in the library.
const LARGEST: u64 = 1 << 20;

/// The endpoint at which a server listens if neither `listen` nor `connect` is configured.
const LOOPBACK: &str = "tcp/127.0.0.1:7447";

/// What a client may do.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Permission {
    /// Read states, events and statuses, and stop fingers.
    Read,
    /// Also own and command the hand.
    Command,
    /// At a router: offer the hand whose name is the client's name.
    Hand,
}

/// The files of TLS, PEM.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct TlsFiles {
    /// The certificate of the authority.
    pub authority: PathBuf,
    /// The certificate of the server.
    pub certificate: PathBuf,
    /// The private key of the server.
    pub key: PathBuf,
}

/// The table `[serve]` as it is in the file.
#[derive(Clone, Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Serve {
    name: String,
    listen: Option<Vec<String>>,
    connect: Vec<String>,
    catch_ms: u32,
    end_ms: u32,
    soft_stiffness: f64,
    lead_force: f64,
    clients: BTreeMap<String, Permission>,
    tls: Option<TlsFiles>,
}

impl Default for Serve {
    fn default() -> Self {
        Self {
            name: "hand".into(),
            listen: None,
            connect: Vec::new(),
            catch_ms: 100,
            end_ms: 1000,
            soft_stiffness: 1.0,
            lead_force: 10.0,
            clients: BTreeMap::new(),
            tls: None,
        }
    }
}

/// The limits of an owner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Longest validity of a Target, ms.
    pub catch_ms: u32,
    /// Time without a Target after which every finger goes to its end state, ms.
    pub end_ms: u32,
    /// Kx with which a finger holds its pose after its Target has expired (see [`crate::silence`]), N/cm.
    pub soft_stiffness: f64,
    /// Largest force with which a set point pulls a fingertip, N.
    pub lead_force: f64,
}

/// What `[serve]` says.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The name of the hand.
    pub name: HandName,
    /// Where the server listens.
    pub listen: Vec<Endpoint>,
    /// The routers to which the server connects.
    pub connect: Vec<Endpoint>,
    /// The limits of an owner.
    pub limits: Limits,
    /// Who may do what.
    pub clients: BTreeMap<ClientName, Permission>,
    /// The files of TLS; none without TLS.
    pub tls: Option<TlsFiles>,
}

/// What the command line says in place of the file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// The name of the hand.
    pub name: Option<String>,
    /// Where the server listens.
    pub listen: Vec<String>,
}

impl Settings {
    /// Reads the table `[serve]` of a file; without a file, all values are the default values. Relative paths of
    /// the files of TLS are relative to the folder of the configuration file.
    ///
    /// # Errors
    /// Returns an error, with file and line, if the file cannot be read or the table cannot be used. Returns an error
    /// if an endpoint can be reached from other machines and there is no TLS.
    pub fn read(file: Option<&Path>, overrides: &Overrides) -> Result<Self, ServeError> {
        let Some(path) = file else { return Self::from_text("", Path::new("command line"), overrides) };
        let text = read_regular_file(path, LARGEST)
            .map_err(|source| ConfigurationError::Unreadable { path: path.into(), source })?;
        Self::from_text(&text, path, overrides)
    }

    /// Reads the table `[serve]` as [`Settings::read`] does, but from the text of the file.
    ///
    /// # Errors
    /// Returns the errors of [`Settings::read`], except those of reading the file.
    pub fn from_text(text: &str, file: &Path, overrides: &Overrides) -> Result<Self, ServeError> {
        let wrong = |wrong: Wrong| ServeError::Settings {
            file: file.into(),
            line: wrong.line(text),
            reason: wrong.to_string(),
        };
        let document = Document::parse(text).map_err(|error| wrong(Wrong::in_syntax(error)))?;
        let item = document.as_table().get("serve");
        let table = match item {
            None => Serve::default(),
            Some(Item::Table(table)) => deserialize(table).map_err(|error| wrong(error.in_key("serve")))?,
            Some(other) => return Err(wrong(Wrong::at(other.span(), "must be a table".into()).in_key("serve"))),
        };
        let refuse = |key: &str, reason: String| {
            let tables = item.and_then(Item::as_table);
            let span = key.split('.').next().and_then(|first| tables.and_then(|table| table.key(first)?.span()));
            wrong(Wrong::at(span, reason).in_key(key).in_key("serve"))
        };
        Self::checked(table, file.parent().unwrap_or(Path::new("")), overrides, &refuse)
    }

    fn checked(
        table: Serve,
        folder: &Path,
        overrides: &Overrides,
        refuse: &dyn Fn(&str, String) -> ServeError,
    ) -> Result<Self, ServeError> {
        let name = match &overrides.name {
            Some(name) => {
                name.parse::<HandName>().map_err(|error| ServeError::argument("--name", name, error.to_string()))?
            }
            None => {
                let name = &table.name;
                name.parse().map_err(|error| refuse("name", format!("\"{name}\": {error}")))?
            }
        };
        table.check_numbers(refuse)?;
        let endpoints = |key: &str, texts: &[String]| {
            texts.iter().map(|text| text.parse().map_err(|reason| refuse(key, reason))).collect::<Result<Vec<_>, _>>()
        };
        let connect: Vec<Endpoint> = endpoints("connect", &table.connect)?;
        let listen = match (&overrides.listen[..], &table.listen) {
            ([], Some(listen)) => endpoints("listen", listen)?,
            ([], None) if connect.is_empty() => endpoints("listen", &[LOOPBACK.into()])?,
            ([], None) => Vec::new(),
            (listen, _) => {
                let endpoint =
                    |text: &String| text.parse().map_err(|reason| ServeError::argument("--listen", text, reason));
                listen.iter().map(endpoint).collect::<Result<_, _>>()?
            }
        };
        if listen.is_empty() && connect.is_empty() {
            return Err(refuse("listen", format!("is empty, and so is connect: set listen = [\"{LOOPBACK}\"]")));
        }
        let clients = table.clients.iter().map(|(client, &permission)| match client_name(client) {
            Ok(name) => Ok((name, permission)),
            Err(reason) => Err(refuse("clients", format!("\"{client}\": {reason}"))),
        });
        let clients = clients.collect::<Result<_, _>>()?;
        let tls = table.tls.as_ref().map(|files| TlsFiles {
            authority: folder.join(&files.authority),
            certificate: folder.join(&files.certificate),
            key: folder.join(&files.key),
        });
        for endpoint in listen.iter().chain(&connect) {
            endpoint.check(tls.is_some()).map_err(|reason| match reason {
                Some(reason) if !listen.contains(endpoint) => refuse("connect", reason),
                Some(reason) if overrides.listen.is_empty() => refuse("listen", reason),
                Some(reason) => ServeError::argument("--listen", &endpoint.to_string(), reason),
                None => ServeError::NotLoopback { endpoint: endpoint.to_string() },
            })?;
        }
        Ok(Self { name, listen, connect, limits: table.limits(), clients, tls })
    }
}

/// Reads the name of a client.
///
/// # Errors
/// Returns the reason if this is not a name, or if [`check_client`] refuses it.
pub fn client_name(text: &str) -> Result<ClientName, String> {
    let name = text.parse::<ClientName>().map_err(|error| error.to_string())?;
    check_client(&name).map(|()| name)
}

/// Checks that this client's certificate files, which are named after the client, are not hidden.
///
/// # Errors
/// Returns the reason if the name begins with a dot.
pub fn check_client(name: &ClientName) -> Result<(), String> {
    match name.as_str().starts_with('.') {
        true => Err("the name begins with `.`, so the files of its certificate are hidden: choose another name".into()),
        false => Ok(()),
    }
}

impl Serve {
    fn limits(&self) -> Limits {
        let &Self { catch_ms, end_ms, soft_stiffness, lead_force, .. } = self;
        Limits { catch_ms, end_ms, soft_stiffness, lead_force }
    }

    fn check_numbers(&self, refuse: &dyn Fn(&str, String) -> ServeError) -> Result<(), ServeError> {
        if !(10..=10_000).contains(&self.catch_ms) {
            return Err(refuse("catch_ms", format!("{} ms is outside 10 to 10000 ms", self.catch_ms)));
        }
        if !(self.catch_ms..=60_000).contains(&self.end_ms) {
            let reason = format!("{} ms is outside {} ms (catch_ms) to 60000 ms", self.end_ms, self.catch_ms);
            return Err(refuse("end_ms", reason));
        }
        if !(0.0..=1000.0).contains(&self.soft_stiffness) {
            let reason = format!("{} N/cm is outside 0 to 1000 N/cm", self.soft_stiffness);
            return Err(refuse("soft_stiffness", reason));
        }
        if !(0.1..=1000.0).contains(&self.lead_force) {
            return Err(refuse("lead_force", format!("{} N is outside 0.1 to 1000 N", self.lead_force)));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;

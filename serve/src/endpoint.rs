//! Endpoints: where a server listens, or to what it connects.

use std::fmt;
use std::net::SocketAddr;
use std::str::FromStr;

/// An endpoint: `tcp/HOST:PORT` or `tls/HOST:PORT`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Endpoint {
    tls: bool,
    /// Host and port.
    address: String,
}

impl Endpoint {
    /// Checks that the endpoint agrees with the configuration of TLS.
    ///
    /// # Errors
    /// Returns the reason. Returns `None` in place of a reason if there is no TLS and other machines can reach the
    /// endpoint.
    pub fn check(&self, tls: bool) -> Result<(), Option<String>> {
        match (self.tls, tls) {
            (true, true) => Ok(()),
            (true, false) => Err(Some(format!(
                "{self} needs the table [serve.tls], which is missing: make certificates with `sun2xp serve \
                 --make-certificates FOLDER --server NAME --client NAME`, and name them in [serve.tls]"
            ))),
            (false, true) => Err(Some(format!(
                "{self} is without TLS, and [serve.tls] is set, so every connection needs certificates: use tls/{}",
                self.address
            ))),
            (false, false) if self.is_loopback() => Ok(()),
            (false, false) => Err(None),
        }
    }

    /// Returns whether only programs on this machine can reach the endpoint.
    fn is_loopback(&self) -> bool {
        match self.address.parse::<SocketAddr>() {
            Ok(address) => address.ip().is_loopback(),
            Err(_) => self.address.rsplit_once(':').is_some_and(|(host, _)| host == "localhost"),
        }
    }
}

impl FromStr for Endpoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is no endpoint: use tls/HOST:PORT, or tcp/127.0.0.1:PORT on this machine");
        let (tls, address) = match text.split_once('/') {
            Some(("tcp", address)) => (false, address),
            Some(("tls", address)) => (true, address),
            _ => return Err(wrong()),
        };
        let plain = |byte: u8| byte.is_ascii_alphanumeric() || b".-_:[]".contains(&byte);
        let (host, port) = address.rsplit_once(':').ok_or_else(wrong)?;
        if host.is_empty() || !address.bytes().all(plain) || port.parse::<u16>().is_err() {
            return Err(wrong());
        }
        Ok(Self { tls, address: address.into() })
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", if self.tls { "tls" } else { "tcp" }, self.address)
    }
}

//! Decides who may read the page. A request must go to the address of the server, and may only come from a page of this
//! address. A request for data must also contain the token if there is one.
//!
//! A foreign page in the user's browser can send requests to loopback too. The browser names that page in `Origin`, so
//! a request with another origin is refused. A foreign name that resolves to loopback (DNS rebinding) makes the foreign
//! page a page of this address, so a request whose `Host` is another name is refused as well.

use axum::http::HeaderMap;
use axum::http::header::{HOST, ORIGIN};
use std::fmt::Write;
use std::net::{IpAddr, Ipv6Addr, SocketAddr};

/// Number of random bytes of a token.
const TOKEN_BYTES: usize = 16;

/// What requests must contain.
#[derive(Clone, Debug)]
pub struct Access {
    /// The address of the server.
    pub address: SocketAddr,
    /// The token that every request for data must contain. It is none if the server listens on loopback and its pages
    /// may not move the hand.
    pub token: Option<String>,
    /// The name of this machine.
    pub machine: Option<String>,
}

/// Why a request is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `Host` is missing, occurs more than once, or is not a name of this server.
    Host,
    /// `Origin` names another page, or it occurs more than once.
    Origin,
    /// The token is missing or wrong.
    Token,
}

impl Refusal {
    /// Returns the text of the response.
    pub fn text(self) -> &'static str {
        match self {
            Self::Host => {
                "Refused: the Host of the request is not the address that sun2xp has printed. Open that address.\n"
            }
            Self::Origin => "Refused: the request comes from another page. Open the address that sun2xp has printed.\n",
            Self::Token => "Refused: the token is missing or wrong. Open the address that sun2xp has printed.\n",
        }
    }
}

impl Access {
    /// Checks `Host` and `Origin`.
    pub fn check(&self, headers: &HeaderMap) -> Result<(), Refusal> {
        let host = only(headers, HOST.as_str()).ok_or(Refusal::Host)?;
        if !self.is_own(host) {
            return Err(Refusal::Host);
        }
        if !headers.contains_key(ORIGIN) {
            // A foreign page cannot read data with a request without `Origin`: a browser sends `Origin` with every
            // WebSocket, and with every request whose response a page of another origin could read.
            return Ok(());
        }
        let own = only(headers, ORIGIN.as_str()).and_then(|origin| origin.strip_prefix("http://"));
        if own.is_some_and(|origin| origin.eq_ignore_ascii_case(host)) { Ok(()) } else { Err(Refusal::Origin) }
    }

    /// Checks the token of a request for data.
    pub fn check_token(&self, given: Option<&str>) -> Result<(), Refusal> {
        match &self.token {
            Some(token) if !given.is_some_and(|given| equal(given.as_bytes(), token.as_bytes())) => Err(Refusal::Token),
            _ => Ok(()),
        }
    }

    fn is_own(&self, host: &str) -> bool {
        let (name, port) = match host.rsplit_once(':') {
            Some((name, port)) if !port.contains(']') => (name, port.parse().ok()),
            _ => (host, Some(80)),
        };
        if port != Some(self.address.port()) {
            return false;
        }
        let bracketed = name.strip_prefix('[').and_then(|name| name.strip_suffix(']'));
        let address = match bracketed {
            Some(name) => name.parse::<Ipv6Addr>().ok().map(IpAddr::V6),
            None => name.parse().ok().filter(IpAddr::is_ipv4),
        };
        let loopback = self.address.ip().is_loopback();
        match address {
            // A numerical address needs no DNS, so it cannot have been rebound.
            Some(address) => !loopback || address.is_loopback(),
            None => name.eq_ignore_ascii_case("localhost") || !loopback && self.is_machine(name),
        }
    }

    fn is_machine(&self, name: &str) -> bool {
        let name = name.strip_suffix(".local").unwrap_or(name);
        self.machine.as_ref().is_some_and(|machine| name.eq_ignore_ascii_case(machine))
    }
}

/// Returns the value of a header. Returns none if the header does not occur exactly once.
fn only<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

/// Compares in a time that does not depend on where the first difference is.
fn equal(left: &[u8], right: &[u8]) -> bool {
    left.len() == right.len() && left.iter().zip(right).fold(0, |difference, (a, b)| difference | (a ^ b)) == 0
}

/// Returns a new token.
pub fn new_token() -> Result<String, getrandom::Error> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a String cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// Returns the name of this machine.
pub fn machine() -> Option<String> {
    let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok()?;
    Some(name.trim().to_owned()).filter(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn access(address: &str) -> Access {
        let address = address.parse().expect("an address");
        Access { address, token: Some("0123abcd".into()), machine: Some("bench".into()) }
    }

    fn headers(host: &str, origin: Option<&str>) -> HeaderMap {
        let mut headers = HeaderMap::new();
        headers.insert(HOST, host.parse().expect("a value"));
        if let Some(origin) = origin {
            headers.insert(ORIGIN, origin.parse().expect("a value"));
        }
        headers
    }

    #[test]
    fn only_names_of_loopback_reach_a_server_on_loopback() {
        let access = access("127.0.0.1:8080");
        for host in ["127.0.0.1:8080", "localhost:8080", "LOCALHOST:8080", "[::1]:8080", "127.0.0.9:8080"] {
            assert_eq!(access.check(&headers(host, None)), Ok(()), "{host}");
        }
        for host in [
            "evil.example:8080",
            "localhost.evil.example:8080",
            "localhost:8081",
            "localhost",
            "192.168.1.7:8080",
            "bench:8080",
            "127.0.0.1.evil.example:8080",
            "127.0.0.1:8080:8080",
            "::1:8080",
            "[127.0.0.1]:8080",
            "",
            "[::1]",
        ] {
            assert_eq!(access.check(&headers(host, None)), Err(Refusal::Host), "{host}");
        }
        assert_eq!(access.check(&HeaderMap::new()), Err(Refusal::Host));
        let mut twice = headers("localhost:8080", None);
        twice.append(HOST, "evil.example:8080".parse().expect("a value"));
        assert_eq!(access.check(&twice), Err(Refusal::Host));
    }

    #[test]
    fn names_of_the_machine_reach_a_server_on_all_addresses() {
        let access = access("0.0.0.0:8080");
        for host in ["192.168.1.7:8080", "bench:8080", "Bench.local:8080", "[fe80::1]:8080", "localhost:8080"] {
            assert_eq!(access.check(&headers(host, None)), Ok(()), "{host}");
        }
        for host in ["evil.example:8080", "bench.evil.example:8080", "bench:80"] {
            assert_eq!(access.check(&headers(host, None)), Err(Refusal::Host), "{host}");
        }
    }

    #[test]
    fn only_pages_of_this_address_are_origins() {
        let access = access("127.0.0.1:8080");
        let check = |origin| access.check(&headers("localhost:8080", Some(origin)));
        assert_eq!(check("http://localhost:8080"), Ok(()));
        for origin in [
            "http://evil.example",
            "https://localhost:8080",
            "http://localhost:9090",
            "http://127.0.0.1:8080",
            "null",
            "",
        ] {
            assert_eq!(check(origin), Err(Refusal::Origin), "{origin}");
        }
    }

    #[test]
    fn the_token_must_be_complete_and_right() {
        let access = access("0.0.0.0:8080");
        assert_eq!(access.check_token(Some("0123abcd")), Ok(()));
        for given in [None, Some(""), Some("0123abc"), Some("0123abce"), Some("0123abcd0")] {
            assert_eq!(access.check_token(given), Err(Refusal::Token), "{given:?}");
        }
        let tokens = [new_token().expect("random bytes"), new_token().expect("random bytes")];
        assert_ne!(tokens[0], tokens[1]);
        assert!(tokens.iter().all(|token| token.len() == 2 * TOKEN_BYTES));
    }
}

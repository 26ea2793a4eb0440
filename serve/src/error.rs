//! The errors of the server, each with its cause and its remedy.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use sun2xp::model::Shown;
use sun2xp::realtime::with_remedy;
use sun2xp::{ConfigurationError, HandError};
use thiserror::Error;

/// Why the server does not start, or has ended.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ServeError {
    /// The configuration of the hand cannot be used.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The table `[serve]` cannot be used.
    #[error("{}{}: {reason}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Settings {
        /// The file.
        file: PathBuf,
        /// The line, if it is known.
        line: Option<usize>,
        /// What is wrong, with the remedy.
        reason: String,
    },
    /// An endpoint in `listen` or `connect` that other machines can reach is configured without TLS.
    #[error(
        "{endpoint} needs TLS, because other machines can reach this address: make certificates with `sun2xp \
         serve --make-certificates FOLDER --server NAME --client NAME`, name them in [serve.tls], and use \
         tls/HOST:PORT; or use tcp/127.0.0.1:PORT"
    )]
    NotLoopback {
        /// The endpoint.
        endpoint: String,
    },
    /// The hand cannot be opened.
    #[error(transparent)]
    Hand(#[from] HandError),
    /// The network cannot be used.
    #[error("cannot {doing}: {reason}")]
    Network {
        /// What the server was doing, with the endpoint.
        doing: String,
        /// The cause, with the remedy if there is one.
        reason: String,
    },
    /// A certificate cannot be made, read or written.
    #[error("{}: {reason}", path.display())]
    Certificate {
        /// The file, or the folder of the certificates.
        path: PathBuf,
        /// What is wrong, with the remedy.
        reason: String,
    },
    /// An argument of the command line cannot be used.
    #[error("{option} \"{text}\": {reason}")]
    Argument {
        /// The option.
        option: &'static str,
        /// The beginning of what was given, with invisible characters escaped.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The system refuses something.
    #[error("cannot {doing}: {reason}")]
    System {
        /// What the server was doing.
        doing: &'static str,
        /// The system's reason.
        reason: String,
    },
}

impl ServeError {
    /// The error if the system refuses an operation that needs a thread or a descriptor.
    pub(crate) fn refused(doing: &'static str, error: &io::Error) -> Self {
        Self::System { doing, reason: with_remedy(error) }
    }

    /// The error for an argument of the command line. `text` is what was given.
    pub(crate) fn argument(option: &'static str, text: &str, reason: impl Into<String>) -> Self {
        Self::Argument { option, text: Shown(text).to_string(), reason: reason.into() }
    }

    /// The error for a key that Zenoh refuses to declare.
    pub(crate) fn undeclared(key: &str, error: impl Display) -> Self {
        let reason = format!("{error}. Start the server again. If this happens again, please report this defect");
        Self::Network { doing: format!("declare the Zenoh key {key}"), reason }
    }

    /// The error about this file of a certificate, or about the folder of the certificates.
    pub(crate) fn certificate(path: &Path, reason: impl ToString) -> Self {
        Self::Certificate { path: path.into(), reason: reason.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refused_thread_has_a_remedy() {
        let refused = ServeError::refused("start a thread", &io::Error::from_raw_os_error(libc::EAGAIN)).to_string();
        assert!(refused.starts_with("cannot start a thread: ") && refused.contains("(ulimit -u)"), "{refused}");
    }

    #[test]
    fn a_refused_key_has_a_remedy() {
        let refused = ServeError::undeclared("sun2xp/left/state", "the session is closed").to_string();
        assert!(refused.starts_with("cannot declare the Zenoh key sun2xp/left/state: the session is"), "{refused}");
        assert!(refused.contains(". Start the server again"), "{refused}");
    }
}

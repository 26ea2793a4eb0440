//! The errors of a configuration.

use crate::files::{errno, write_remedy};
use crate::model::FingerNumber;
use crate::model::configuration::Unusable;
use crate::model::{Shown, ShownPath, UnusableConfiguration};
use std::path::PathBuf;
use thiserror::Error;

/// A configuration that cannot be read, used, changed or stored.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ConfigurationError {
    /// The configuration file cannot be read.
    #[error(
        "cannot read the configuration file {}: {source}. The file must exist if SUN2XP_CONFIG, an option or a call \
         names it. It must be a text file of at most 1 MiB that this user may read",
        ShownPath(path)
    )]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error that the system reported.
        source: std::io::Error,
    },
    /// The environment names a configuration file, but the program has raised privileges.
    #[error(
        "SUN2XP_CONFIG names {}, but this program is setuid or setgid, or has capabilities, and therefore does not \
         trust its environment: unset SUN2XP_CONFIG, and describe the hand in {system}",
        ShownPath(path)
    )]
    UntrustedEnvironment {
        /// The file that the environment names.
        path: PathBuf,
        /// The file that such a program reads.
        system: &'static str,
    },
    /// The configuration file or text has an error.
    #[error("{}{}: {reason}", ShownPath(file), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Invalid {
        /// The file, or `configuration text`.
        file: PathBuf,
        /// The line of the error, counted from 1; none if the error belongs to no line.
        line: Option<usize>,
        /// What is wrong.
        reason: String,
    },
    /// The configuration names a hand on another machine, and the call opens only hands of this machine.
    #[error(
        "{} has a table [remote], which names a hand on another machine, and only hands of this machine can be opened \
         here: run the command on the machine of the hand, open the hand with sun2xp.remote.open in Python or with \
         RemoteHand in Rust, or remove the table",
        ShownPath(file)
    )]
    Remote {
        /// The configuration file.
        file: PathBuf,
    },
    /// A configuration cannot be used: a program has made or changed it with an error, or it does not fit the hardware
    /// or the folders of this machine.
    #[error("{section}.{unusable}")]
    Unusable {
        /// `hand`, `telemetry`, or `finger.1` to `finger.3`.
        section: String,
        /// The key and the reason.
        unusable: Unusable,
    },
    /// The text with the keys to adjust has an error.
    #[error("finger {finger}, line {line} of the keys to adjust: {reason}")]
    Adjustment {
        /// The finger.
        finger: FingerNumber,
        /// Number of the line, counted from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// The key cannot change while the hand is open.
    #[error(
        "`{key}` cannot change while the hand is open: close the hand, change the configuration file and open the hand \
         again"
    )]
    Permanent {
        /// The path of the key with dots, relative to the finger.
        key: String,
    },
    /// The configuration file cannot be written.
    #[error("cannot write to the configuration file {}: {source}{}", ShownPath(path), write_remedy(source))]
    Unwritable {
        /// The configuration file.
        path: PathBuf,
        /// The error that the system reported.
        source: std::io::Error,
    },
    /// A calibration does not match the configuration file: a key on which it depends had another value in the hand.
    #[error(
        "the calibration does not match {}: {key} is {} there, and was {} during the calibration. Nothing was written. \
         If the file is wrong, correct it; if it is right, close the hand and open it again. Then calibrate again",
        ShownPath(path),
        Shown(is),
        Shown(was)
    )]
    Mismatch {
        /// The configuration file.
        path: PathBuf,
        /// The key that differs.
        key: String,
        /// Its value during the calibration.
        was: String,
        /// Its value in the file.
        is: String,
    },
}

impl ConfigurationError {
    /// The errno that the system reported, or the one that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            // There is no errno of the system if the path leads to no regular file, or if the file is too large or not
            // text.
            Self::Unreadable { source, .. } => source.raw_os_error().unwrap_or(libc::EINVAL),
            Self::UntrustedEnvironment { .. } => libc::EACCES,
            Self::Invalid { .. } | Self::Remote { .. } | Self::Unusable { .. } => libc::EINVAL,
            Self::Adjustment { .. } | Self::Mismatch { .. } => libc::EINVAL,
            Self::Permanent { .. } => libc::EBUSY,
            Self::Unwritable { source, .. } => errno(source),
        }
    }
}

impl From<UnusableConfiguration> for ConfigurationError {
    fn from(refusal: UnusableConfiguration) -> Self {
        Self::Unusable { section: refusal.section.to_string(), unusable: refusal.unusable }
    }
}

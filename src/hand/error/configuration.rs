//! Why a configuration cannot be read, used, changed or stored.

use crate::files::errno;
use crate::model::configuration::Unusable;
use crate::model::{Shown, ShownPath, UnusableConfiguration};
use std::path::PathBuf;
use thiserror::Error;

/// A configuration that cannot be read, used, changed or stored.
#[derive(Debug, Error)]
pub enum ConfigurationError {
    /// A configuration file cannot be read.
    #[error(
        "cannot read the configuration file {}: {source}. It must be a text file of at most 1 MiB that this \
         user can read; where SUN2XP_CONFIG names one it must exist",
        ShownPath(path)
    )]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A configuration file that the environment names, in a program with raised privileges.
    #[error(
        "SUN2XP_CONFIG names {}, but this program is setuid or setgid, or has capabilities, and does not trust its \
         environment: unset SUN2XP_CONFIG, and describe the hand in {system}",
        ShownPath(path)
    )]
    UntrustedEnvironment {
        /// What the environment names.
        path: PathBuf,
        /// The file that is read instead.
        system: &'static str,
    },
    /// A configuration that cannot be used.
    #[error("{}{}: {reason}", ShownPath(file), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Invalid {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1, where the key stands in the file.
        line: Option<usize>,
        /// What is wrong with it.
        reason: String,
    },
    /// A configuration made in a program that cannot be used.
    #[error("{section}.{}: {}", unusable.key, unusable.reason)]
    Unusable {
        /// `hand`, or `finger.1` to `finger.3`.
        section: String,
        /// The key and the reason.
        unusable: Unusable,
    },
    /// Keys to adjust that cannot be read.
    #[error("finger {finger}, line {line} of the keys to adjust: {reason}")]
    Adjustment {
        /// 1 to 3.
        finger: i32,
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// A key that cannot change while the hand is open.
    #[error("`{key}` cannot change while the hand is open: CloseHand, change the configuration file, OpenHand")]
    Permanent {
        /// With dots, relative to the finger.
        key: String,
    },
    /// What was found cannot be written.
    #[error(
        "cannot write into the configuration file {}: {source}. This user must be able to write the file and its \
         folder",
        ShownPath(path)
    )]
    Unwritable {
        /// The configuration file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// What was found holds for something else than the configuration file now says.
    #[error(
        "what was found does not belong to {}: {key} is {} there, and was {} when it was found. Nothing was written: \
         make the two agree and find it again",
        ShownPath(path),
        Shown(is),
        Shown(was)
    )]
    Mismatch {
        /// The configuration file.
        path: PathBuf,
        /// The key that differs.
        key: String,
        /// Its value when it was found.
        was: String,
        /// Its value in the file.
        is: String,
    },
}

impl ConfigurationError {
    /// The nearest errno.
    pub fn errno(&self) -> i32 {
        match self {
            // The file was read but is not text if the error has no errno of the system.
            Self::Unreadable { source, .. } => source.raw_os_error().unwrap_or(libc::EINVAL),
            Self::UntrustedEnvironment { .. } => libc::EACCES,
            Self::Invalid { .. } | Self::Unusable { .. } => libc::EINVAL,
            Self::Adjustment { .. } | Self::Mismatch { .. } => libc::EINVAL,
            Self::Permanent { .. } => libc::EBUSY,
            Self::Unwritable { source, .. } => errno(source),
        }
    }
}

impl From<UnusableConfiguration> for ConfigurationError {
    fn from(refusal: UnusableConfiguration) -> Self {
        let section = refusal.finger.map_or("hand".into(), |index| format!("finger.{}", index + 1));
        Self::Unusable { section, unusable: refusal.unusable }
    }
}

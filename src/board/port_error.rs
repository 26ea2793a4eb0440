//! The errors of a serial port.

use crate::model::ShownPath;
use crate::realtime::remedy;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// What is wrong with a port.
#[derive(Debug, Error)]
pub enum PortError {
    /// The path does not exist (ENOENT).
    #[error("{} does not exist: check the cable, the board's power and finger.port (ls -l \
             /dev/serial/by-id)", ShownPath(.0))]
    Missing(PathBuf),
    /// The user may not open the port (EACCES).
    #[error("no permission to open {}: add the user to the port's group (usually dialout) and log in \
             again", ShownPath(.0))]
    Forbidden(PathBuf),
    /// Another program, or another hand of this program, uses the port (EBUSY).
    #[error(
        "{path} is in use by another program or another hand of this program: end that program (fuser -v {path} names \
         it), close that hand, or configure another port",
        path = ShownPath(.0)
    )]
    Busy(PathBuf),
    /// The driver does not open the port yet (EAGAIN). A UART takes up to 30 s to close if bytes cannot leave.
    #[error(
        "{} is not ready, because it is still being closed after its last use, or its driver is still starting: open \
         it again after half a minute. If it is not ready then, unplug and replug the adapter",
        ShownPath(.0)
    )]
    NotReady(PathBuf),
    /// The file is not a serial port (ENOTTY).
    #[error("{} is not a serial port: check finger.port", ShownPath(.0))]
    NotASerialPort(PathBuf),
    /// The adapter does not support the baud rate (EINVAL).
    #[error(
        "{} cannot run at {wanted} baud and selected {offered} instead: set finger.baud to a rate that the adapter \
         supports",
        ShownPath(path)
    )]
    Baud {
        /// The port.
        path: PathBuf,
        /// The configured rate, bit/s.
        wanted: u32,
        /// The rate that the driver selected, bit/s.
        offered: u32,
    },
    /// Another reason why the port cannot be opened.
    #[error("cannot open {}: {}", ShownPath(path), opening(source))]
    Opening {
        /// The port.
        path: PathBuf,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The port is open, but cannot be configured.
    #[error(
        "cannot set up {}: {}. Check finger.port and finger.baud, and the adapter's driver (dmesg)",
        ShownPath(path),
        with_remedy_at_port(source)
    )]
    SetUp {
        /// The port.
        path: PathBuf,
        /// The error that the system reported.
        source: io::Error,
    },
    /// The port hung up (EIO).
    #[error(
        "the port no longer exists: the cable was unplugged, the adapter or the board lost its power, or the simulated \
         board has ended. Restore the connection"
    )]
    Vanished,
    /// The descriptor is closed, or its number now belongs to another file (EBADF).
    #[error("another part of this program has closed the descriptor of the port. Close the hand and open it again")]
    Closed,
    /// Hardware that the program provides does not start or stop.
    #[error(
        "the hardware that the program provides failed to {doing}: {source}. Check its power and its cables, end other \
         programs that use it, and look up this error in the documentation of the program or of its hardware"
    )]
    Hardware {
        /// "start" or "stop".
        doing: &'static str,
        /// The error that the program reported.
        source: io::Error,
    },
    /// A read or write failed.
    #[error("reading or writing the port failed: {}", failing(.0))]
    Failed(io::Error),
}

impl PortError {
    /// Returns the cause and the remedy in few words, for a list of ports at which no board was found.
    pub(super) fn in_short(&self) -> String {
        match self {
            PortError::Missing(_) => "does not exist: check the cable".into(),
            PortError::Forbidden(_) => "no permission: join the port's group (usually dialout)".into(),
            PortError::Busy(_) => "in use by another program or hand: end or close it".into(),
            PortError::NotReady(_) => "not ready: try again after half a minute".into(),
            PortError::NotASerialPort(_) => "not a serial port: name another port".into(),
            PortError::Baud { wanted, .. } => format!("cannot run at {wanted} bit/s: choose another bit rate"),
            PortError::Opening { source, .. }
            | PortError::SetUp { source, .. }
            | PortError::Hardware { source, .. }
            | PortError::Failed(source) => format!("{source}: {}", short_remedy(source)),
            PortError::Vanished => "disappeared: check the cable".into(),
            PortError::Closed => "this program has closed its descriptor: search again".into(),
        }
    }

    /// Returns the errno of the error. If the description of the variant names an errno, it is this one, whatever the
    /// system reported. For example, errno is EIO if the device of an open port disappears, and ENOTTY, not EISDIR, if
    /// the path is a folder. The other variants keep the errno of the system, or have EIO if there is none.
    pub fn errno(&self) -> i32 {
        match self {
            PortError::Missing(_) => libc::ENOENT,
            PortError::Forbidden(_) => libc::EACCES,
            PortError::Busy(_) => libc::EBUSY,
            PortError::NotReady(_) => libc::EAGAIN,
            PortError::NotASerialPort(_) => libc::ENOTTY,
            PortError::Baud { .. } => libc::EINVAL,
            PortError::Vanished => libc::EIO,
            PortError::Closed => libc::EBADF,
            PortError::Opening { source, .. }
            | PortError::SetUp { source, .. }
            | PortError::Hardware { source, .. }
            | PortError::Failed(source) => source.raw_os_error().unwrap_or(libc::EIO),
        }
    }

    /// Returns why the file at `path` could not be opened.
    pub(super) fn at_opening(path: &Path, source: io::Error) -> Self {
        let path = path.to_owned();
        match source.raw_os_error() {
            Some(libc::ENOENT) => Self::Missing(path),
            Some(libc::EACCES) => Self::Forbidden(path),
            // The program that has the port open has marked it for exclusive use.
            Some(libc::EBUSY) => Self::Busy(path),
            Some(libc::EAGAIN) => Self::NotReady(path),
            Some(libc::ENOTTY | libc::EISDIR) => Self::NotASerialPort(path),
            _ => Self::Opening { path, source },
        }
    }
}

/// Why a read or a write failed.
impl From<io::Error> for PortError {
    fn from(source: io::Error) -> Self {
        match source.raw_os_error() {
            // The driver of a removed adapter reports one of these errors. Drivers differ in which one.
            Some(libc::EIO | libc::ENXIO | libc::ENODEV) => Self::Vanished,
            Some(libc::EBADF) => Self::Closed,
            _ => Self::Failed(source),
        }
    }
}

fn opening(source: &io::Error) -> String {
    match source.raw_os_error() {
        Some(libc::ENXIO | libc::ENODEV) => {
            format!("{source}: no device belongs to it. Check the cable, the adapter's driver (dmesg) and finger.port")
        }
        Some(libc::EIO) => format!("{source}: the adapter does not respond. Unplug and replug it"),
        _ => match remedy_at_port(source) {
            Some(remedy) => format!("{source}: {remedy}"),
            None => format!("{source}. Check finger.port"),
        },
    }
}

fn with_remedy_at_port(source: &io::Error) -> String {
    match remedy_at_port(source) {
        Some(remedy) => format!("{source}: {remedy}"),
        None => source.to_string(),
    }
}

fn failing(source: &io::Error) -> String {
    match remedy_at_port(source) {
        Some(remedy) => format!("{source}: {remedy}"),
        None => format!("{source}. Unplug and replug the adapter"),
    }
}

/// Returns the result of [`remedy`], but none for EAGAIN. [`remedy`] explains EAGAIN by a limit of threads or memory,
/// which is not its cause at a port: no call at a port creates a thread.
fn remedy_at_port(source: &io::Error) -> Option<&'static str> {
    if source.raw_os_error() == Some(libc::EAGAIN) { None } else { remedy(source) }
}

/// The remedy in few words.
fn short_remedy(source: &io::Error) -> &'static str {
    match source.raw_os_error() {
        Some(libc::EMFILE) => "close files of this process",
        Some(libc::ENFILE) => "end other programs",
        Some(libc::ENOMEM) => "free memory",
        Some(libc::EPERM | libc::ENOSYS) => "permit it in the sandbox or container",
        _ => "check the adapter",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_failure_of_the_adapter_is_answered_by_unplugging_it() {
        for (errno, unplug) in [(libc::EPROTO, true), (libc::EAGAIN, true), (libc::EPERM, false), (libc::ENOSYS, false)]
        {
            let text = PortError::from(io::Error::from_raw_os_error(errno)).to_string();
            assert_eq!((text.contains("Unplug"), text.contains("sandbox")), (unplug, !unplug), "{text}");
        }
    }

    #[test]
    fn each_of_these_errnos_is_kept_and_its_text_has_a_remedy() {
        for (errno, word) in [
            (libc::ENOENT, "check the cable"),
            (libc::EACCES, "dialout"),
            (libc::EBUSY, "fuser"),
            (libc::ENOTTY, "finger.port"),
            (libc::EAGAIN, "not ready"),
            (libc::EMFILE, "ulimit -n"),
            (libc::ENFILE, "fs.file-max"),
            (libc::ENXIO, "no device"),
            (libc::ENODEV, "no device"),
            (libc::EIO, "Unplug and replug"),
            (libc::ENOMEM, "memory"),
            (libc::EPERM, "container"),
            (libc::ENOTDIR, "Check finger.port"),
            (libc::ELOOP, "Check finger.port"),
        ] {
            let error = PortError::at_opening(Path::new("/dev/port"), io::Error::from_raw_os_error(errno));
            assert_eq!(error.errno(), errno, "{error}");
            assert!(error.to_string().contains("/dev/port") && error.to_string().contains(word), "{error}");
        }
    }

    /// Limits of threads affect only calls that start a thread. Limits of pseudo-terminals affect only calls that open
    /// a pseudo-terminal.
    #[test]
    fn no_error_of_a_port_is_explained_by_a_limit_of_threads_or_of_pseudo_terminals() {
        let path = PathBuf::from("/dev/port");
        for errno in [libc::EAGAIN, libc::ENOSPC] {
            let refused = || io::Error::from_raw_os_error(errno);
            for error in [
                PortError::at_opening(&path, refused()),
                PortError::SetUp { path: path.clone(), source: refused() },
                PortError::from(refused()),
            ] {
                let text = error.to_string();
                assert!(!["thread", "ulimit", "pseudo-terminal"].iter().any(|word| text.contains(word)), "{text}");
                assert_eq!(error.errno(), errno, "{text}");
            }
        }
    }

    #[test]
    fn a_limit_of_the_process_is_not_answered_by_checking_the_adapter() {
        let short =
            |errno| PortError::at_opening(Path::new("/dev/port"), io::Error::from_raw_os_error(errno)).in_short();
        assert!(short(libc::EMFILE).ends_with(": close files of this process"), "{}", short(libc::EMFILE));
        assert!(short(libc::EPROTO).ends_with(": check the adapter"), "{}", short(libc::EPROTO));
    }
}

//! Failures of the tool's commands, and its exit statuses.

use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use sun2xp::files::write_remedy;
use sun2xp::model::{ShownPath, one_line};

/// The reason why a command failed. The tool prints its text, which names cause and remedy, in one line.
pub type Failure = Box<dyn Error>;

/// The exit statuses, for the help.
pub const EXIT_STATUSES: &str = "Exit status: 0 if the command has done its work, 1 if it failed, 2 for wrong usage.";

/// The exit status of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExitStatus(pub u8);

impl ExitStatus {
    /// The command has done its work.
    pub const SUCCESS: Self = Self(0);

    /// The command has failed.
    pub const FAILURE: Self = Self(1);

    /// The command line is wrong.
    pub const WRONG_USAGE: Self = Self(2);
}

/// An argument that is wrong in a way that clap cannot find.
#[derive(Debug)]
struct WrongUsage(String);

impl Display for WrongUsage {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Error for WrongUsage {}

/// A failure whose exit status is that of wrong usage.
pub fn wrong_usage(reason: impl Into<String>) -> Failure {
    Box::new(WrongUsage(reason.into()))
}

/// The failure of a file that cannot be written.
pub fn unwritable(path: &Path, error: &io::Error) -> Failure {
    format!("cannot write {}: {error}{}", ShownPath(path), write_remedy(error)).into()
}

/// The failure of a file that cannot be read. Only a missing file and a missing permission get a remedy, because the
/// texts of other errors already show what to change.
pub fn unreadable(path: &Path, error: &io::Error) -> Failure {
    let remedy = match error.kind() {
        ErrorKind::NotFound => ". Name an existing file",
        ErrorKind::PermissionDenied => ". This user needs permission to read the file and to enter its folder",
        _ => "",
    };
    format!("cannot read {}: {error}{remedy}", ShownPath(path)).into()
}

/// Prints a failure, and returns the exit status. A reader that closes the pipe of standard output, such as `head`,
/// needs no message.
pub fn report(failure: &Failure) -> ExitStatus {
    let closed = |error: &io::Error| error.kind() == ErrorKind::BrokenPipe;
    if !failure.downcast_ref().is_some_and(closed) {
        complain(&failure.to_string());
    }
    if failure.is::<WrongUsage>() { ExitStatus::WRONG_USAGE } else { ExitStatus::FAILURE }
}

/// Prints a line on standard error. A line that cannot be written, for example because the reader of the pipe has
/// ended, is lost. It must not change the exit status.
pub fn complain(text: &str) {
    let _ = writeln!(io::stderr(), "sun2xp: {}", one_line(text));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_without_permission_has_a_remedy_and_a_full_disk_needs_none() {
        let text = |kind: ErrorKind| unwritable(Path::new("hand.toml"), &io::Error::from(kind)).to_string();
        let (denied, full) = (text(ErrorKind::PermissionDenied), text(ErrorKind::StorageFull));
        assert!(
            denied
                .starts_with("cannot write hand.toml: permission denied. Give this user permission to write the file"),
            "{denied}"
        );
        assert_eq!(full, "cannot write hand.toml: no storage space");
    }

    #[test]
    fn a_file_that_is_missing_or_forbidden_has_a_remedy() {
        let text = |kind: ErrorKind| unreadable(Path::new("hand.mcap"), &io::Error::from(kind)).to_string();
        assert_eq!(text(ErrorKind::NotFound), "cannot read hand.mcap: entity not found. Name an existing file");
        let denied = text(ErrorKind::PermissionDenied);
        assert!(denied.starts_with("cannot read hand.mcap: permission denied. This user needs permission"), "{denied}");
    }
}

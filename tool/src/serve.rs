//! `sun2xp serve`: offers the hand to planners on other machines. The separate program `sun2xp-serve` does the work, so
//! that the tool does not contain the network library Zenoh.

use crate::failure::{ExitStatus, Failure};
use std::ffi::OsString;
use std::io;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that offers the hand.
const PROGRAM: &str = "sun2xp-serve";

/// Offers the hand to planners on other machines, with the program sun2xp-serve beside this one.
///
/// All options are passed to sun2xp-serve. `sun2xp serve -- --help` lists them.
#[derive(clap::Args)]
pub struct Arguments {
    /// Options of sun2xp-serve, such as --config FILE, --router and --make-certificates FOLDER.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, value_name = "OPTION")]
    options: Vec<OsString>,
}

/// Runs the command. Does not return if sun2xp-serve starts, because it then takes the place of this program. `script`
/// has the same meaning as in [`crate::run_script`].
pub fn run(arguments: &Arguments, script: Option<&Path>) -> Result<ExitStatus, Failure> {
    let program = match script {
        Some(script) => beside(script),
        None => beside(&std::env::current_exe()?),
    };
    let error = Command::new(&program).args(&arguments.options).exec();
    Err(not_started(&program, &error).into())
}

fn not_started(program: &Path, error: &io::Error) -> String {
    let shown = program.display();
    let remedy = "install sun2xp-serve beside sun2xp (cargo build -p sun2xp-serve builds it)";
    match error.kind() {
        io::ErrorKind::NotFound => format!("{shown} is missing: {remedy}"),
        _ => format!("{shown} cannot be started ({error}): make it executable, or {remedy}"),
    }
}

/// The program beside the tool.
fn beside(own: &Path) -> PathBuf {
    own.with_file_name(PROGRAM)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_program_that_does_not_start_has_a_remedy() {
        for (error, cause) in [(libc::ENOENT, "is missing"), (libc::EACCES, "Permission denied")] {
            let text = not_started(Path::new("/bin/sun2xp-serve"), &io::Error::from_raw_os_error(error));
            assert!(text.contains(cause) && text.contains("install sun2xp-serve beside sun2xp"), "{text}");
        }
    }
}

//! The program `sun2xp-serve`, which `sun2xp serve` starts.

#![deny(unsafe_code)]

use clap::Parser;
use std::process::ExitCode;
use sun2xp_serve::arguments::{Arguments, run};
use sun2xp_serve::output::{complain, complain_lines};

/// Exit status for wrong usage.
const WRONG_USAGE: u8 = 2;

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() => {
            // clap would print wrong arguments with their control characters. `complain_lines` escapes these.
            complain_lines(&error.render().to_string());
            return ExitCode::from(WRONG_USAGE);
        }
        Err(help) => {
            // A help text or version that cannot be written is not an error.
            let _ = help.print();
            return ExitCode::SUCCESS;
        }
    };
    match run(arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error.to_string());
            ExitCode::FAILURE
        }
    }
}

//! The program `sun2xp`.

#![deny(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(sun2xp_tool::run(std::env::args_os()))
}

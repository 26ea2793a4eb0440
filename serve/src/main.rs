//! The program `sun2xp-serve`, which `sun2xp serve` starts.

#![deny(unsafe_code)]

use clap::Parser;
use std::process::ExitCode;
use sun2xp::model::one_line;
use sun2xp_serve::arguments::{Arguments, run};

fn main() -> ExitCode {
    match run(Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("sun2xp-serve: {}", one_line(&error.to_string()));
            ExitCode::FAILURE
        }
    }
}

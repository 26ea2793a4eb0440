//! The tool beside the library.

#![deny(unsafe_code)]

mod board;
mod board_faults;
mod calibrate;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Tools for a hand that the sun2xp library drives.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    tool: Tool,
}

// There is one of it in a process.
#[allow(clippy::large_enum_variant)]
#[derive(Subcommand)]
enum Tool {
    Board(board::Arguments),
    Calibrate(calibrate::Arguments),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().tool {
        Tool::Board(arguments) => board::run(&arguments),
        Tool::Calibrate(arguments) => calibrate::run(&arguments),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("sun2xp: {error}");
            ExitCode::FAILURE
        }
    }
}

//! The command-line tool of the library.

#![deny(unsafe_code)]

mod board;
mod bound;
mod calibrate;
mod doctor;
mod failure;
mod jog;
mod model;
mod replay;
mod schedule;

use clap::{Parser, Subcommand};
use std::process::ExitCode;
use sun2xp::model::one_line;

/// Tools for a hand that the sun2xp library drives.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    tool: Tool,
}

// A process has only one value of this type, so its size does not matter.
#[allow(clippy::large_enum_variant)]
#[derive(Subcommand)]
enum Tool {
    Board(board::Arguments),
    Bound(bound::Arguments),
    Calibrate(calibrate::Arguments),
    Doctor(doctor::Arguments),
    Model(model::Arguments),
    Replay(replay::Arguments),
    Schedule(schedule::Arguments),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().tool {
        Tool::Board(arguments) => board::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Bound(arguments) => bound::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Calibrate(arguments) => calibrate::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Doctor(arguments) => doctor::run(&arguments),
        Tool::Model(arguments) => model::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Replay(arguments) => replay::run(&arguments),
        Tool::Schedule(arguments) => schedule::run(&arguments).map(|()| ExitCode::SUCCESS),
    };
    match result {
        Ok(status) => status,
        Err(error) => {
            eprintln!("sun2xp: {}", one_line(&error.to_string()));
            ExitCode::FAILURE
        }
    }
}

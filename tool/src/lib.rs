//! The command-line tool of the library, as a function for the programs that contain it: the program `sun2xp`, and the
//! Python package. Nothing else uses this crate, so its interface may change with every version.

#![deny(unsafe_code)]

mod board;
mod boards;
mod bound;
mod calibrate;
mod commission;
mod completions;
mod doctor;
mod export;
mod failure;
mod health;
mod interrupt;
mod jog;
mod manual;
mod model;
mod monitor;
mod plot;
mod print;
mod record;
mod recording;
mod replay;
mod schedule;
mod sensors;
mod serve;
mod size;
mod status;
pub mod trace;
mod virtual_machine;
mod web;

use crate::failure::ExitStatus;
use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::ffi::OsString;
use std::path::Path;
use sun2xp::model::configuration::Configuration;

/// Tools for a hand that the sun2xp library drives.
#[derive(Parser)]
#[command(name = "sun2xp", version, after_help = failure::EXIT_STATUSES)]
struct Arguments {
    #[command(subcommand)]
    tool: Tool,
}

// A process has only one value of this type, so its size does not matter.
#[allow(clippy::large_enum_variant)]
#[derive(Subcommand)]
enum Tool {
    Board(board::Arguments),
    Boards(boards::Arguments),
    Bound(bound::Arguments),
    Calibrate(calibrate::Arguments),
    Commission(commission::Arguments),
    Completions(completions::Arguments),
    Doctor(doctor::Arguments),
    Export(export::Arguments),
    Health(health::Arguments),
    Jog(jog::Arguments),
    Manual(manual::Arguments),
    Model(model::Arguments),
    Monitor(monitor::Arguments),
    Plot(plot::Arguments),
    Record(record::Arguments),
    Replay(replay::Arguments),
    Schedule(schedule::Arguments),
    Sensors(sensors::Arguments),
    Serve(serve::Arguments),
    Size(size::Arguments),
    Status(status::Arguments),
}

/// Runs the tool with these arguments, the first of which is its name, and returns its exit status.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    run_script(arguments, None)
}

/// Runs the tool as [`run`] does. If this process is an interpreter such as Python, `script` is the script with which
/// it started the tool.
pub fn run_script(arguments: impl IntoIterator<Item = OsString>, script: Option<&Path>) -> u8 {
    let parsed = command().try_get_matches_from(arguments).and_then(|matches| Arguments::from_arg_matches(&matches));
    let arguments = match parsed {
        Ok(arguments) => arguments,
        // clap returns help and version as errors too. Their exit status is 0.
        Err(error) => {
            // If the help cannot be printed, its reader has closed the pipe.
            let _ = error.print();
            return if error.use_stderr() { ExitStatus::WRONG_USAGE.0 } else { ExitStatus::SUCCESS.0 };
        }
    };
    let result = match arguments.tool {
        Tool::Board(arguments) => board::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Boards(arguments) => boards::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Bound(arguments) => bound::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Calibrate(arguments) => calibrate::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Commission(arguments) => commission::run(&arguments),
        Tool::Completions(arguments) => completions::run(&arguments, command()).map(|()| ExitStatus::SUCCESS),
        Tool::Doctor(arguments) => doctor::run(&arguments),
        Tool::Export(arguments) => export::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Health(arguments) => health::run(&arguments),
        Tool::Jog(arguments) => jog::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Manual(arguments) => manual::run(&arguments, command()).map(|()| ExitStatus::SUCCESS),
        Tool::Model(arguments) => model::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Monitor(arguments) => monitor::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Plot(arguments) => plot::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Record(arguments) => record::run(&arguments),
        Tool::Replay(arguments) => replay::run(&arguments),
        Tool::Schedule(arguments) => schedule::run(&arguments),
        Tool::Sensors(arguments) => sensors::run(&arguments).map(|()| ExitStatus::SUCCESS),
        Tool::Serve(arguments) => serve::run(&arguments, script),
        Tool::Size(arguments) => size::run(&arguments),
        Tool::Status(arguments) => status::run(&arguments),
    };
    result.unwrap_or_else(|error| failure::report(&error)).0
}

/// Returns the URDF of a hand, as `sun2xp model --urdf` writes it.
pub fn urdf(configuration: &Configuration) -> String {
    model::urdf(configuration)
}

/// The command line. The help of every command names its exit statuses: in its description, or otherwise at the end.
fn command() -> Command {
    Arguments::command().mut_subcommands(|command| {
        let described = command.get_long_about().is_some_and(|about| about.to_string().contains("Exit status:"));
        if described { command } else { command.after_help(failure::EXIT_STATUSES) }
    })
}

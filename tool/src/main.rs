//! The command-line tool of the library.

#![deny(unsafe_code)]

mod board;
mod bound;
mod calibrate;
mod completions;
mod doctor;
mod export;
mod failure;
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
mod status;
mod trace;
mod virtual_machine;
mod web;

use clap::{Command, CommandFactory, FromArgMatches, Parser, Subcommand};
use std::process::ExitCode;

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
    Bound(bound::Arguments),
    Calibrate(calibrate::Arguments),
    Completions(completions::Arguments),
    Doctor(doctor::Arguments),
    Export(export::Arguments),
    Jog(jog::Arguments),
    Manual(manual::Arguments),
    Model(model::Arguments),
    Monitor(monitor::Arguments),
    Plot(plot::Arguments),
    Record(record::Arguments),
    Replay(replay::Arguments),
    Schedule(schedule::Arguments),
    Status(status::Arguments),
}

fn main() -> ExitCode {
    // clap has refused wrong usage before the conversion, so it cannot fail.
    let arguments = Arguments::from_arg_matches(&command().get_matches()).unwrap_or_else(|error| error.exit());
    let result = match arguments.tool {
        Tool::Board(arguments) => board::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Bound(arguments) => bound::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Calibrate(arguments) => calibrate::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Completions(arguments) => completions::run(&arguments, command()).map(|()| ExitCode::SUCCESS),
        Tool::Doctor(arguments) => doctor::run(&arguments),
        Tool::Export(arguments) => export::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Jog(arguments) => jog::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Manual(arguments) => manual::run(&arguments, command()).map(|()| ExitCode::SUCCESS),
        Tool::Model(arguments) => model::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Monitor(arguments) => monitor::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Plot(arguments) => plot::run(&arguments).map(|()| ExitCode::SUCCESS),
        Tool::Record(arguments) => record::run(&arguments),
        Tool::Replay(arguments) => replay::run(&arguments),
        Tool::Schedule(arguments) => schedule::run(&arguments),
        Tool::Status(arguments) => status::run(&arguments),
    };
    result.unwrap_or_else(|error| failure::report(&error))
}

/// The command line. The help of every command ends with its exit statuses.
fn command() -> Command {
    Arguments::command().mut_subcommands(|command| {
        let described = command.get_long_about().is_some_and(|about| about.to_string().contains("Exit status:"));
        if described { command } else { command.after_help(failure::EXIT_STATUSES) }
    })
}

//! Measures how the servo threads run on this machine: the figures about time in `docs/measurements.md`.
//!
//!     cargo bench --bench realtime -- wake-up [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- throughput [--seconds 5] [--priority 0]
//!     cargo bench --bench realtime -- planner [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- groups [--groups 10000]
//!     cargo bench --bench realtime -- reactions [--contacts 5000]
//!     cargo bench --bench realtime -- events [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- telemetry [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- long-run [--minutes 30]
//!
//! wake-up and long-run need cyclictest (Debian: rt-tests), and wake-up also needs stress-ng. A measurement that
//! compares two cases measures them alternately. Without a name, everything except the long run is measured.

mod attempts;
mod cores;
mod cyclictest;
mod delays;
mod events;
mod explain;
mod fingers;
mod groups;
mod long_run;
mod percentiles;
mod planner;
mod reactions;
mod telemetry;
mod throughput;
mod turns;
mod under_control;
mod wake_up;

use clap::{Parser, Subcommand};
use std::error::Error;
use turns::Turns;

type Failure = Box<dyn Error>;

#[derive(Parser)]
#[command(about = "Measures how the servo threads run on this machine")]
struct Arguments {
    #[command(subcommand)]
    figure: Option<Figure>,
    /// `cargo bench` passes this option.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(Subcommand)]
enum Figure {
    /// Measures the wake-up latency of three servo-like threads and of cyclictest, idle and under load.
    WakeUp(Turns),
    Throughput(throughput::Arguments),
    /// Measures the wake-up latency of the servos with and without two threads that call SendPos and GetPos as fast as
    /// they can.
    Planner(Turns),
    Groups(groups::Arguments),
    Reactions(reactions::Arguments),
    /// Measures the wake-up latency of the servos with and without 10 000 events a second.
    Events(Turns),
    /// Measures the wake-up latency of the servos with and without three processes that read telemetry.
    Telemetry(Turns),
    /// Reads the telemetry of a hand until standard input ends.
    #[command(hide = true)]
    Reader(telemetry::ReaderArguments),
    LongRun(long_run::Arguments),
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().figure {
        Some(Figure::WakeUp(turns)) => wake_up::run(&turns),
        Some(Figure::Throughput(arguments)) => throughput::run(&arguments),
        Some(Figure::Planner(turns)) => planner::run(&turns),
        Some(Figure::Groups(arguments)) => groups::run(&arguments),
        Some(Figure::Reactions(arguments)) => reactions::run(&arguments),
        Some(Figure::Events(turns)) => events::run(&turns),
        Some(Figure::Telemetry(turns)) => telemetry::run(&turns),
        Some(Figure::Reader(arguments)) => telemetry::read(&arguments),
        Some(Figure::LongRun(arguments)) => long_run::run(&arguments),
        None => {
            // A measurement that fails does not prevent the others.
            let measured = [
                wake_up::run(&Turns::default()),
                throughput::run(&throughput::Arguments::default()),
                planner::run(&Turns::default()),
                groups::run(&groups::Arguments::default()),
                reactions::run(&reactions::Arguments::default()),
                events::run(&Turns::default()),
                telemetry::run(&Turns::default()),
            ];
            measured.into_iter().collect()
        }
    }
}

//! How the servo threads run on this machine: the figures of `docs/measurements.md` about time.
//!
//!     cargo bench --bench realtime -- wake-up [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- throughput [--seconds 5] [--priority 0]
//!     cargo bench --bench realtime -- planner [--repeats 5] [--seconds 5]
//!     cargo bench --bench realtime -- long-run [--minutes 30]
//!
//! wake-up and long-run need cyclictest (Debian: rt-tests), and wake-up stress-ng. What is compared is measured in one run, in turn.
//! Without a name all but the long run are done.

mod cyclictest;
mod explain;
mod fingers;
mod long_run;
mod percentiles;
mod planner;
mod throughput;
mod wake_up;

use clap::{Parser, Subcommand};
use std::error::Error;

type Failure = Box<dyn Error>;

#[derive(Parser)]
#[command(about = "Measures how the servo threads run on this machine")]
struct Arguments {
    #[command(subcommand)]
    figure: Option<Figure>,
    /// `cargo bench` passes it.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(Subcommand)]
enum Figure {
    WakeUp(wake_up::Arguments),
    Throughput(throughput::Arguments),
    Planner(planner::Arguments),
    LongRun(long_run::Arguments),
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().figure {
        Some(Figure::WakeUp(arguments)) => wake_up::run(&arguments),
        Some(Figure::Throughput(arguments)) => throughput::run(&arguments),
        Some(Figure::Planner(arguments)) => planner::run(&arguments),
        Some(Figure::LongRun(arguments)) => long_run::run(&arguments),
        None => {
            wake_up::run(&wake_up::Arguments::default())?;
            throughput::run(&throughput::Arguments::default())?;
            planner::run(&planner::Arguments::default())
        }
    }
}

//! Compares the engine of the remote hand, Zenoh, with plain TCP and with TCP and rustls, on loopback.
//!
//!     cargo bench -p sun2xp-serve --bench engine -- latency [--repeats 5] [--seconds 5] [--period-us 1000]
//!     cargo bench -p sun2xp-serve --bench engine -- throughput [--repeats 5] [--messages 200000]
//!
//! The server of each engine is a process of its own. The engines are measured alternately. Without `latency` or
//! `throughput`, both are measured.

mod certificates;
mod echo;
mod latency;
mod link;
mod load;
mod percentiles;
mod stream;
mod throughput;
mod zenoh_link;

use clap::{Parser, Subcommand};
use std::error::Error;

type Failure = Box<dyn Error + Send + Sync>;

/// Length of a message, bytes: somewhat longer than a Target with one part, which has 152 bytes.
const LENGTH: usize = 200;

#[derive(Parser)]
#[command(about = "Compares Zenoh with plain TCP and with TCP and rustls, on loopback")]
struct Arguments {
    #[command(subcommand)]
    figure: Option<Figure>,
    /// `cargo bench` passes this option.
    #[arg(long, hide = true, global = true)]
    bench: bool,
}

#[derive(Subcommand)]
enum Figure {
    Latency(latency::Arguments),
    Throughput(throughput::Arguments),
    /// Answers messages until standard input ends.
    #[command(hide = true)]
    Echo(echo::Arguments),
    /// Occupies every core until standard input ends.
    #[command(hide = true)]
    Burn,
}

fn main() -> Result<(), Failure> {
    match Arguments::parse().figure {
        Some(Figure::Latency(arguments)) => latency::run(&arguments),
        Some(Figure::Throughput(arguments)) => throughput::run(&arguments),
        Some(Figure::Echo(arguments)) => echo::run(&arguments),
        Some(Figure::Burn) => load::burn(),
        None => {
            latency::run(&latency::Arguments::default())?;
            throughput::run(&throughput::Arguments::default())
        }
    }
}

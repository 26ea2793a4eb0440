//! `sun2xp schedule`: computes whether every cycle of a configured hand meets its deadline, and the highest possible
//! rate, both for the hand as it is and with an additional sensor on each finger.

mod fastest;
mod measured;
mod off_line;
mod report;

use crate::failure::{ExitStatus, Failure, complain};
use crate::print::{self, Screen};
use crate::virtual_machine::is_virtual;
use measured::measure;
use off_line::{Costs, Sensor};
use report::{Report, Source};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;
use sun2xp::files::read_regular_file;
use sun2xp::hand;
use sun2xp::model::ShownPath;

/// Maximum size of the file that --costs names, bytes. The file contains four numbers.
const LARGEST_COSTS: u64 = 1 << 16;

/// Computes whether every cycle of the hand meets its deadline, from worst-case times, the times on the lines, and the
/// allocation of fingers to threads, cores and ports.
///
/// The worst cases of this machine are measured on the simulated hand, with the rate, threads, cores and priorities of
/// the configuration. With --costs they are read from a TOML file with the keys `wake_up`, `write` (the commands of one
/// port), `read` (receive and decode one reply) and `compute` (one finger), all in us. The measured computing time
/// includes 16 reflexes of each finger, of which one reacts in every cycle. Lines are as configured; a simulated port
/// counts as a serial line of its baud rate. The results hold for any offsets between the periods of the threads.
///
/// Exit status: 0 if every deadline is met at the configured rate, 1 if one may be missed or the
/// computation fails, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Read the worst cases from a file instead of measuring them.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["measure", "p999"])]
    costs: Option<PathBuf>,
    /// Duration of the measurement, s.
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 10,
        value_parser = clap::value_parser!(u64).range(1..=86_400)
    )]
    measure: u64,
    /// Use the 99.9 % value of each cost instead of its maximum. On a virtual machine every maximum includes a pause of
    /// the whole machine.
    #[arg(long)]
    p999: bool,
    /// Bytes that an additional sensor adds to each reply. The deadlines are also computed with this sensor.
    #[arg(long, value_name = "N", default_value_t = 16)]
    sensor_bytes: usize,
    /// Computing time that the additional sensor adds per finger, us.
    #[arg(long, value_name = "US", default_value_t = 20.0, value_parser = not_negative)]
    sensor_compute: f64,
    /// Print one JSON object, for other programs. Times are in us, rates in Hz.
    #[arg(long)]
    json: bool,
}

fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if f64::is_finite(number) && number >= 0.0 => Ok(number),
        _ => Err("not a number of 0 or more".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let configuration = match &arguments.config {
        Some(file) => hand::Configured::read(file)?.configuration,
        None => hand::find_configuration()?.configuration,
    };
    let (costs, source) = match &arguments.costs {
        Some(file) => (read(file)?, Source::File),
        None => {
            let source = if arguments.p999 { Source::Measured999 } else { Source::MeasuredMaximum };
            let duration = Duration::from_secs(arguments.measure);
            (measure(&configuration, duration, arguments.p999)?, source)
        }
    };
    let sensor = Sensor { bytes: arguments.sensor_bytes, compute: arguments.sensor_compute };
    let report = Report::new(&configuration, costs, source, is_virtual(Path::new("/")), sensor);
    match arguments.json {
        true => print::json(&report)?,
        false => report.write(&mut io::stdout().lock(), &Screen::stdout())?,
    }
    if report.pass {
        return Ok(ExitStatus::SUCCESS);
    }
    complain(&report.complaint());
    Ok(ExitStatus::FAILURE)
}

fn read(file: &Path) -> Result<Costs, Failure> {
    let text = read_regular_file(file, LARGEST_COSTS)
        .map_err(|error| format!("cannot read {}: {error}. Name a readable file with --costs", ShownPath(file)))?;
    Ok(Costs::parse(&text).map_err(|reason| format!("{}:{reason}", ShownPath(file)))?)
}

//! `sun2xp sensors`: the encoders and gauges of a finger, with the motors off.

use crate::failure::Failure;
use crate::interrupt::Interrupt;
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::hand::{Configured, Fingers, Hand};
use sun2xp::model::configuration::ConfiguredFinger;

/// Time between two lines.
const INTERVAL: Duration = Duration::from_millis(500);

/// Number of cycles over which gauges are averaged.
const AVERAGED: u64 = 200;

/// Prints what the encoders and gauges of a finger measure, twice a second, with the motors off, until Ctrl-C.
///
/// Turn a motor by hand, and see which encoder moves; hang a weight on a tendon, and see which gauge responds, and by
/// how much. Turns and tensions are relative to the first line. They include the signs and scales of the configuration,
/// and the gauges are averaged over 200 cycles. A fault, such as a board that no longer answers, ends the command.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The finger.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(i32).range(1..=3))]
    finger: i32,
    /// End after this time, s.
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=86_400))]
    seconds: Option<u64>,
    /// Print each line as a JSON object, for other programs.
    #[arg(long)]
    json: bool,
}

/// What the sensors of a finger measure.
#[derive(Clone, Copy, Serialize)]
struct Reading {
    /// Encoder counts.
    encoders: [i32; 4],
    /// Gauge counts, averaged.
    gauges: [f64; 4],
    /// Turns of each motor since the first reading; positive if the tendon is pulled in.
    turns: [f64; 4],
    /// Change of each tension since the first reading, N.
    tensions: [f64; 4],
}

impl Reading {
    /// Returns the newest encoder counts and the averaged gauge counts, without turns and tensions; none before the
    /// first reply of the board.
    fn take(hand: &Hand, finger: i32) -> Result<Option<Self>, Failure> {
        let kept = hand.record(finger, None)?;
        let first = (kept.newest + 1).saturating_sub(AVERAGED).max(kept.oldest);
        // The black box may overwrite the oldest cycles meanwhile.
        let feedback = (first..=kept.newest).filter_map(|cycle| hand.record(finger, Some(cycle)).ok()?.record.feedback);
        let feedback: Vec<_> = feedback.collect();
        let Some(newest) = feedback.last() else { return Ok(None) };
        let average = |gauge: usize| {
            let sum: f64 = feedback.iter().map(|feedback| f64::from(feedback.gauge_counts[gauge])).sum();
            sum / feedback.len() as f64
        };
        let gauges = [0, 1, 2, 3].map(average);
        Ok(Some(Self { encoders: newest.motor_counts, gauges, turns: [0.0; 4], tensions: [0.0; 4] }))
    }

    /// Computes turns and tensions relative to the first reading (eq. 28 in turns).
    fn relative_to(mut self, first: &Self, finger: &ConfiguredFinger) -> Self {
        for place in 0..4 {
            let counts = f64::from(self.encoders[place]) - f64::from(first.encoders[place]);
            let sign = f64::from(finger.encoder.sign[place]);
            self.turns[place] = sign * counts / f64::from(finger.encoder.counts_per_revolution[place]);
            self.tensions[place] = (self.gauges[place] - first.gauges[place]) * finger.gauge.newton_per_count[place];
        }
        self
    }

    fn line(&self) -> String {
        let mut line = String::new();
        self.encoders.iter().for_each(|count| line += &format!("{count:>10}"));
        self.turns.iter().for_each(|turns| line += &format!("{turns:>+10.3}"));
        self.gauges.iter().for_each(|count| line += &format!("{count:>10.1}"));
        self.tensions.iter().for_each(|tension| line += &format!("{tension:>+10.2}"));
        line
    }
}

/// The titles of the columns.
fn titles() -> String {
    let titles = ["encoder", "turns", "gauge", "N"];
    titles.iter().flat_map(|title| (1..=4).map(move |number| format!("{:>10}", format!("{title} {number}")))).collect()
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let interrupt = Interrupt::watch()?;
    let configured = Configured::read(&arguments.config)?.local()?;
    let finger = configured.configuration.fingers[arguments.finger as usize - 1].clone();
    let fingers = Fingers::only(arguments.finger)?;
    configured.announce(fingers);
    let hand = Hand::open_limp(configured.configuration, Some(arguments.config.clone()), fingers)?;
    let (began, mut first) = (Instant::now(), None);
    let mut output = io::stdout();
    if !arguments.json {
        writeln!(output, "{}", titles())?;
    }
    while !interrupt.requested()
        && arguments.seconds.is_none_or(|seconds| began.elapsed() < Duration::from_secs(seconds))
    {
        sleep(INTERVAL);
        // A faulted finger has no new readings, and its last one would look like a motor that does not turn.
        if let Some(fault) = hand.fault(arguments.finger)?.stopped {
            return Err(format!("finger {}: {fault}", arguments.finger).into());
        }
        let Some(reading) = Reading::take(&hand, arguments.finger)? else { continue };
        let reading = reading.relative_to(first.get_or_insert(reading), &finger);
        match arguments.json {
            true => writeln!(output, "{}", serde_json::to_string(&reading)?)?,
            false => writeln!(output, "{}", reading.line())?,
        }
    }
    Ok(())
}

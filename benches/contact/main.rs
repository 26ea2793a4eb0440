//! Measures the detection of contacts without tactile sensors: which forces simulated fingers detect, how fast they
//! detect them, and how many false alarms there are.
//!
//!     cargo bench --bench contact                       all tables of docs/contact.md except that of slipping
//!     cargo bench --bench contact -- nominal            the hands with this word in their name
//!     cargo bench --bench contact -- --minutes 1        shorter runs for false alarms
//!     cargo bench --bench contact -- --alarms           only the table of false alarms
//!     cargo bench --bench contact -- --after            only the table of contacts after a motion
//!     cargo bench --bench contact -- --keys 'force = 0.2'   other values of [finger.contact]

mod after_motion;
mod cases;
mod false_alarms;
mod finger;
mod motion;
mod noticed;
#[allow(dead_code, reason = "the stiffness benchmark uses the other functions")]
#[path = "../stiffness/parallel.rs"]
mod parallel;

use after_motion::{After, DELAYS, FORCE};
use cases::{CASES, Case};
use clap::Parser;
use noticed::{FORCES, Pushes};
use std::error::Error;
use sun2xp::model::configuration::ConfiguredContact;

#[derive(Parser)]
struct Arguments {
    /// Measures only the hands with this word in their names.
    #[arg(default_value = "")]
    hand: String,
    /// Limit of the simulated time for false alarms, minutes.
    #[arg(long, default_value_t = 60.0)]
    minutes: f64,
    /// Number of seeds with which the detected forces are measured.
    #[arg(long, default_value_t = 10)]
    seeds: u64,
    /// Keys of [finger.contact], as TOML.
    #[arg(long, default_value = "")]
    keys: String,
    /// Counts only false alarms.
    #[arg(long)]
    alarms: bool,
    /// Measures only contacts that follow a motion.
    #[arg(long)]
    after: bool,
    /// `cargo bench` passes this option.
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let contact: ConfiguredContact = toml_edit::de::from_str(&arguments.keys)?;
    let cases: Vec<&Case> = CASES.iter().filter(|case| case.name.contains(&arguments.hand)).collect();
    if arguments.after {
        return after(&cases, &contact, arguments.seeds);
    }
    println!("| hand | simulated time, min | false alarms | first, s | share in contact |\n|---|---|---|---|---|");
    let alarms = parallel::each(&cases, |_, case| {
        let seconds = case.seconds.min(arguments.minutes * 60.0);
        false_alarms::count(case, &contact, seconds, 1).map_err(|error| error.to_string())
    });
    for (case, alarms) in cases.iter().zip(alarms) {
        let alarms = alarms?;
        let minutes = case.seconds.min(arguments.minutes * 60.0) / 60.0;
        let first = alarms.first.map_or("-".into(), |first| format!("{first:.1}"));
        println!("| {} | {minutes:.0} | {} | {first} | {:.4} |", case.name, alarms.count, alarms.share);
    }
    if arguments.alarms {
        return Ok(());
    }
    for (title, measure) in [("At rest", noticed::at_rest as Measure), ("In motion", noticed::in_motion)] {
        println!("\n{title}:\n");
        println!("| hand | force, N | detected | time, ms: median, worst | lost after, ms: median, worst | error, N |");
        println!("|---|---|---|---|---|---|");
        for case in &cases {
            for (force, pushes) in FORCES.into_iter().zip(measure(case, &contact, arguments.seeds)?) {
                row(case.name, force, &pushes);
            }
        }
    }
    after(&cases, &contact, arguments.seeds)
}

/// Prints the table of contacts that follow a motion.
fn after(cases: &[&Case], contact: &ConfiguredContact, seeds: u64) -> Result<(), Box<dyn Error>> {
    println!(
        "\nA force of {FORCE} N near the end of a motion at up to 1 or 3 rad/s, or after a jump of the set point:\n"
    );
    println!(
        "| hand | fastest joint rate, rad/s | force begins after the motion, s | detected | error, N cm: mean, worst |"
    );
    println!("|---|---|---|---|---|");
    for case in cases {
        for speed in false_alarms::SPEEDS {
            for (delay, after) in DELAYS.into_iter().zip(after_motion::measure(case, contact, seeds, speed)?) {
                let After { pushes, noticed, sum, worst } = after;
                let (name, mean) = (case.name, sum / pushes as f64);
                println!("| {name} | {speed} | {delay} | {noticed} of {pushes} | {mean:.2}, {worst:.2} |");
            }
        }
    }
    Ok(())
}

type Measure = fn(&Case, &ConfiguredContact, u64) -> Result<Vec<Pushes>, Box<dyn Error>>;

fn row(hand: &str, force: f64, pushes: &Pushes) {
    let times = |sorted: &[f64]| match sorted {
        [] => "-".into(),
        [.., worst] => format!("{:.0}, {:.0}", sorted[sorted.len() / 2] * 1e3, worst * 1e3),
    };
    println!(
        "| {hand} | {force} | {} of {} | {} | {} | {:.2} |",
        pushes.noticed,
        pushes.pushes,
        times(&pushes.times),
        times(&pushes.losses),
        pushes.error
    );
}

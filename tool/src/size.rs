//! `sun2xp size`: what the motors, encoders, gauges, drivers and tendons of a hand must be able to do.

mod figures;
mod mechanics;
mod report;

use crate::failure::{ExitStatus, Failure};
use crate::print::{self, Screen};
use report::Report;
use std::io;
use std::path::PathBuf;
use sun2xp::hand;
use sun2xp::model::FingerNumber;

/// Computes what the motors, encoders, gauges, drivers and tendons of a hand must be able to do, and whether those of
/// the configuration can.
///
/// The forces of the tip, and the tension at the required force, are the worst over a grid of poses within the joint
/// limits and over 26 directions of the force. The displacements and the stiffness are the worst over these poses. The
/// command needs no hand. docs/building-a-hand.md derives every line.
///
/// Exit status: 0 if every part suffices, 1 if one does not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// The finger.
    #[arg(long, value_name = "N", default_value = "1", value_parser = crate::commission::finger)]
    finger: FingerNumber,
    #[command(flatten)]
    wanted: Wanted,
    /// Print one JSON object, for other programs.
    #[arg(long)]
    json: bool,
}

/// What the hand must be able to do.
#[derive(clap::Args, Clone, Copy)]
pub struct Wanted {
    /// Force that the fingertip must exert continuously, in every direction and pose, N.
    #[arg(long, value_name = "N", default_value_t = 3.0, value_parser = positive)]
    force: f64,
    /// Stiffness of the fingertip, N/cm.
    #[arg(long, value_name = "N/CM", default_value_t = 3.0, value_parser = positive)]
    stiffness: f64,
    /// Speed of each joint, rad/s.
    #[arg(long, value_name = "RAD/S", default_value_t = 5.0, value_parser = positive)]
    speed: f64,
    /// Largest displacement of the fingertip by one count of an encoder or a gauge, um.
    #[arg(long, value_name = "UM", default_value_t = 100.0, value_parser = positive)]
    resolution: f64,
    /// Length of a tendon from motor to joint, cm.
    #[arg(long, value_name = "CM", default_value_t = 50.0, value_parser = positive)]
    tendon_length: f64,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if f64::is_finite(number) && number > 0.0 => Ok(number),
        _ => Err("not a number above 0".into()),
    }
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let configuration = match &arguments.config {
        Some(file) => hand::Configured::read(file)?.configuration,
        None => hand::find_configuration()?.configuration,
    };
    let finger = &configuration.fingers[arguments.finger.index()];
    let report = Report::new(finger, configuration.hand.rate, &arguments.wanted)?;
    match arguments.json {
        true => print::json(&report)?,
        false => report.write(&mut io::stdout().lock(), &Screen::stdout())?,
    }
    Ok(if report.pass { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

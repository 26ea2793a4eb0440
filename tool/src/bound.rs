//! `sun2xp bound`: finds the largest stiffness of a finger, and stores it in the configuration file.

mod passivity;
mod sample;
mod set;
#[cfg(test)]
mod tests;

use crate::failure::{Failure, wrong_usage};
use crate::print::{self, Progress, Screen};
use passivity::Passivity;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StrDeserializer};
use serde::{Deserialize, Serialize};
use set::SetBound;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use sun2xp::hand::{self, Fingers, Found};
use sun2xp::model::FingerNumber;
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, FINGERS, RATES, Scheme};

/// Finds the bound on the eigenvalues of Kx up to which a finger is stable in the sampled poses.
///
/// The search simulates the configured controller, links, tendons and motors, with viscous friction, without Coulomb
/// friction, with exact measurements and one cycle of delay. At a wall, the configured Coulomb friction of the joints
/// acts as a damper. The search covers a set of plants. Each of them, except the nominal plant, differs from the
/// configuration in one respect: rotor inertia, link masses, tendon stiffness, motor constants, amplifier lag, an extra
/// cycle of delay, a held mass or lost replies. The samples are random: poses within the joint limits, axes of Kx,
/// contact types, both stiffness laws (`finger.controller.law`), damping and loads. Each plant is searched without
/// walls, and with walls of 30 to 1000 N/cm. Every motion must decay to 1/e within 10 s. In a pose whose tendons
/// support less than the bound, the servo scales Kx down, and so does the search. The bound is low enough that no pose
/// needs a scale below one half.
///
/// The bound of the finger is the least bound of all plants. In the printed table, the number in brackets counts the
/// samples that are unstable even with a spring of 1 N/cm. A plant with such samples is reported, but does not limit
/// the bound, because no bound makes it stable. The only exception is the nominal plant without walls, which limits the
/// bound in any case. With the default number of samples, the search takes one to two minutes on two cores for each
/// kind of finger.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// The finger. May be repeated. The default is all fingers.
    #[arg(long = "finger", value_name = "N", value_parser = clap::value_parser!(i32).range(1..=FINGERS as i64))]
    fingers: Vec<i32>,
    /// Write the bounds into the configuration file as finger.N.stiffness.bound, and change nothing else. The bound of
    /// each finger is written as soon as it is found. Only a bound of the whole set of plants, with the default number
    /// of samples, can be written.
    #[arg(long, requires = "config", conflicts_with_all = ["scheme", "rate", "nominal", "free", "samples"])]
    write: bool,
    /// A controller other than the configured one: "figure 9", "figure 10", "figure 11" or "state feedback".
    #[arg(long, value_parser = scheme)]
    scheme: Option<Scheme>,
    /// A rate other than the configured one, Hz.
    #[arg(long, value_name = "HZ", value_parser = rate)]
    rate: Option<f64>,
    /// Search only with the plant that equals the configuration.
    #[arg(long)]
    nominal: bool,
    /// Search only without walls.
    #[arg(long)]
    free: bool,
    /// Print the passivity of the fingertips instead of a bound.
    ///
    /// The passivity is the least eigenvalue of the Hermitian part of the driving-point admittance Y of the tip,
    /// divided by the largest singular value of Y, from 1 to 400 Hz. If it is negative, an object that moves with the
    /// tip receives energy from the finger. The plant is the nominal one, at the configured bound of Kx.
    #[arg(long, conflicts_with_all = ["write", "nominal", "free"])]
    passivity: bool,
    /// Number of samples for each plant, or of poses with --passivity. The default is 400 samples, 2000 samples with
    /// --nominal, and 4 poses with --passivity. A bound needs at least 10 samples.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    samples: Option<u32>,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1990)]
    seed: u64,
    /// Print one JSON object, for other programs. Stiffnesses are in N/cm.
    #[arg(long)]
    json: bool,
}

/// Least number of samples of a bound. With fewer, all of them may have the tip within 3 cm of the axis of joint 0, and
/// such samples give no bound.
const LEAST_SAMPLES: u32 = 10;

/// A finger whose bound or passivity is computed, and the rate of the hand, Hz.
struct Searched<'a> {
    number: FingerNumber,
    finger: &'a ConfiguredFinger,
    rate: f64,
}

/// The output of `--json`.
#[derive(Serialize)]
struct Report {
    /// Hz.
    rate: f64,
    fingers: Vec<FingerReport>,
    /// The file that has the bounds now. `None` without `--write`.
    written: Option<PathBuf>,
}

/// The result for one finger.
#[derive(Serialize)]
struct FingerReport {
    finger: i32,
    /// The bound, or with `--passivity` the stiffness of the spring, N/cm.
    stiffness: f64,
    /// The number of the finger from which this result was taken, because the two fingers are equal. `None` if the
    /// result was computed for this finger.
    same_as: Option<i32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    set: Option<SetBound>,
    #[serde(skip_serializing_if = "Option::is_none")]
    passivity: Option<Passivity>,
}

fn scheme(name: &str) -> Result<Scheme, String> {
    let name: StrDeserializer<Error> = name.into_deserializer();
    Scheme::deserialize(name).map_err(|error| error.to_string())
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().map_err(|_| format!("{text} is not a number: give a rate in Hz, for example 1000"))?;
    if RATES.contains(&rate) {
        Ok(rate)
    } else {
        Err(format!("{rate} is outside {} to {} Hz", RATES.start(), RATES.end()))
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    if !arguments.passivity && arguments.samples.is_some_and(|samples| samples < LEAST_SAMPLES) {
        return Err(wrong_usage(format!("a bound needs at least --samples {LEAST_SAMPLES}")));
    }
    let mut configuration = match &arguments.config {
        Some(path) => hand::Configured::read(path)?.configuration,
        None => hand::find_configuration()?.configuration,
    };
    if let Some(scheme) = arguments.scheme {
        configuration.fingers.iter_mut().for_each(|finger| finger.controller.scheme = Some(scheme));
    }
    configuration.hand.rate = arguments.rate.unwrap_or(configuration.hand.rate);
    let rate = configuration.hand.rate;
    let numbers = Fingers::of(&arguments.fingers).and_then(|fingers| fingers.in_hand(&configuration.hand));
    let numbers = numbers.map_err(|error| wrong_usage(error.to_string()))?.numbers();
    let numbers = numbers.map(FingerNumber::try_from).collect::<Result<Vec<_>, _>>()?;
    // Equal fingers have equal bounds, so only the first of them is searched.
    let first_like = |number: FingerNumber| {
        let finger = &configuration.fingers[number.index()];
        numbers.iter().copied().find(|other| alike(finger, &configuration.fingers[other.index()])).unwrap_or(number)
    };
    let different = numbers.iter().filter(|&&number| first_like(number) == number).count();
    let steps = if arguments.passivity { passivity::number_of_poses(arguments) } else { set::searches(arguments) };
    let progress = Progress::new("bound", (different * steps) as u64);
    let written = arguments.config.as_ref().filter(|_| arguments.write);
    let mut reports: Vec<FingerReport> = Vec::new();
    let mut printed = Ok(());
    for &number in &numbers {
        let searched = Searched { number, finger: &configuration.fingers[number.index()], rate };
        let twin = reports.iter().find(|report| report.finger == first_like(number).get());
        let report = match twin {
            Some(twin) => FingerReport {
                finger: number.get(),
                stiffness: twin.stiffness,
                same_as: Some(twin.finger),
                set: None,
                passivity: None,
            },
            None => search(arguments, &searched, &progress)?,
        };
        let print = || if arguments.json { Ok(()) } else { progress.aside(|| report.write(&searched)) };
        let found = Found::bound(report.stiffness, number, &configuration);
        printed = printed.and(conclude(written.map(PathBuf::as_path), &found, print)?);
        if written.is_none() && printed.is_err() {
            break;
        }
        reports.push(report);
    }
    drop(progress);
    printed?;
    match (arguments.json, written) {
        (true, _) => print::json(&Report { rate, fingers: reports, written: written.cloned() })?,
        (false, Some(path)) => writeln!(io::stdout(), "written to {}", ShownPath(path))?,
        (false, None) => {}
    }
    Ok(())
}

/// Stores a bound in the file, if a file is given, and then prints the bound. Returns the result of the printing
/// separately: if the reader of standard output has closed the pipe, the bounds of the remaining fingers must still be
/// found and stored.
///
/// # Errors
/// Returns an error if the bound cannot be stored.
fn conclude(
    path: Option<&Path>,
    found: &Found,
    print: impl FnOnce() -> io::Result<()>,
) -> Result<io::Result<()>, Failure> {
    if let Some(path) = path {
        hand::store_findings(path, std::slice::from_ref(found))?;
    }
    Ok(print())
}

/// Finds the bound of one finger with the default options. Returns it in N/cm, and what limits it.
///
/// # Errors
/// Returns an error if the finger has no bound.
pub fn of_finger(configuration: &Configuration, number: FingerNumber) -> Result<(f64, String), Failure> {
    let arguments = Arguments {
        config: None,
        fingers: Vec::new(),
        write: false,
        scheme: None,
        rate: None,
        nominal: false,
        free: false,
        passivity: false,
        samples: None,
        seed: 1990,
        json: false,
    };
    let searched = Searched { number, finger: &configuration.fingers[number.index()], rate: configuration.hand.rate };
    let progress = Progress::new("bound", set::searches(&arguments) as u64);
    let (stiffness, set) = set::search(&arguments, &searched, &progress)?;
    Ok((stiffness, set.limit()))
}

fn search(arguments: &Arguments, searched: &Searched, progress: &Progress) -> Result<FingerReport, Failure> {
    let finger = searched.number.get();
    let report = FingerReport { finger, stiffness: 0.0, same_as: None, set: None, passivity: None };
    if arguments.passivity {
        let (stiffness, passivity) = passivity::compute(arguments, searched, progress)?;
        return Ok(FingerReport { stiffness, passivity: Some(passivity), ..report });
    }
    let (stiffness, set) = set::search(arguments, searched, progress)?;
    Ok(FingerReport { stiffness, set: Some(set), ..report })
}

impl FingerReport {
    fn write(&self, searched: &Searched) -> io::Result<()> {
        let (mut out, screen) = (io::stdout().lock(), Screen::stdout());
        let Searched { number, rate, .. } = searched;
        if let Some(twin) = self.same_as {
            writeln!(out, "finger {number}: {:.1} N/cm at {rate} Hz, as for finger {twin}", self.stiffness)?;
        }
        if let Some(set) = &self.set {
            set.write(&mut out, &screen, searched)?;
        }
        match &self.passivity {
            Some(passivity) => passivity.write(&mut out, &screen, searched, self.stiffness),
            None => Ok(()),
        }
    }
}

/// Whether two fingers are equal in everything that the results depend on. State feedback depends on the resolution of
/// the sensors, and the passivity depends on the configured bound.
fn alike(one: &ConfiguredFinger, other: &ConfiguredFinger) -> bool {
    let parts = |of: &ConfiguredFinger| {
        (of.geometry.clone(), of.motor.clone(), of.tendon.clone(), of.joints.clone(), of.links.clone())
    };
    let resolution = |of: &ConfiguredFinger| (of.gauge.newton_per_count, of.encoder.counts_per_revolution);
    parts(one) == parts(other)
        && resolution(one) == resolution(other)
        && one.friction == other.friction
        && one.controller == other.controller
        && one.stiffness.bound == other.stiffness.bound
}

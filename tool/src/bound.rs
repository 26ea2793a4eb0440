//! `sun2xp bound`: finds the largest stiffness of a finger, and stores it in the configuration file.

use crate::failure::Failure;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::{Error, StrDeserializer};
use std::io::{self, Write};
use std::path::PathBuf;
use sun2xp::hand::{self, Fingers, Found};
use sun2xp::model::FingerNumber;
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, FINGERS, RATES, Scheme};
use sun2xp::stability::{Limit, Search, StiffnessBound};

/// Finds the bound on the eigenvalues of Kx up to which a finger is stable in every pose.
///
/// The search simulates the configured controller, links, tendons and motors, without friction, with exact measurements
/// and one cycle of delay. Poses within the joint limits, axes of Kx and loads are random. Some poses are stable only
/// with a Kx below the bound. In such a pose the servo scales Kx down, and so does the search. The bound is low enough
/// that no pose needs a scale below one half. The search takes up to a minute for each kind of finger.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// The finger. May be repeated. The default is all fingers.
    #[arg(long = "finger", value_name = "N", value_parser = clap::value_parser!(i32).range(1..=FINGERS as i64))]
    fingers: Vec<i32>,
    /// Write the bounds into the configuration file as finger.N.stiffness.bound, and change nothing else.
    #[arg(long, requires = "config", conflicts_with_all = ["scheme", "rate"])]
    write: bool,
    /// A controller other than the configured one: "figure 9", "figure 10", "figure 11" or "state feedback".
    #[arg(long, value_parser = scheme)]
    scheme: Option<Scheme>,
    /// A rate other than the configured one, Hz.
    #[arg(long, value_name = "HZ", value_parser = rate)]
    rate: Option<f64>,
    /// Number of poses.
    #[arg(long, value_name = "N", default_value_t = 2000)]
    samples: usize,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1990)]
    seed: u64,
}

fn scheme(name: &str) -> Result<Scheme, String> {
    let name: StrDeserializer<Error> = name.into_deserializer();
    Scheme::deserialize(name).map_err(|error| error.to_string())
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().map_err(|_| format!("{text} is not a number"))?;
    if RATES.contains(&rate) {
        Ok(rate)
    } else {
        Err(format!("{rate} is outside {} to {} Hz", RATES.start(), RATES.end()))
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut configuration = match &arguments.config {
        Some(path) => hand::read_configuration(path)?,
        None => hand::find_configuration()?.configuration,
    };
    if let Some(scheme) = arguments.scheme {
        configuration.fingers.iter_mut().for_each(|finger| finger.controller.scheme = Some(scheme));
    }
    configuration.hand.rate = arguments.rate.unwrap_or(configuration.hand.rate);
    let search = Search { samples: arguments.samples, seed: arguments.seed };
    let mut found: Vec<(FingerNumber, StiffnessBound)> = Vec::new();
    for number in Fingers::of(&arguments.fingers)?.numbers() {
        let number = FingerNumber::try_from(number)?;
        let finger = &configuration.fingers[number.index()];
        let twin = found.iter().find(|&&(other, _)| alike(finger, &configuration.fingers[other.index()]));
        let bound = match twin {
            Some(&(_, bound)) => bound,
            None => search
                .bound(finger, configuration.hand.rate)
                .map_err(|unusable| format!("finger {number}: {} {}", unusable.key, unusable.reason))?,
        };
        report(&configuration, number, &bound, twin.map(|&(other, _)| other))?;
        found.push((number, bound));
    }
    let Some(path) = arguments.config.as_ref().filter(|_| arguments.write) else { return Ok(()) };
    let bounds = found.iter().map(|&(number, bound)| Found::bound(bound.stiffness, number, &configuration));
    hand::store_findings(path, &bounds.collect::<Vec<_>>())?;
    writeln!(io::stdout(), "written to {}", ShownPath(path))?;
    Ok(())
}

/// Whether two fingers are equal in everything that stability depends on.
fn alike(one: &ConfiguredFinger, other: &ConfiguredFinger) -> bool {
    let parts = |of: &ConfiguredFinger| {
        (of.geometry.clone(), of.motor.clone(), of.tendon.clone(), of.joints.clone(), of.links.clone())
    };
    parts(one) == parts(other) && one.friction == other.friction && one.controller == other.controller
}

fn report(
    configuration: &Configuration,
    number: FingerNumber,
    bound: &StiffnessBound,
    twin: Option<FingerNumber>,
) -> io::Result<()> {
    let mut output = io::stdout().lock();
    writeln!(output, "finger {number}: {:.1} N/cm at {} Hz", bound.stiffness, configuration.hand.rate)?;
    if let Some(twin) = twin {
        return writeln!(output, "    as for finger {twin}");
    }
    let degrees =
        |pose: sun2xp::nalgebra::Vector3<f64>| format!("{:.0?} degrees", pose.map(f64::to_degrees).as_slice());
    match bound.limit {
        Limit::Unstable(pose) => writeln!(output, "    above this, the finger is unstable at {}", degrees(pose))?,
        Limit::Scaled(pose) => {
            writeln!(output, "    above this, the servo would scale Kx down by more than half at {}", degrees(pose))?
        }
    }
    writeln!(
        output,
        "    {} samples stable; in {:.1} % of the poses the servo scales Kx down, at worst by a factor of {:.2}",
        bound.samples,
        100.0 * bound.scaled,
        bound.least_scale
    )?;
    let (near, unstable, distance) = bound.near_axis;
    match unstable {
        0 => writeln!(output, "    {near} samples with the tip within 3 cm of the axis of joint 0: all stable"),
        _ => writeln!(
            output,
            "    not covered: {unstable} of {near} samples with the tip within 3 cm of the axis of joint 0 are \
             unstable, at distances of up to {distance:.1} cm"
        ),
    }
}

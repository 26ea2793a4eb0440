//! The bound over the set of plants, without and with walls.

use super::{Arguments, degrees};
use crate::failure::Failure;
use std::io::{self, Write};
use sun2xp::control::Law;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::stability::{Limit, Rest, Search, StiffnessBound, Variant};

/// Samples for each plant of the set, without and with walls.
const SAMPLES_OF_SET: usize = 400;

/// Samples for the nominal plant alone.
const SAMPLES_OF_NOMINAL: usize = 2000;

/// The bound for one plant.
struct Member {
    variant: Variant,
    search: Search,
    bound: StiffnessBound,
}

/// Searches the bounds of all plants, prints them, and returns the least one, N/cm.
pub fn report(
    arguments: &Arguments,
    number: FingerNumber,
    finger: &ConfiguredFinger,
    rate: f64,
) -> Result<f64, Failure> {
    let variants = if arguments.nominal { &Variant::SET[..1] } else { &Variant::SET[..] };
    let usual = if arguments.nominal { SAMPLES_OF_NOMINAL } else { SAMPLES_OF_SET };
    let samples = arguments.samples.unwrap_or(usual);
    let walls: &[bool] = if arguments.free { &[false] } else { &[false, true] };
    writeln!(io::stdout(), "finger {number}, bounds in N/cm:\n    {}", heading(walls))?;
    let mut least: Option<Member> = None;
    for variant in variants {
        write!(io::stdout(), "    ")?;
        for &walls in walls {
            let search = Search { samples, seed: arguments.seed, walls };
            let bound = search
                .bound(finger, rate, variant)
                .map_err(|unusable| format!("finger {number}: {} {}", unusable.key, unusable.reason))?;
            write!(io::stdout(), "{:>13.1}  ", bound.stiffness)?;
            io::stdout().flush()?;
            if least.as_ref().is_none_or(|least| bound.stiffness < least.bound.stiffness) {
                least = Some(Member { variant: *variant, search, bound });
            }
        }
        writeln!(io::stdout(), "{}", variant.name)?;
    }
    let least = least.ok_or("the set of plants is empty")?;
    least.report(number, rate)?;
    let near = least
        .search
        .near_axis(finger, rate, &least.variant, least.bound.stiffness)
        .map_err(|unusable| format!("finger {number}: {} {}", unusable.key, unusable.reason))?;
    let found = match near.unstable {
        0 => "all stable".to_owned(),
        unstable => format!("{unstable} unstable, up to {:.1} cm from the axis", near.distance),
    };
    let samples = near.samples;
    writeln!(
        io::stdout(),
        "    not covered: {samples} samples with the tip within 3 cm of the axis of joint 0, {found}"
    )?;
    Ok(least.bound.stiffness)
}

fn heading(walls: &[bool]) -> String {
    let columns = walls.iter().map(|&walls| if walls { "against walls" } else { "free" });
    columns.map(|column| format!("{column:>13}  ")).collect::<String>() + "plant"
}

impl Member {
    fn report(&self, number: FingerNumber, rate: f64) -> io::Result<()> {
        let mut output = io::stdout().lock();
        let Self { variant, bound, search } = self;
        let place = if search.walls { "against walls" } else { "free" };
        writeln!(
            output,
            "finger {number}: {:.1} N/cm at {rate} Hz, limited by: {}, {place}",
            bound.stiffness, variant.name
        )?;
        match &bound.limit {
            Limit::Unstable(rest) => writeln!(output, "    above this, unstable: {}", sample(rest))?,
            Limit::Scaled(pose) => writeln!(
                output,
                "    above this, the servo would scale Kx down by more than half at {}",
                degrees(pose)
            )?,
        }
        if bound.stiffness == 0.0 {
            return Ok(());
        }
        writeln!(
            output,
            "    {} samples stable for each plant; in {:.1} % of the poses the servo scales Kx down, at worst by a \
             factor of {:.2}",
            bound.samples,
            100.0 * bound.scaled,
            bound.least_scale
        )
    }
}

/// Returns a sample as text.
fn sample(rest: &Rest) -> String {
    let contact = match rest.dimensions() {
        1 => "frictionless point",
        3 => "hard finger",
        _ => "soft finger",
    };
    let law = match rest.law {
        Law::Exact => "the exact law",
        _ => "the report's law",
    };
    let wall = rest.wall.map_or(String::new(), |wall| format!(", wall of {:.0} N/cm", wall.stiffness));
    format!("{}, {contact}, {law}, damping {:.2}{wall}", degrees(&rest.joints), rest.damping)
}

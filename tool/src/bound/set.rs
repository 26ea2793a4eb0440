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

/// Fraction of the samples of the nominal plant without walls. If more are unstable at any stiffness, the controller is
/// useless. A few almost straight poses with a very slow motion do not make it so.
const USELESS: f64 = 0.1;

/// The bound for one plant.
struct Member {
    variant: Variant,
    search: Search,
    bound: StiffnessBound,
}

/// Searches the bounds of all plants, prints them, and returns the least one, N/cm. Except for the nominal plant
/// without walls, a plant with samples that are unstable at any stiffness does not count: no bound makes it stable.
///
/// # Errors
/// If the nominal plant without walls is often unstable at any stiffness, there is no bound.
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
    let columns: String = walls.iter().map(|&walls| format!("{:>22}", place(walls))).collect();
    writeln!(io::stdout(), "finger {number}, bounds in N/cm (samples that are unstable at any stiffness):")?;
    writeln!(io::stdout(), "{columns}  plant")?;
    let mut members: Vec<Member> = Vec::new();
    for variant in variants {
        for &walls in walls {
            let search = Search { samples, seed: arguments.seed, walls };
            let bound = search
                .bound(finger, rate, variant)
                .map_err(|unusable| format!("finger {number}: {} {}", unusable.key, unusable.reason))?;
            let uncovered = match bound.uncovered.len() {
                0 => String::new(),
                uncovered => format!("({uncovered} of {})", bound.samples),
            };
            write!(io::stdout(), "{:>8.1} {uncovered:<13}", bound.stiffness)?;
            io::stdout().flush()?;
            members.push(Member { variant: *variant, search, bound });
        }
        writeln!(io::stdout(), "  {}", variant.name)?;
    }
    let nominal = members.first().ok_or("the set of plants is empty")?;
    if nominal.bound.uncovered.len() as f64 > USELESS * nominal.bound.samples as f64 {
        return Err(format!(
            "finger {number}: controller leaves the finger unstable at any stiffness in {} of {} poses: remove the \
             gains from this table, or choose another scheme",
            nominal.bound.uncovered.len(),
            nominal.bound.samples
        )
        .into());
    }
    let others = members[1..].iter().filter(|member| member.bound.uncovered.is_empty());
    let least = others.chain([nominal]).min_by(|one, other| one.bound.stiffness.total_cmp(&other.bound.stiffness));
    let least = least.ok_or("the set of plants is empty")?;
    least.report(number, rate)?;
    report_uncovered(&members)?;
    report_near_axis(&least.search, finger, rate, least.bound.stiffness)?;
    Ok(least.bound.stiffness)
}

/// Prints which plants have samples that the bound does not cover.
fn report_uncovered(members: &[Member]) -> io::Result<()> {
    for Member { variant, search, bound } in members {
        let stiffnesses = bound.uncovered.iter().filter_map(|rest| rest.wall).map(|wall| wall.stiffness);
        let walls = match search.walls {
            true => format!(" of {:.0} N/cm and more", stiffnesses.fold(f64::INFINITY, f64::min)),
            false => String::new(),
        };
        if let Some(first) = bound.uncovered.first() {
            let (number, samples, place) = (bound.uncovered.len(), bound.samples, place(search.walls));
            let name = variant.name;
            writeln!(
                io::stdout(),
                "    not covered: {name}, {place}{walls}: {number} of {samples}, for example {}",
                sample(first)
            )?;
        }
    }
    Ok(())
}

fn report_near_axis(search: &Search, finger: &ConfiguredFinger, rate: f64, stiffness: f64) -> Result<(), Failure> {
    let near = search
        .near_axis(finger, rate, &Variant::NOMINAL, stiffness)
        .map_err(|unusable| format!("{} {}", unusable.key, unusable.reason))?;
    let found = match near.unstable {
        0 => "all stable".to_owned(),
        unstable => format!("{unstable} unstable, up to {:.1} cm from the axis", near.distance),
    };
    let samples = near.samples;
    writeln!(
        io::stdout(),
        "    not covered: {samples} samples with the tip within 3 cm of the axis of joint 0, {found}"
    )?;
    Ok(())
}

fn place(walls: bool) -> &'static str {
    if walls { "against walls" } else { "free" }
}

impl Member {
    fn report(&self, number: FingerNumber, rate: f64) -> io::Result<()> {
        let mut output = io::stdout().lock();
        let Self { variant, bound, search } = self;
        let place = place(search.walls);
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
        writeln!(
            output,
            "    {} samples for each plant; in {:.1} % of the poses the servo scales Kx down, at worst by a factor of \
             {:.2}",
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

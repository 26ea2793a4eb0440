//! Finds the bound of Kx (the largest eigenvalue that Kx may have) over the set of plants, without and with walls.

use super::sample::{Sample, degrees, pose};
use super::{Arguments, Searched};
use crate::failure::Failure;
use crate::print::{Cell, Look, Progress, Screen, Table};
use serde::Serialize;
use std::io::{self, Write};
use sun2xp::stability::{Limit, Search, StiffnessBound, Variant};

/// Number of samples for each plant of the set without walls, and again with walls.
const SAMPLES_OF_SET: usize = 400;

/// Number of samples without walls, and again with walls, if the set is only the nominal plant.
const SAMPLES_OF_NOMINAL: usize = 2000;

/// A controller is useless if more than this fraction of the samples are unstable even at 1 N/cm. The samples are those
/// of the nominal plant without walls. A smaller fraction is permitted, because a few almost straight poses have a very
/// slow motion, which counts as unstable.
const USELESS: f64 = 0.1;

/// The error text for an empty set of plants. The set is never empty, whatever the arguments are.
const NO_PLANT: &str = "the set of plants is empty. This is a defect of sun2xp: please report it";

/// The bounds of all plants.
#[derive(Debug, Serialize)]
pub struct SetBound {
    plants: Vec<Member>,
    /// Index of the plant that limits the bound.
    limited_by: usize,
    near_axis: NearAxis,
}

/// The bound for one plant.
#[derive(Debug, Serialize)]
struct Member {
    plant: &'static str,
    walls: bool,
    /// N/cm.
    bound: f64,
    limit: LimitFound,
    /// Number of samples clear of the axis of joint 0.
    samples: usize,
    /// Number of samples that are unstable even at 1 N/cm. The bound does not cover them.
    uncovered: usize,
    uncovered_example: Option<Sample>,
    /// The softest wall of an uncovered sample, N/cm. `None` without walls or uncovered samples.
    uncovered_from_wall: Option<f64>,
    /// Fraction of the poses in which the servo scales Kx down.
    scaled: f64,
    /// The smallest factor by which the servo scales Kx down.
    least_scale: f64,
}

/// What prevents a larger bound.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum LimitFound {
    /// With a larger bound, this sample is unstable.
    Unstable(Sample),
    /// With a larger bound, the tendons support less than half of it in the pose with these joint angles.
    ScaledBelowHalf { joints_degrees: [f64; 3] },
}

/// The samples with the tip within 3 cm of the axis of joint 0.
#[derive(Debug, Serialize)]
struct NearAxis {
    samples: usize,
    unstable: usize,
    /// Largest distance of an unstable tip from the axis, cm.
    distance: f64,
}

/// Returns the number of searches for one finger, which are the steps of the progress.
pub fn searches(arguments: &Arguments) -> usize {
    variants(arguments).len() * places(arguments).len() + 1
}

fn variants(arguments: &Arguments) -> &'static [Variant] {
    if arguments.nominal { &Variant::SET[..1] } else { &Variant::SET[..] }
}

fn places(arguments: &Arguments) -> &'static [bool] {
    if arguments.free { &[false] } else { &[false, true] }
}

/// Finds the bounds of all plants, and returns the least one, N/cm. Except for the nominal plant without walls, a plant
/// with samples that are unstable even at 1 N/cm does not count: no bound makes it stable.
///
/// # Errors
/// Returns an error if the controller is useless (see `USELESS`). Also returns the errors of [`Search::bound`] and
/// [`Search::near_axis`].
pub fn search(arguments: &Arguments, searched: &Searched, progress: &Progress) -> Result<(f64, SetBound), Failure> {
    let Searched { number, finger, rate } = *searched;
    let usual = if arguments.nominal { SAMPLES_OF_NOMINAL } else { SAMPLES_OF_SET };
    let samples = arguments.samples.map_or(usual, |samples| samples as usize);
    let mut plants: Vec<Member> = Vec::new();
    for variant in variants(arguments) {
        for &walls in places(arguments) {
            progress.now(format!("finger {number}, {}, {}", variant.name, place(walls)));
            let search = Search { samples, seed: arguments.seed, walls };
            let bound =
                search.bound(finger, rate, variant).map_err(|unusable| format!("finger {number}: {unusable}"))?;
            plants.push(Member::new(variant, walls, &bound));
            progress.step();
        }
    }
    let nominal = plants.first().ok_or(NO_PLANT)?;
    if nominal.uncovered as f64 > USELESS * nominal.samples as f64 {
        return Err(format!(
            "finger {number}: in {} of {} poses the controller leaves the finger unstable even at 1 N/cm: remove the \
             gains from the table `controller`, or choose another scheme",
            nominal.uncovered, nominal.samples
        )
        .into());
    }
    // The nominal plant without walls is the first one. It limits the bound if no other plant that counts has a lower
    // bound.
    let counts = |&(index, member): &(usize, &Member)| index == 0 || member.uncovered == 0;
    let numbered = plants.iter().enumerate().filter(counts);
    let least = numbered.min_by(|(_, one), (_, other)| one.bound.total_cmp(&other.bound));
    let (limited_by, least) = least.ok_or(NO_PLANT)?;
    let stiffness = least.bound;
    let near = Search { samples, seed: arguments.seed, walls: least.walls }
        .near_axis(finger, rate, &Variant::NOMINAL, stiffness)
        .map_err(|unusable| format!("finger {number}: {unusable}"))?;
    progress.step();
    let near_axis = NearAxis { samples: near.samples, unstable: near.unstable, distance: near.distance };
    Ok((stiffness, SetBound { plants, limited_by, near_axis }))
}

fn place(walls: bool) -> &'static str {
    if walls { "against walls" } else { "without walls" }
}

impl Member {
    fn new(variant: &Variant, walls: bool, bound: &StiffnessBound) -> Self {
        let stiffnesses = bound.uncovered.iter().filter_map(|rest| rest.wall).map(|wall| wall.stiffness);
        Self {
            plant: variant.name,
            walls,
            bound: bound.stiffness,
            limit: match &bound.limit {
                Limit::Unstable(rest) => LimitFound::Unstable(Sample::new(rest)),
                Limit::Scaled(pose) => LimitFound::ScaledBelowHalf { joints_degrees: degrees(pose) },
            },
            samples: bound.samples,
            uncovered: bound.uncovered.len(),
            uncovered_example: bound.uncovered.first().map(Sample::new),
            uncovered_from_wall: stiffnesses.reduce(f64::min),
            scaled: bound.scaled,
            least_scale: bound.least_scale,
        }
    }

    /// The text of the bound and, in brackets, the number of samples that the bound does not cover.
    fn cells(&self, limits: bool) -> [Cell; 2] {
        let uncovered = match self.uncovered {
            0 => String::new(),
            uncovered => format!("({uncovered} of {})", self.samples),
        };
        let look = match (limits, self.uncovered) {
            (true, _) => Look::Title,
            (false, 0) => Look::Plain,
            (false, _) => Look::Dim,
        };
        [Cell::new(look, format!("{:.1}", self.bound)), Cell::new(Look::Dim, uncovered)]
    }
}

impl SetBound {
    /// What limits the bound, in one line.
    pub fn limit(&self) -> String {
        let least = &self.plants[self.limited_by];
        let (plant, place) = (least.plant, place(least.walls));
        match &least.limit {
            LimitFound::Unstable(sample) => {
                format!("{plant}, {place}; above the bound the finger is unstable at {}", sample.text())
            }
            LimitFound::ScaledBelowHalf { joints_degrees } => format!(
                "{plant}, {place}; above the bound the servo would scale Kx down by more than half at {}",
                pose(joints_degrees)
            ),
        }
    }

    pub fn write(&self, out: &mut impl Write, screen: &Screen, searched: &Searched) -> io::Result<()> {
        let Searched { number, rate, .. } = searched;
        writeln!(
            out,
            "finger {number}, bounds in N/cm; in brackets, the number of samples that are unstable even at 1 N/cm:\n"
        )?;
        write!(out, "{}", self.table().text(screen))?;
        let least = &self.plants[self.limited_by];
        writeln!(
            out,
            "\nfinger {number}: {:.1} N/cm at {rate} Hz, limited by: {}, {}",
            least.bound,
            least.plant,
            place(least.walls)
        )?;
        match &least.limit {
            LimitFound::Unstable(sample) => {
                writeln!(out, "    above the bound, the finger is unstable at {}", sample.text())?
            }
            LimitFound::ScaledBelowHalf { joints_degrees } => writeln!(
                out,
                "    above the bound, the servo would scale Kx down by more than half at {}",
                pose(joints_degrees)
            )?,
        }
        writeln!(
            out,
            "    {} samples of this plant; in {:.1} % of the poses the servo scales Kx down, at worst by a factor of \
             {:.2}",
            least.samples,
            100.0 * least.scaled,
            least.least_scale
        )?;
        self.write_uncovered(out)
    }

    fn table(&self) -> Table {
        let has_walls = self.plants.iter().any(|member| member.walls);
        let mut table = match has_walls {
            true => Table::new(["plant", "free", "", "against walls", ""]).numeric([1, 3]),
            false => Table::new(["plant", "free", ""]).numeric([1]),
        };
        let columns = if has_walls { 2 } else { 1 };
        for (row, members) in self.plants.chunks(columns).enumerate() {
            let cells = members
                .iter()
                .enumerate()
                .flat_map(|(column, member)| member.cells(row * columns + column == self.limited_by));
            table.row([Cell::from(members[0].plant)].into_iter().chain(cells));
        }
        table
    }

    /// Writes which samples the bound does not cover.
    fn write_uncovered(&self, out: &mut impl Write) -> io::Result<()> {
        for (index, member) in self.plants.iter().enumerate() {
            let Some(example) = &member.uncovered_example else { continue };
            let softest = member.uncovered_from_wall;
            let walls = softest.map_or(String::new(), |wall| format!(", at walls of {wall:.0} N/cm and more"));
            let consequence = match index {
                0 => "The other samples of this plant count for the bound",
                _ => "This plant does not limit the bound",
            };
            writeln!(
                out,
                "    {}, {}: {} of {} samples are unstable even at 1 N/cm{walls}, for example {}. {consequence}",
                member.plant,
                place(member.walls),
                member.uncovered,
                member.samples,
                example.text()
            )?;
        }
        let NearAxis { samples, unstable, distance } = self.near_axis;
        let found = match unstable {
            0 => "all of them are stable".to_owned(),
            unstable => format!("{unstable} of them are unstable, the farthest at {distance:.1} cm from the axis"),
        };
        writeln!(
            out,
            "    not counted for the bound: {samples} samples with the tip within 3 cm of the axis of joint 0. With Kx \
             at the bound, {found}"
        )
    }
}

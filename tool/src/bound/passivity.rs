//! The passivity of the fingertip, a number from `Admittance::passivity`. The tip is passive at a frequency at which
//! this number is not negative.

use super::sample::{degrees, pose};
use super::{Arguments, Searched};
use crate::failure::Failure;
use crate::print::{Cell, Look, Progress, Screen, Table};
use serde::Serialize;
use std::io::{self, Write};
use sun2xp::control::Law;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::{Matrix3, Vector3};
use sun2xp::stability::{OneCycleMap, Rest};

/// Number of poses if --samples is not given.
const POSES: usize = 4;

/// Lowest and highest frequency, Hz, and the number of steps between them. Every step has the same ratio.
const LOWEST: f64 = 1.0;
const HIGHEST: f64 = 400.0;
const STEPS: i32 = 26;

/// Difference between the desired joint angles (the anchor of the spring) and the joint angles, rad. It is not 0,
/// because eq. 20 of the report has a kink at zero load.
const DEFLECTION: f64 = 0.01;

/// Smallest distance of the tip from the axis of joint 0 in a pose, cm. Nearer poses are nearly singular.
const CLEAR_OF_AXIS: f64 = 3.0;

/// The passivity of the tip in several poses.
#[derive(Debug, Serialize)]
pub struct Passivity {
    /// Hz.
    frequencies: Vec<f64>,
    poses: Vec<Pose>,
}

#[derive(Debug, Serialize)]
struct Pose {
    joints_degrees: [f64; 3],
    /// The passivity at every frequency. `None` if the finger does not come to rest in the pose, or a tendon is slack.
    passivity: Option<Vec<f64>>,
}

/// Computes the passivity of the tip. Returns the stiffness at which it was computed, N/cm, and the passivity.
pub fn compute(arguments: &Arguments, searched: &Searched, progress: &Progress) -> Result<(f64, Passivity), Failure> {
    let Searched { number, finger, rate } = *searched;
    let map = OneCycleMap::new(finger, rate).map_err(|unusable| format!("finger {number}: {unusable}"))?;
    let stiffness = finger.stiffness_bound(rate);
    let ratio = (HIGHEST / LOWEST).powf(1.0 / f64::from(STEPS));
    let frequencies: Vec<f64> = (0..=STEPS).map(|step| LOWEST * ratio.powi(step)).collect();
    let mut computed = Vec::new();
    for pose in poses(finger, number_of_poses(arguments)) {
        progress.now(format!("finger {number}, passivity"));
        let deflection = Vector3::repeat(DEFLECTION);
        let rest = Rest::hard_finger(pose, deflection, &(Matrix3::identity() * stiffness));
        let found = map.admittances(&Rest { law: Law::Exact, ..rest }, &frequencies);
        let passivity = found.map(|found| found.iter().map(|admittance| admittance.passivity()).collect());
        computed.push(Pose { joints_degrees: degrees(&pose), passivity });
        progress.step();
    }
    Ok((stiffness, Passivity { frequencies, poses: computed }))
}

/// Returns the number of poses for one finger. Each pose is one step of the progress.
pub fn number_of_poses(arguments: &Arguments) -> usize {
    arguments.samples.map_or(POSES, |samples| samples as usize)
}

impl Passivity {
    pub fn write(&self, out: &mut impl Write, screen: &Screen, searched: &Searched, stiffness: f64) -> io::Result<()> {
        let Searched { number, rate, .. } = searched;
        writeln!(
            out,
            "finger {number}: {stiffness:.1} N/cm at {rate} Hz\n    passivity of the tip by frequency and pose:\n"
        )?;
        let computed = || self.poses.iter().filter_map(|pose| Some((&pose.joints_degrees, pose.passivity.as_ref()?)));
        let letters = || (0..computed().count()).map(letter);
        let mut table = Table::titled(["Hz".to_owned()].into_iter().chain(letters())).numeric(0..=computed().count());
        for (row, frequency) in self.frequencies.iter().enumerate() {
            let cells = computed().map(|(_, passivity)| {
                let look = if passivity[row] < 0.0 { Look::Warning } else { Look::Plain };
                Cell::new(look, format!("{:.4}", passivity[row]))
            });
            table.row([Cell::from(format!("{frequency:.1}"))].into_iter().chain(cells));
        }
        writeln!(out, "{}", table.text(screen))?;
        for (letter, (joints, passivity)) in letters().zip(computed()) {
            let numbered = self.frequencies.iter().zip(passivity);
            let Some((frequency, least)) = numbered.min_by(|(_, one), (_, other)| one.total_cmp(other)) else {
                continue;
            };
            writeln!(out, "    {letter}: {}, least passivity {least:.4} at {frequency:.1} Hz", pose(joints))?;
        }
        for unsettled in self.poses.iter().filter(|pose| pose.passivity.is_none()) {
            let pose = pose(&unsettled.joints_degrees);
            writeln!(out, "    {pose}: the finger does not come to rest, or a tendon is slack")?;
        }
        Ok(())
    }
}

/// The name of a column: a to z, then a1, b1 and so on.
fn letter(index: usize) -> String {
    let letter = char::from(b'a' + (index % 26) as u8);
    if index < 26 { letter.to_string() } else { format!("{letter}{}", index / 26) }
}

/// Returns poses that are spread evenly over the joint ranges: the first points of a Halton sequence that are clear of
/// the axis of joint 0.
fn poses(finger: &ConfiguredFinger, number: usize) -> Vec<Vector3<f64>> {
    let (low, high) = finger.joint_limits();
    let links = finger.links();
    // A finger whose joint limits leave no pose clear of the axis has no poses.
    (1..=number.saturating_mul(100))
        .map(|index| Vector3::new(2, 3, 5).map(|base| radical_inverse(index, base)))
        .map(|part| low + (high - low).component_mul(&part))
        .filter(|pose| links.reach(pose).abs() >= CLEAR_OF_AXIS)
        .take(number)
        .collect()
}

/// Returns the digits of `index` in `base`, mirrored at the radix point: a number from 0 to 1.
fn radical_inverse(mut index: usize, base: usize) -> f64 {
    let (mut inverse, mut digit) = (0.0, 1.0 / base as f64);
    while index > 0 {
        inverse += (index % base) as f64 * digit;
        index /= base;
        digit /= base as f64;
    }
    inverse
}

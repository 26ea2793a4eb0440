//! The passivity of the fingertip.

use super::{Arguments, degrees};
use crate::failure::Failure;
use std::io::{self, Write};
use sun2xp::control::Law;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::{Matrix3, Vector3};
use sun2xp::stability::{OneCycleMap, Rest};

/// Number of poses.
const POSES: usize = 4;

/// Lowest and highest frequency, Hz, and the number of steps between them. Every step has the same ratio.
const LOWEST: f64 = 1.0;
const HIGHEST: f64 = 400.0;
const STEPS: i32 = 26;

/// Difference between anchor and joint angles, rad. At zero load eq. 20 has a kink.
const DEFLECTION: f64 = 0.01;

/// Distance of the tip from the axis of joint 0 in every pose, cm. Nearer poses are nearly singular.
const CLEAR_OF_AXIS: f64 = 3.0;

/// Prints the passivity of the tip, and returns the stiffness at which it was computed, N/cm.
pub fn report(
    arguments: &Arguments,
    number: FingerNumber,
    finger: &ConfiguredFinger,
    rate: f64,
) -> Result<f64, Failure> {
    let map = OneCycleMap::new(finger, rate)
        .map_err(|unusable| format!("finger {number}: {} {}", unusable.key, unusable.reason))?;
    let stiffness = finger.stiffness_bound(rate);
    let ratio = (HIGHEST / LOWEST).powf(1.0 / f64::from(STEPS));
    let frequencies: Vec<f64> = (0..=STEPS).map(|step| LOWEST * ratio.powi(step)).collect();
    let mut output = io::stdout();
    writeln!(
        output,
        "finger {number}: {stiffness:.1} N/cm at {rate} Hz\n    passivity of the tip by frequency (Hz) and pose:"
    )?;
    let mut columns = Vec::new();
    for pose in poses(finger, arguments.samples.unwrap_or(POSES)) {
        let deflection = Vector3::repeat(DEFLECTION);
        let rest = Rest::hard_finger(pose, deflection, &(Matrix3::identity() * stiffness));
        let Some(found) = map.admittances(&Rest { law: Law::Exact, ..rest }, &frequencies) else {
            writeln!(output, "    {}: the finger does not come to rest", degrees(&pose))?;
            continue;
        };
        columns.push((pose, found.iter().map(|admittance| admittance.passivity()).collect::<Vec<_>>()));
    }
    let letters = columns.iter().zip('a'..);
    write!(output, "        Hz")?;
    for (_, letter) in letters.clone() {
        write!(output, "{letter:>9}")?;
    }
    for (row, frequency) in frequencies.iter().enumerate() {
        write!(output, "\n    {frequency:6.1}")?;
        for (_, passivities) in &columns {
            write!(output, "{:>9.4}", passivities[row])?;
        }
    }
    writeln!(output)?;
    for ((pose, passivities), letter) in letters {
        let least = (0..frequencies.len()).min_by(|&one, &other| passivities[one].total_cmp(&passivities[other]));
        let Some(least) = least else { continue };
        writeln!(
            output,
            "    {letter}: {}, least {:.4} of |Y| at {:.1} Hz",
            degrees(pose),
            passivities[least],
            frequencies[least]
        )?;
    }
    Ok(stiffness)
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

/// Returns the digits of `index` in `base`, mirrored at the point: a number from 0 to 1.
fn radical_inverse(mut index: usize, base: usize) -> f64 {
    let (mut inverse, mut digit) = (0.0, 1.0 / base as f64);
    while index > 0 {
        inverse += (index % base) as f64 * digit;
        index /= base;
        digit /= base as f64;
    }
    inverse
}

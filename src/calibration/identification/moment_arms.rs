//! Determines the moment arms of the tendons from the motor travel between the stops of the joints.
//!
//! While one joint moves from its lower to its upper stop and the others rest, the travel of every motor, less the
//! change of the stretch, is the moment arm times the range of the joint. The mean of two readings at the lower stop,
//! one before and one after the motion, eliminates slow drift. If the angles of the stops are not known exactly, only
//! the ratios of the moment arms of a joint are measured.

use super::tendon_stiffness::StiffnessFound;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::model::Part;
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// The configured moment arms stay if each differs from the measured one by at most this part of the largest moment arm
/// of its joint. On the simulated finger the measurement is accurate to 0.3 %.
pub(super) const SIGNIFICANT: f64 = 0.01;
/// Largest plausible difference between a configured and a measured moment arm, as a part of the largest moment arm of
/// the joint.
const LARGEST: f64 = 0.2;
/// Largest plausible difference between the measured and the configured range of a joint, as a part of the configured
/// range. The measured range is computed from the motor travel with the configured moment arms. A larger difference
/// means that something blocks the joint, or that its stops are not where they are configured.
const RANGE: f64 = 0.08;

/// Mean readings of a finger at rest.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rest {
    /// Motor travel, cm.
    pub travel: Vector4<f64>,
    /// Tensions, N.
    pub tensions: Vector4<f64>,
    /// Directions in which the tendons last slid in their conduits, -1 to 1.
    pub winding: Vector4<f64>,
}

/// Readings of a finger at its stops.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct MomentArms {
    /// All joints at their lower stops: before each joint moves to its upper stop, and at the end.
    pub lower: [Rest; 4],
    /// One joint at its upper stop.
    pub upper: [Rest; 3],
}

/// Moment arms that differ from the configured ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MomentArmsFound {
    /// R, cm.
    pub r: Matrix3x4<f64>,
    /// Motor travel with all joints at zero and without tension, cm.
    pub at_zero: Vector4<f64>,
}

impl MomentArms {
    /// Returns the largest uncertainty of a moment arm, as a part of the largest moment arm of its joint. The
    /// uncertainty is half of the difference between the arms that the motions up and down give.
    pub fn uncertainty(
        &self,
        instruments: &Instruments,
        elasticity: &StiffnessFound,
        stops: &(Vector3<f64>, Vector3<f64>),
    ) -> f64 {
        let travel = |rest: &Rest| rest.travel - elasticity.stretch(&rest.tensions, &rest.winding);
        let of_joint = |joint: usize| {
            let between = travel(&self.lower[joint + 1]) - travel(&self.lower[joint]);
            let range = stops.1[joint] - stops.0[joint];
            0.5 * between.amax() / (range * instruments.tendons.r.row(joint).amax())
        };
        (0..3).map(of_joint).fold(0.0, f64::max)
    }

    /// Returns R if it differs from the configured one by more than [`SIGNIFICANT`]. `stops` are the angles of the
    /// lower and upper stops, rad. `known` says whether they are known exactly.
    pub fn solve(
        &self,
        instruments: &Instruments,
        elasticity: &StiffnessFound,
        stops: &(Vector3<f64>, Vector3<f64>),
        known: bool,
    ) -> Result<Option<MomentArmsFound>, Obstacle> {
        let configured = &instruments.tendons.r;
        let travel = |rest: &Rest| rest.travel - elasticity.stretch(&rest.tensions, &rest.winding);
        let lower = self.lower.each_ref().map(travel);
        let upper = self.upper.each_ref().map(travel);
        let mut r = *configured;
        let mut significant = false;
        for joint in 0..3 {
            let moved = upper[joint] - (lower[joint] + lower[joint + 1]) * 0.5;
            let row = configured.row(joint).transpose();
            let (expected, range) = (stops.1[joint] - stops.0[joint], row.dot(&moved) / row.norm_squared());
            if known && (range / expected - 1.0).abs() > RANGE {
                let [degrees, expected] = [range, expected].map(f64::to_degrees);
                return Err(Obstacle::WrongRange { joint: joint as u8, degrees, expected });
            }
            let found = moved / if known { expected } else { range };
            let difference = (found - row).amax() / row.amax();
            if difference > LARGEST {
                let what = "the relative error of geometry.r";
                return Err(Obstacle::Implausible { part: Part::joint(joint), what, value: difference });
            }
            significant |= difference > SIGNIFICANT;
            r.set_row(joint, &found.transpose());
        }
        let at_lower_stops = lower.iter().sum::<Vector4<f64>>() / 4.0;
        let at_zero = at_lower_stops - r.tr_mul(&stops.0);
        Ok(significant.then_some(MomentArmsFound { r, at_zero }))
    }
}

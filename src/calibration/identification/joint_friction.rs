//! Determines the friction of the joints from the torque R t that moves a joint back and forth at two speeds.
//!
//! (R t)_j = g + s (C + b |v|), with s the sign of the motion. The two speeds separate Coulomb friction C from viscous
//! friction b. Gravity g does not change with direction, and is discarded.

use super::least_squares::LeastSquares;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::Vector3;

/// Speed, rad/s, and amplitude, rad, of each motion.
const SWINGS: [(f64, f64); 2] = [(0.15, 0.4), (0.6, 0.8)];
/// Distance of the back-and-forth motion from the stop, rad. The last leg aims this far beyond the stop, so that the
/// finger presses against it.
const CLEAR: f64 = 0.1;
/// Samples are ignored for this time after every change of direction, s. An extended finger oscillates for this time,
/// and meanwhile its inertia takes as much torque as its friction.
const RUN_UP: f64 = 0.5;
/// A joint is blocked if its torque stays at the limit for this time, s.
const BLOCKED: f64 = 0.3;
/// Speed of the motions away from the stop and back to the stop, rad/s.
const IN_BETWEEN: f64 = 0.7;

#[derive(Clone, Copy, Debug)]
pub(super) struct JointFriction {
    joint: usize,
    /// The angle of the joint at its lower stop, rad, measured from the configured zero.
    stop: f64,
    /// 0: away from the stop. 1 and 2: back and forth slowly. 3 and 4: back and forth faster. 5: back to the stop.
    leg: usize,
    /// Anchor at the beginning of the leg, rad.
    from: Option<f64>,
    strained: f64,
    fit: LeastSquares<3>,
}

impl JointFriction {
    pub fn new(joint: usize, stop: f64) -> Self {
        Self { joint, stop, leg: 0, from: None, strained: 0.0, fit: LeastSquares::new() }
    }

    /// Runs one cycle of the motion. When the motion is complete, returns C, N cm, and b, N cm s/rad.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        guide: &mut JointGuide,
    ) -> Result<Option<(f64, f64)>, Obstacle> {
        let joint = self.joint;
        let clear = self.stop + CLEAR;
        let (speed, target) = match self.leg {
            0 => (IN_BETWEEN, clear),
            leg @ 1..=4 => {
                let (speed, amplitude) = SWINGS[(leg - 1) / 2];
                (speed, if leg % 2 == 1 { clear + amplitude } else { clear })
            }
            _ => (IN_BETWEEN, self.stop - CLEAR),
        };
        let from = *self.from.get_or_insert(guide.anchor[joint]);
        guide.advance(joint, target, speed * instruments.period);
        let anchor = guide.anchor[joint];
        if (1..=4).contains(&self.leg) && (anchor - from).abs() > RUN_UP * speed && anchor != target {
            let torque = instruments.tendons.r.row(joint).transpose().dot(&instruments.tensions(sample.feedback));
            let sign = (target - from).signum();
            self.fit.add(&Vector3::new(1.0, sign, sign * speed), torque);
        }
        let strained = guide.strained(joint);
        self.strained = if strained { self.strained + instruments.period } else { 0.0 };
        let last = self.leg == 5;
        if self.strained > BLOCKED && !last {
            return Err(Obstacle::JointBlocked { joint: joint as u8 });
        }
        if last && strained {
            let implausible = |value| Obstacle::Implausible { part: Part::joint(joint), what: "the friction", value };
            let (found, _) = self.fit.solve().ok_or(implausible(f64::NAN))?;
            return Ok(Some((found[1].max(0.0), found[2])));
        }
        if anchor == target && !last {
            (self.leg, self.from) = (self.leg + 1, None);
        }
        Ok(None)
    }
}

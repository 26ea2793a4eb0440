//! Leading the joints: a soft spring in joint space whose torque is bounded, and whose anchor does not run away from a
//! joint that is held.

use super::instruments::Instruments;
use super::step::Sample;
use crate::control::signals::Activity;
use crate::control::spring::joint_hold::HOLDING_STIFFNESS;
use nalgebra::{Vector3, Vector4};

/// Time constant of the low-pass on the joints, s: for supervision, not for the loop.
const SMOOTHING: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
pub(super) struct JointLead {
    pub anchor: Vector3<f64>,
    /// How far the anchor moved in this cycle, rad.
    moved: Vector3<f64>,
    /// Smoothed, rad, by the configured zero.
    pub joints: Vector3<f64>,
    /// Smoothed, N.
    tensions: Vector4<f64>,
    /// Largest torque, N cm.
    limit: f64,
    /// Tension beyond what the torques need, N in the least pulled tendon.
    pub common: f64,
}

impl JointLead {
    /// Holds the pose that the finger is in.
    pub fn new(instruments: &Instruments, sample: &Sample, limit: f64) -> Self {
        let tensions = instruments.tensions(sample.feedback);
        let joints = instruments.joints(&instruments.travel(sample.feedback), &tensions);
        Self { anchor: joints, moved: Vector3::zeros(), joints, tensions, limit, common: 0.0 }
    }

    /// Takes a measurement in.
    pub fn measure(&mut self, instruments: &Instruments, sample: &Sample) {
        self.moved = Vector3::zeros();
        let gain = (instruments.period / SMOOTHING).min(1.0);
        self.tensions += (instruments.tensions(sample.feedback) - self.tensions) * gain;
        let joints = instruments.joints(&instruments.travel(sample.feedback), &self.tensions);
        self.joints += (joints - self.joints) * gain;
    }

    /// Moves the anchor of one joint toward `target`, rad, by at most `step`.
    pub fn advance(&mut self, joint: usize, target: f64, step: f64) {
        let farthest = self.limit / HOLDING_STIFFNESS;
        let anchor = self.anchor[joint] + (target - self.anchor[joint]).clamp(-step, step);
        let before = self.anchor[joint];
        self.anchor[joint] = anchor.clamp(self.joints[joint] - farthest, self.joints[joint] + farthest);
        self.moved[joint] = self.anchor[joint] - before;
    }

    /// Whether the torque of a joint is at its limit: it lags as far behind as it may.
    pub fn strained(&self, joint: usize) -> bool {
        (self.anchor[joint] - self.joints[joint]).abs() > 0.95 * self.limit / HOLDING_STIFFNESS
    }

    /// What holds the joints at their anchors.
    pub fn activity(&self, instruments: &Instruments, sample: &Sample) -> Activity {
        // Against the anchor's own speed, so that a moving joint does not lag.
        let slip = sample.report.joint_rates - self.moved / instruments.period;
        let torques = instruments.hold.torques(&(self.anchor - self.joints), &slip, self.limit);
        let common = instruments.pretension * (self.common / instruments.minimum);
        Activity::Tense(instruments.ask(instruments.distribution.distribute(&torques).tensions + common))
    }
}

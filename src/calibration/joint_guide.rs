//! Moves the joints with a soft spring in joint space. The torque of the spring is limited, and its anchor stays close
//! to a joint that cannot move.

use super::instruments::Instruments;
use super::step::Sample;
use crate::control::signals::Activity;
use crate::control::spring::joint_hold::HOLDING_STIFFNESS;
use nalgebra::{Vector3, Vector4};

/// Time constant of the low-pass filter on the tensions and joint angles, s. The spring uses the filtered angles. The
/// damping uses the joint rates of the controller instead.
const SMOOTHING: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
pub(super) struct JointGuide {
    pub anchor: Vector3<f64>,
    /// Motion of the anchor in this cycle, rad.
    moved: Vector3<f64>,
    /// Filtered joint angles, rad, computed with the configured zeros of the encoders.
    pub joints: Vector3<f64>,
    /// Filtered tensions, N.
    tensions: Vector4<f64>,
    /// Largest torque, N cm.
    limit: f64,
    /// Common tension that is added to the tensions that produce the torques, N. This is the common tension of the
    /// tendon with the smallest pretension. The common tension of each tendon is proportional to its pretension.
    pub common: f64,
}

impl JointGuide {
    /// Holds the current pose of the finger.
    pub fn new(instruments: &Instruments, sample: &Sample, limit: f64) -> Self {
        let tensions = instruments.tensions(sample.feedback);
        let joints = instruments.joints(&instruments.travel(sample.feedback), &tensions);
        Self { anchor: joints, moved: Vector3::zeros(), joints, tensions, limit, common: 0.0 }
    }

    /// Adds the measurement of a cycle.
    pub fn measure(&mut self, instruments: &Instruments, sample: &Sample) {
        self.moved = Vector3::zeros();
        let gain = (instruments.period / SMOOTHING).min(1.0);
        self.tensions += (instruments.tensions(sample.feedback) - self.tensions) * gain;
        let joints = instruments.joints(&instruments.travel(sample.feedback), &self.tensions);
        self.joints += (joints - self.joints) * gain;
    }

    /// Moves the anchor of one joint toward `target`, rad, by at most `step`, and keeps it near the joint.
    pub fn advance(&mut self, joint: usize, target: f64, step: f64) {
        let farthest = self.limit / HOLDING_STIFFNESS;
        let anchor = self.anchor[joint] + (target - self.anchor[joint]).clamp(-step, step);
        let before = self.anchor[joint];
        self.anchor[joint] = anchor.clamp(self.joints[joint] - farthest, self.joints[joint] + farthest);
        self.moved[joint] = self.anchor[joint] - before;
    }

    /// Returns whether the spring torque of a joint is at its limit, because the joint lags its anchor by the largest
    /// permitted angle.
    pub fn strained(&self, joint: usize) -> bool {
        (self.anchor[joint] - self.joints[joint]).abs() > 0.95 * self.limit / HOLDING_STIFFNESS
    }

    /// Returns the activity that holds the joints at their anchors.
    pub fn activity(&self, instruments: &Instruments, sample: &Sample) -> Activity {
        // The damping acts on the speed relative to the anchor, so that a moving joint does not lag.
        let slip = sample.report.joint_rates - self.moved / instruments.period;
        let torques = instruments.hold.torques(&(self.anchor - self.joints), &slip, self.limit);
        let common = instruments.pretension * (self.common / instruments.minimum);
        let tensions = instruments.distribution.distribute(&torques).tensions + common;
        // The sum can exceed t_max only if something blocks the finger.
        let tensions = tensions.map(|tension| tension.min(instruments.maximum));
        Activity::Tense(instruments.for_controller(tensions))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};
    use crate::model::configuration::ConfiguredFinger;
    use std::f64::consts::PI;

    /// Every joint of the default finger is blocked and pushed with 12 N cm, while the pretension is raised to 0.4
    /// t_max. Without a limit, the largest tension would be 62.7 N.
    #[test]
    fn no_commanded_tension_of_a_blocked_finger_exceeds_t_max() {
        let instruments = Instruments::new(&ConfiguredFinger::default(), 1000.0).expect("usable");
        let (feedback, report) = (Feedback::default(), Report::default());
        let sample = Sample { feedback: &feedback, report: &report, zero_valid: true };
        let mut largest = 0.0f64;
        for ways in 0..8 {
            let mut guide = JointGuide::new(&instruments, &sample, 12.0);
            guide.common = (0.4 * instruments.maximum / instruments.pretension.max() - 1.0) * instruments.minimum;
            for joint in 0..3 {
                let beyond = guide.joints[joint] + if ways >> joint & 1 == 0 { PI } else { -PI };
                guide.advance(joint, beyond, PI);
            }
            guide.measure(&instruments, &sample);
            let Activity::Tense(tensions) = guide.activity(&instruments, &sample) else { panic!("no tensions") };
            largest = largest.max(tensions.max());
        }
        assert_eq!(largest, instruments.maximum);
    }
}

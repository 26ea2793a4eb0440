//! Checks whether something holds a limp finger in its pose. Each joint is pushed lightly in both directions, as in a
//! search for stops. A held joint yields by at most a small angle.

use super::standstill::TOLERANCE;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::control::signals::Activity;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The largest angle by which a held joint may yield, rad. A person's hand that holds a finger is compliant.
const GIVES_WAY: f64 = 0.02;
/// Duration of each push at the full torque, s.
const PUSHING: f64 = 0.1;
/// Time in which the finger comes to rest after the last push, s.
const RESTING: f64 = 0.3;

/// The sequence of pushes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    pub guide: JointGuide,
    /// Joint angles at the beginning, rad.
    start: Vector3<f64>,
    /// Number of the push, which selects joint and direction: 0 to 5, or 6 after the last push.
    push: usize,
    /// Time for which the push has had the full torque, or, after push 5, the time since its end, s.
    seconds: f64,
}

impl Grip {
    /// `guide` limits the torque of a push. `start` are the joint angles before the pushes, rad.
    pub fn new(mut guide: JointGuide, start: Vector3<f64>) -> Self {
        guide.anchor = start;
        Self { guide, start, push: 0, seconds: 0.0 }
    }

    /// Runs one cycle. Returns the activity, and whether all joints were pushed and the finger is at rest again.
    /// `speed` is the speed with which the guide's anchors move toward their targets, rad/s.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
        speed: f64,
    ) -> Result<(Activity, bool), Obstacle> {
        self.guide.measure(instruments, sample);
        let (joint, distance) = (self.guide.joints - self.start).abs().argmax();
        if distance > GIVES_WAY {
            return Err(Obstacle::NotHeld { joint: joint as u8, degrees: distance.to_degrees() });
        }
        let step = speed * instruments.period;
        let (joint, direction) = (self.push / 2, if self.push.is_multiple_of(2) { PI } else { -PI });
        let target = |other: usize| if other == joint { self.start[other] + direction } else { self.start[other] };
        for other in 0..3 {
            let target = target(other);
            self.guide.advance(other, target, step);
        }
        let pushed = joint > 2 || self.guide.strained(joint);
        self.seconds = if pushed { self.seconds + instruments.period } else { 0.0 };
        if joint < 3 && self.seconds >= PUSHING {
            (self.push, self.seconds) = (self.push + 1, 0.0);
        }
        let done = joint > 2 && self.seconds >= RESTING;
        Ok((self.guide.activity(instruments, sample), done))
    }

    /// Refuses a finger that has moved. `joints` are the joint angles that were read after the pushes, rad. They may
    /// differ from the angles before the pushes by at most [`TOLERANCE`].
    pub fn returned(&self, joints: &Vector3<f64>) -> Result<(), Obstacle> {
        let (joint, distance) = (joints - self.start).abs().argmax();
        match distance > TOLERANCE {
            true => Err(Obstacle::Moved { joint: joint as u8, degrees: distance.to_degrees() }),
            false => Ok(()),
        }
    }
}

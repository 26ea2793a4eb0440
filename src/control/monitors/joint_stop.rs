//! Detects joints at their mechanical stops.

use super::alarm::{Alarm, Symptom};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// A joint is considered to be at its stop after this fraction of the way from the joint limit to the stop. The
/// fraction is less than 1, because tendons and stops are elastic.
const STOP_FRACTION: f64 = 0.8;

#[derive(Clone, Debug)]
pub(super) struct JointStop {
    /// Angles below which the joints are considered to be at their lower stops, rad.
    low: Vector3<f64>,
    /// Angles above which the joints are considered to be at their upper stops, rad.
    high: Vector3<f64>,
}

impl JointStop {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let ((low, high), (lower, upper)) = (finger.joint_limits(), finger.stops());
        Self { low: low.lerp(&lower, STOP_FRACTION), high: high.lerp(&upper, STOP_FRACTION) }
    }

    pub fn watch(&self, sample: &Sample) -> Option<Alarm> {
        let joints = sample.report.joints;
        let at_stop = |&joint: &usize| joints[joint] < self.low[joint] || joints[joint] > self.high[joint];
        (0..3).find(at_stop).map(|joint| Alarm {
            symptom: Symptom::JointAtStop,
            part: Part::joint(joint),
            value: joints[joint].to_degrees(),
        })
    }
}

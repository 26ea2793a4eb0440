//! Detects joints at their limits.

use super::observation::{ObservationKind, Observations};
use crate::control::signals::Report;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// A joint must move away from its limit by the margin plus this angle before the detector observes it again, rad (0.5
/// degrees).
const HYSTERESIS: f64 = 0.0087;

/// Detects a joint that comes within a margin of its limit.
#[derive(Clone, Debug)]
pub(super) struct JointLimits {
    /// Lower limits, rad.
    low: Vector3<f64>,
    /// Upper limits, rad.
    high: Vector3<f64>,
    /// A joint within this distance from a limit is at the limit, rad.
    margin: f64,
}

impl JointLimits {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let (low, high) = finger.joint_limits();
        Self { low, high, margin: finger.events.limit_margin_degrees.to_radians() }
    }

    /// `at_limit` holds whether each joint is at a limit.
    pub fn observe(&self, at_limit: &mut [bool; 3], report: &Report, observations: &mut Observations) {
        for (joint, at_limit) in at_limit.iter_mut().enumerate() {
            let angle = report.joints[joint];
            let (low, high) = (self.low[joint], self.high[joint]);
            let limit = if high - angle < angle - low { high } else { low };
            // The distance is negative beyond the limit.
            let distance = (high - angle).min(angle - low);
            if distance <= self.margin && !*at_limit {
                *at_limit = true;
                observations.add(ObservationKind::JointAtLimit, Part::joint(joint), [angle, limit, 0.0, 0.0]);
            } else if distance > self.margin + HYSTERESIS {
                *at_limit = false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_is_observed_once_until_it_has_left_its_limit() {
        let limits = JointLimits::new(&ConfiguredFinger::default());
        let (low, high) = ConfiguredFinger::default().joint_limits();
        let mut at_limit = [false; 3];
        let mut observed = |angle: f64| {
            let report = Report { joints: Vector3::new(0.0, angle, 1.0), ..Report::default() };
            let mut observations = Observations::default();
            limits.observe(&mut at_limit, &report, &mut observations);
            observations.iter().map(|observed| (observed.part, observed.values)).collect::<Vec<_>>()
        };
        let degrees = f64::to_radians;
        assert_eq!(observed(high[1] - degrees(2.0)), vec![]);
        let angle = high[1] - degrees(0.9);
        assert_eq!(observed(angle), vec![(Part::Joint(1), [angle, high[1], 0.0, 0.0])]);
        assert_eq!(observed(high[1] - degrees(1.2)), vec![]);
        assert_eq!(observed(high[1] + degrees(3.0)), vec![]);
        assert_eq!(observed(high[1] - degrees(1.6)), vec![]);
        assert_eq!(observed(high[1]).len(), 1);
        assert_eq!(observed(0.5), vec![]);
        let angle = low[1] - degrees(1.0);
        assert_eq!(observed(angle), vec![(Part::Joint(1), [angle, low[1], 0.0, 0.0])]);
    }
}

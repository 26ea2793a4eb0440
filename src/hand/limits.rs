//! The limits of a finger, for planners that keep their set points within them.

use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;

/// The limits that are in force for a finger. [`Hand::adjust`] can change all of them except `motor_torque`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FingerLimits {
    /// Smallest angles of the joints, rad.
    pub joint_minimum: [f64; 3],
    /// Largest angles of the joints, rad.
    pub joint_maximum: [f64; 3],
    /// Smallest tension of a tendon, N.
    pub tension_minimum: f64,
    /// Largest tension of a tendon, N.
    pub tension_maximum: f64,
    /// Largest torques of the motors, N cm.
    pub motor_torque: [f64; 4],
    /// Largest eigenvalue of Kx that the finger admits, N/cm.
    pub stiffness: f64,
}

impl Hand {
    /// The limits that are in force for finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn limits(&self, finger: i32) -> Result<FingerLimits, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let member = self.dispatcher.member(finger)?;
        // An adjustment holds this lock while it changes the admission, so all limits belong to the same moment.
        let configuration = self.configuration.read();
        let configured = &configuration.fingers[finger.index()];
        let admission = member.admission.read();
        let (low, high) = admission.joint_limits;
        Ok(FingerLimits {
            joint_minimum: low.into(),
            joint_maximum: high.into(),
            tension_minimum: configured.tendon.minimum,
            tension_maximum: configured.tendon.maximum,
            motor_torque: configured.motor.torque_limit,
            stiffness: admission.stiffness_bound,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::{Configuration, RealTime};

    #[test]
    fn limits_are_those_in_force() {
        let mut configuration = Configuration::default();
        configuration.hand.real_time = RealTime::Ignore;
        let hand = Hand::open(configuration).expect("the simulated hand");
        let limits = hand.limits(2).expect("finger 2");
        let close = |found: f64, expected: f64| (found - expected).abs() < 1e-4;
        let (lowest, highest) = (-60.0_f64.to_radians(), 120.0_f64.to_radians());
        assert!(close(limits.joint_minimum[0], lowest) && close(limits.joint_maximum[2], highest), "{limits:?}");
        assert!(close(limits.stiffness, 6.0), "{limits:?}");
        hand.adjust(2, "stiffness.bound = 4\ntendon.minimum = 6\njoints.maximum_degrees = [50, 100, 120]")
            .expect("finger 2 is adjusted");
        let adjusted = hand.limits(2).expect("finger 2");
        assert!(close(adjusted.stiffness, 4.0) && close(adjusted.tension_minimum, 6.0), "{adjusted:?}");
        assert!(close(adjusted.joint_maximum[0], 50.0_f64.to_radians()), "{adjusted:?}");
        assert_eq!(hand.limits(1).expect("finger 1"), limits);
        assert!(hand.limits(4).is_err());
    }

    /// A read that did not wait for the whole adjustment could read one value from before it and the other from after
    /// it. Most such reads would find the old bound of Kx, because an adjustment changes the bound near its end.
    #[test]
    fn limits_that_are_read_during_an_adjustment_belong_to_one_moment() {
        let mut configuration = Configuration::default();
        configuration.hand.real_time = RealTime::Ignore;
        let hand = Hand::open(configuration).expect("the simulated hand");
        let adjust = |bound: u32| {
            let keys = format!("stiffness.bound = {bound}\ntendon.minimum = {}", bound + 1);
            hand.adjust(2, &keys).expect("finger 2 is adjusted");
        };
        adjust(4);
        std::thread::scope(|scope| {
            let adjusting = scope.spawn(|| (0..10).for_each(|turn| adjust(4 + turn % 2)));
            while !adjusting.is_finished() {
                let limits = hand.limits(2).expect("finger 2");
                assert!((limits.tension_minimum - limits.stiffness - 1.0).abs() < 1e-4, "{limits:?}");
            }
        });
    }
}

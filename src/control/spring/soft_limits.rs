//! Soft joint limits: a joint beyond its limit is pushed back before it reaches its mechanical stop.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// Stiffness of a limit, N cm/rad, if the tendons can support it. A bent finger at 3 N/cm has about this stiffness.
const STIFFNESS: f64 = 150.0;

/// Largest fraction of a joint's admissible stiffness that the joint's limits may use. With this fraction, some
/// stiffness is left for the tip even if all three joints are at their limits.
const PART: f64 = 0.3;

/// Depth beyond the limit, rad, at which a limit reaches its full stiffness. With a step in stiffness, a finger that
/// rests at its limit would switch the spring on and off.
const DEPTH: f64 = 0.0175;

/// A joint at the depth d beyond a limit is pushed back with the torque k d^2 / (2 D) up to the depth D, and with the
/// torque k (d - D/2) at greater depths. The stiffness grows from zero to k without a step. Within the limits the push
/// is zero, so the spring of the fingertip stays exact.
#[derive(Clone, Debug)]
pub(crate) struct SoftLimits {
    /// Lower limits of the joints, rad.
    low: Vector3<f64>,
    /// Upper limits of the joints, rad.
    high: Vector3<f64>,
    /// Full stiffness of the limits of each joint, N cm/rad.
    stiffness: Vector3<f64>,
}

/// The torque and stiffness that the limits add.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    /// Torque, N cm.
    pub torque: Vector3<f64>,
    /// Stiffness of each joint, N cm/rad. The caller adds a damper for it.
    pub stiffness: Vector3<f64>,
}

impl SoftLimits {
    /// Constructs the limits of `finger`. `admissible` is the stiffness that each joint can have while the others have
    /// none, N cm/rad.
    pub fn new(finger: &ConfiguredFinger, admissible: &Vector3<f64>) -> Self {
        let (low, high) = finger.joint_limits();
        Self { low, high, stiffness: admissible.map(|admissible| STIFFNESS.min(PART * admissible)) }
    }

    /// Returns the push at joint angles, rad.
    #[inline]
    pub fn push(&self, joints: &Vector3<f64>) -> Push {
        let within = joints.zip_zip_map(&self.low, &self.high, |joint, low, high| joint.max(low).min(high));
        let beyond = within - joints;
        let stiffness = beyond.zip_map(&self.stiffness, |way, stiffness| stiffness * (way.abs() / DEPTH).min(1.0));
        // The effective deflection is d/2 up to the depth D, and d - D/2 at greater depths.
        let counted = beyond.map(|way| way - (0.5 * way).clamp(-0.5 * DEPTH, 0.5 * DEPTH));
        Push { torque: stiffness.component_mul(&counted), stiffness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_push_starts_from_zero_and_has_the_reported_stiffness() {
        let limits = SoftLimits::new(&ConfiguredFinger::default(), &Vector3::new(1000.0, 1000.0, 100.0));
        assert_eq!(limits.stiffness, Vector3::new(STIFFNESS, STIFFNESS, PART * 100.0));
        let at = |joint: usize, beyond: f64| {
            let mut joints = Vector3::new(0.1, 0.5, 1.0);
            joints[joint] = limits.high[joint] + beyond;
            let push = limits.push(&joints);
            (push.torque[joint], push.stiffness[joint])
        };
        for joint in 0..3 {
            assert_eq!(at(joint, -1e-9), (0.0, 0.0));
            for beyond in [0.001, 0.5 * DEPTH, DEPTH, 1.5 * DEPTH, 0.1] {
                let step = 1e-7;
                let slope = (at(joint, beyond - step).0 - at(joint, beyond + step).0) / (2.0 * step);
                let (torque, stiffness) = at(joint, beyond);
                assert!(torque < 0.0 && (slope - stiffness).abs() < 1e-4 * STIFFNESS, "{joint} {beyond} {slope}");
            }
            assert_eq!(at(joint, 2.0 * DEPTH).1, limits.stiffness[joint]);
        }
    }
}

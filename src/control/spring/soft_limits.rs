//! Soft joint limits: beyond them, and before the mechanical stops, a joint is pushed back.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// N cm/rad, about what a bent finger of 3 N/cm has, where the tendons carry that.
const STIFFNESS: f64 = 150.0;

/// The part of what a pose can carry that the limit of a joint takes at most: all three leave something for the tip.
const PART: f64 = 0.3;

/// A limit has its whole stiffness from this depth on, rad: a finger that rests at its limit must not switch it on and
/// off.
const DEPTH: f64 = 0.0175;

/// A joint that is d beyond a limit is pushed back with k d^2 / 2 D, and with k (d - D/2) from the depth D on: its
/// stiffness grows from nothing to k, without a step. Within the limits nothing is added: the spring of the fingertip
/// stays exact.
#[derive(Clone, Debug)]
pub(crate) struct SoftLimits {
    /// rad.
    low: Vector3<f64>,
    high: Vector3<f64>,
    /// N cm/rad.
    stiffness: Vector3<f64>,
}

/// What the limits add.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Push {
    /// N cm.
    pub torque: Vector3<f64>,
    /// N cm/rad, of each joint; it wants a damper.
    pub stiffness: Vector3<f64>,
}

impl SoftLimits {
    /// Of `finger`, whose joints alone can have so much stiffness each, N cm/rad.
    pub fn new(finger: &ConfiguredFinger, carried: &Vector3<f64>) -> Self {
        let (low, high) = finger.joint_limits();
        Self { low, high, stiffness: carried.map(|carried| STIFFNESS.min(PART * carried)) }
    }

    /// At joint angles, rad.
    pub fn push(&self, joints: &Vector3<f64>) -> Push {
        let within = joints.zip_zip_map(&self.low, &self.high, |joint, low, high| joint.max(low).min(high));
        let beyond = within - joints;
        let stiffness = beyond.zip_map(&self.stiffness, |way, stiffness| stiffness * (way.abs() / DEPTH).min(1.0));
        // Up to D half the way counts, beyond it all but half of D.
        let counted = beyond.map(|way| way - (0.5 * way).clamp(-0.5 * DEPTH, 0.5 * DEPTH));
        Push { torque: stiffness.component_mul(&counted), stiffness }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_push_begins_with_nothing_and_is_as_stiff_as_it_says() {
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

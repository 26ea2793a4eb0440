//! The set points that reactions lead to. Each of them is within the limits of the finger's configuration.

use super::rule::Reaction;
use crate::control::{AdmissibleDamping, Report, SetPoint, spatial};
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Contact, Links, direction};
use nalgebra::{Matrix3, Matrix6, Vector3};

/// Force below which a spring counts as pressing in no direction, N.
const NO_DIRECTION: f64 = 0.05;

/// A stiffness at the bound may be beyond the bound by this fraction, because rounding to `float` may have raised it.
const ROUNDING: f64 = 8.0 * f32::EPSILON as f64;

/// The limits of a finger, which no reaction exceeds.
#[derive(Clone, Debug)]
pub struct ReactionLimits {
    links: Links,
    /// Lower and upper joint limits, rad.
    joints: (Vector3<f64>, Vector3<f64>),
    damping: AdmissibleDamping,
    /// Bound on the largest eigenvalue of Kx, N/cm.
    bound: f64,
}

impl ReactionLimits {
    /// Constructs the limits of a finger at a rate, Hz.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        Self {
            links: finger.links(),
            joints: finger.joint_limits(),
            damping: AdmissibleDamping::new(finger, rate),
            bound: finger.stiffness_bound(rate),
        }
    }

    /// Returns whether a stiffness that is within the bound of `other` may be beyond this bound.
    pub(in crate::finger) fn softer_than(&self, other: &Self) -> bool {
        self.bound < other.bound
    }

    /// Returns the stiffness, or the nearest one within the bound. The bound may have been lowered since a planner's
    /// stiffness was checked.
    pub(in crate::finger) fn stiffness(&self, stiffness: &Matrix6<f64>) -> Matrix6<f64> {
        // This conversion succeeds, because the stiffness was admitted.
        match Contact::general(stiffness, &Matrix6::identity()) {
            Ok(contact) if contact.largest_eigenvalue(self.links.0[2]) > self.bound * (1.0 + ROUNDING) => {
                *contact.clamped(self.bound, self.links.0[2]).stiffness()
            }
            _ => *stiffness,
        }
    }

    /// Returns the set point after a reaction, or none for a stop. A grip without effect does not move the anchor of
    /// the spring. `report` is the report of the last cycle. `followed` is the set point that the finger follows.
    pub(in crate::finger) fn react(
        &self,
        reaction: &Reaction,
        report: &Report,
        followed: &SetPoint,
    ) -> Option<SetPoint> {
        let rest = SetPoint { motion: None, ..*followed };
        // The constant joint torque of the set point would move the finger away from the pose of a reaction.
        let still = {
            let mut still = rest;
            still.torque_joints(Vector3::zeros());
            still
        };
        match *reaction {
            Reaction::Stop => None,
            Reaction::Hold => Some(SetPoint { joints: self.within(&report.joints), ..still }),
            Reaction::Soften(kx) => {
                Some(SetPoint { stiffness: self.stiffness(&spatial(&kx)), damping: 1.0, joint_spring: None, ..rest })
            }
            Reaction::Retract(joints) => Some(SetPoint { joints: self.within(&joints), ..still }),
            Reaction::Grip { direction, by, most } => {
                // A grip without effect returns a set point too, so that it ends a path as every other reaction does.
                let joints = self.grip(&direction, (by, most), report, followed).unwrap_or(followed.joints);
                Some(SetPoint { joints, ..rest })
            }
            Reaction::Damp(ratio) => Some(SetPoint { damping: self.damping(ratio, followed), ..rest }),
        }
    }

    fn within(&self, joints: &Vector3<f64>) -> Vector3<f64> {
        let (low, high) = self.joints;
        Vector3::from_fn(|joint, _| joints[joint].clamp(low[joint], high[joint]))
    }

    /// Returns the joint angles of the set point (the anchor of the spring), rad, that increase the force of the tip by
    /// `by`, N, to at most `most`, N. The force of the spring is F = Kx (x_d - x), with the tip positions x_d at the
    /// anchor and x at the measured joint angles. The anchor of the tip moves by Kx^-1 dF, with dF along `along`, or
    /// along F if `along` is zero. Returns none if the spring does not press in this direction, or if Kx or the
    /// Jacobian at the anchor has no inverse.
    fn grip(
        &self,
        along: &Vector3<f64>,
        (by, most): (f64, f64),
        report: &Report,
        followed: &SetPoint,
    ) -> Option<Vector3<f64>> {
        let kx: Matrix3<f64> = followed.stiffness.fixed_view::<3, 3>(0, 0).into();
        let anchor = self.links.tip(&followed.joints);
        let force = kx * (anchor - self.links.tip(&report.joints));
        let along = direction(along).or_else(|| direction(&force))?;
        let strength = force.dot(&along);
        if strength < NO_DIRECTION {
            return None;
        }
        let change = kx.try_inverse()? * along * by.min(most - strength).max(0.0);
        let turn = self.links.jacobian(&followed.joints).try_inverse()? * change;
        let joints = followed.joints + turn;
        joints.iter().all(|joint| joint.is_finite()).then(|| self.within(&joints))
    }

    /// Returns the admitted damping ratio that is nearest to `ratio`.
    fn damping(&self, ratio: f64, followed: &SetPoint) -> f64 {
        // This conversion succeeds, because the set point was admitted.
        let contact = Contact::general(&followed.stiffness, &Matrix6::identity());
        let largest = contact.map_or(f64::INFINITY, |contact| contact.largest_eigenvalue(self.links.0[2]));
        let of_joints = followed.joint_spring.map_or(0.0, |spring| spring.equivalent(self.links.0[2]));
        let (least, most) = self.damping.range(largest + of_joints);
        ratio.clamp(least, most)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn limits() -> ReactionLimits {
        ReactionLimits::new(&ConfiguredFinger::default(), 1000.0)
    }

    fn follows(joints: Vector3<f64>, kx: f64) -> SetPoint {
        SetPoint::hard_finger(joints, Matrix3::identity() * kx)
    }

    #[test]
    fn a_grip_presses_harder_in_the_same_direction() {
        let (limits, tip_at) = (limits(), Vector3::new(0.1, 0.5, 1.0));
        let followed = follows(tip_at + Vector3::new(0.0, 0.05, 0.05), 3.0);
        let report = Report { joints: tip_at, ..Report::default() };
        let force = |joints: &Vector3<f64>| 3.0 * (limits.links.tip(joints) - limits.links.tip(&tip_at));
        let before = force(&followed.joints);
        let grip = Reaction::Grip { direction: Vector3::zeros(), by: 0.2, most: 5.0 };
        let after = force(&limits.react(&grip, &report, &followed).expect("a set point").joints);
        assert!((after.norm() - before.norm() - 0.2).abs() < 0.01, "{} to {} N", before.norm(), after.norm());
        assert!(after.normalize().dot(&before.normalize()) > 0.9999);
        // A force that already exceeds the largest force of the grip is neither increased nor reduced.
        let most = Reaction::Grip { direction: Vector3::zeros(), by: 0.2, most: before.norm() - 0.1 };
        assert_eq!(limits.react(&most, &report, &followed).expect("a set point").joints, followed.joints);
        // If the grip has a direction, the force grows in this direction.
        let down = Reaction::Grip { direction: before.cross(&Vector3::x()) + before, by: 0.2, most: 5.0 };
        let pressed = force(&limits.react(&down, &report, &followed).expect("a set point").joints) - before;
        assert!(pressed.dot(&(before.cross(&Vector3::x()) + before).normalize()) > 0.19, "{pressed}");
        // A spring at rest presses in no direction.
        let at_rest = Report { joints: followed.joints, ..Report::default() };
        assert_eq!(limits.react(&grip, &at_rest, &followed), Some(followed));
    }

    proptest! {
        #[test]
        fn no_reaction_leaves_the_limits(
            joints in prop::array::uniform3(-4.0..4.0f64), is in prop::array::uniform3(-4.0..4.0f64),
            kx in 0.0..6.0f64, by in 0.0..50.0f64, ratio in 0.0..9.0f64, reaction in 0..5,
            soft in 0.0..12.0f64,
        ) {
            let limits = limits();
            let followed = follows(limits.within(&joints.into()), kx);
            let report = Report { joints: is.into(), ..Report::default() };
            let reaction = match reaction {
                0 => Reaction::Hold,
                1 => Reaction::Retract(joints.into()),
                3 => Reaction::Soften(Matrix3::identity() * soft),
                2 => Reaction::Grip { direction: is.into(), by, most: 100.0 },
                _ => Reaction::Damp(ratio),
            };
            if let Some(next) = limits.react(&reaction, &report, &followed) {
                prop_assert_eq!(limits.within(&next.joints), next.joints);
                prop_assert!(next.stiffness[(0, 0)] <= limits.bound * (1.0 + ROUNDING));
                let (least, most) = limits.damping.range(kx);
                prop_assert!((least..=most).contains(&next.damping) || next.damping == 1.0);
            }
        }
    }
}

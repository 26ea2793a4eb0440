//! Compares gauges with encoders. Three joint angles determine the travel of four tendons, so four motor angles and
//! four tensions are redundant by one. R is the matrix of the moment arms of the tendons, r are the motor radii, m the
//! motor angles, t the tensions, t_home the tensions at which the encoders are zeroed, and k the stiffnesses of the
//! tendons. For n with R n = 0,
//!
//! n^T (r m - (t - t_home) / k) = 0
//!
//! for any joint angles theta. Equivalently, three tendons determine the tension of the fourth,
//!
//! t = k (r m - R^T theta) + t_home.
//!
//! The left side of the first equation, converted to N, is the difference between gauges and encoders. The difference
//! at the start of monitoring counts as zero, because encoders that were never zeroed are no reason to stop a finger.
//!
//! On a real finger the difference also changes without a fault. Wrong stiffnesses, gauge gains and moment arms change
//! it in proportion to tensions and joint angles; `mismatch` learns by how much, and what it does not know yet is
//! tolerated. Friction along a tendon makes the tension differ between the motor, the gauge and the joint, and this
//! changes the stretch. The sign of this change depends on the direction of the last motion, so the change is tolerated
//! in proportion to the tensions. The error of a gauge that drifts has no bound in proportion to tensions or joint
//! angles, so it eventually exceeds what is tolerated.

use super::alarm::{Alarm, Symptom};
use super::mismatch::{DEVIATIONS, Mismatch, Terms};
use super::sample::Sample;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// Possible difference between the mean tension of a tendon and the tension at its gauge, as a part of the friction
/// along the tendon. It is a third if all friction acts at one point, at a third of the tendon's length from the motor,
/// and the gauge is beyond this point. It is a half if the friction is distributed evenly and the gauge is at one end.
pub(crate) const SHARE_OF_FRICTION: f64 = 0.4;

/// Errors of the moment arms cause a difference in proportion to the motion of a joint. This is the expected size of
/// that difference, as a fraction of the largest possible size. The largest size occurs only if the errors of the four
/// moment arms at this joint, in cm and not as fractions, all have the same sign.
const TYPICAL: f64 = 0.75;

/// Fraction of t_min below which a tendon may hang slack. The encoders then show a negative stretch, so the difference
/// is negative too.
const SLACK: f64 = 0.35;

/// Number of samples whose mean difference counts as zero.
const ZEROING: u32 = 32;

/// Time for which the disagreement must last, s.
const DURATION: f64 = 0.01;

/// Gain per sample of the running mean of pull minus tension.
const AVERAGING: f64 = 0.05;

#[derive(Clone, Debug)]
pub(super) struct Agreement {
    /// Weights of the travels, N/cm: n, which is all positive, divided by the sum of n / k.
    of_travel: Vector4<f64>,
    /// Weights of the tensions: n / k, scaled so that an error of 1 N in all tensions gives a difference of 1 N.
    of_tension: Vector4<f64>,
    /// Compliances of the tendons, cm/N.
    compliance: Vector4<f64>,
    /// Joint angles from tendon travel, rad/cm.
    joints: Matrix3x4<f64>,
    /// Tensions at which the encoders are zeroed, N.
    home: Vector4<f64>,
    /// Tension below which a tendon may hang slack, N.
    slack: f64,
    /// Difference that is always tolerated, N.
    tolerance: f64,
    /// Difference that friction can cause, as a fraction of the mean tension.
    friction: f64,
    /// Expected relative error of the stretch that the tensions indicate.
    stretch_error: f64,
    /// Expected difference for a motion of each joint, N/rad.
    joint_error: Vector3<f64>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Means during zeroing: the difference, N, the tensions, N, and the joint angles, rad.
    zero: f64,
    tensions: Vector4<f64>,
    joints: Vector3<f64>,
    samples: u32,
    mismatch: Mismatch,
    /// Difference of gauges and encoders, N.
    disagreement: f64,
    /// The part of `disagreement` that the mismatch does not explain, N.
    difference: f64,
    /// Magnitude of `difference` divided by the tolerated magnitude. It is 0 if a slack tendon explains the difference.
    ratio: f64,
    /// Time for which the disagreement has lasted, s.
    duration: f64,
    /// Tension of each tendon minus the tension that its gauge shows, if the other three gauges are right, N.
    missing: Vector4<f64>,
    /// Part of `missing` that a change of the directions of friction can cause, N.
    by_friction: Vector4<f64>,
    /// Mean of pull minus tension of each tendon, N.
    unbalanced: Vector4<f64>,
}

/// The tensions that the gauges do not show although the stretch of the tendons indicates them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Missing {
    /// Tension of each tendon minus the tension that its gauge shows, if the other three gauges are right, N.
    pub tensions: Vector4<f64>,
    /// Part of `tensions` that a change of the directions of friction can cause, N.
    pub by_friction: Vector4<f64>,
}

impl Memory {
    /// Returns the missing tensions of the last sample.
    pub fn missing(&self) -> Missing {
        Missing { tensions: self.missing, by_friction: self.by_friction }
    }
}

impl Agreement {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        // The last column of Q, which belongs to the ghost joint (see `Tendons`), spans the null space of R.
        let null: Vector4<f64> = tendons.q.column(3).into_owned();
        let compliance = Vector4::from(finger.tendon.stiffness).map(f64::recip);
        let per_stiffness = null.component_mul(&compliance);
        let whole = per_stiffness.sum();
        let of_travel = null / whole;
        let monitors = &finger.monitors;
        let friction = Vector4::from(finger.friction.conduit) + Vector4::from(finger.friction.pulley);
        Self {
            of_travel,
            of_tension: per_stiffness / whole,
            compliance,
            joints: tendons.joints_from_travel(),
            home: tendons.pretension(finger.tendon.minimum),
            slack: SLACK * finger.tendon.minimum,
            tolerance: monitors.disagreement,
            friction: SHARE_OF_FRICTION * friction.max().max(monitors.friction_tolerance),
            stretch_error: finger.tendon.stiffness_tolerance + monitors.gauge_tolerance,
            joint_error: tendons.r.abs() * of_travel * (TYPICAL * monitors.moment_arm_tolerance),
        }
    }

    /// Computes the difference of one sample.
    pub fn compare(&self, memory: &mut Memory, sample: &Sample) {
        let tensions = sample.tensions;
        memory.unbalanced += (sample.pulls - tensions - memory.unbalanced) * AVERAGING;
        let raw = self.of_travel.dot(&sample.travel) - self.of_tension.dot(&(tensions - self.home));
        let joints = self.joints * (sample.travel - self.compliance.component_mul(&tensions));
        let hangs = tensions.min() < self.slack;
        if memory.samples < ZEROING {
            if !hangs {
                memory.samples += 1;
                let gain = f64::from(memory.samples).recip();
                memory.zero += (raw - memory.zero) * gain;
                memory.tensions += (tensions - memory.tensions) * gain;
                memory.joints += (joints - memory.joints) * gain;
            }
            return;
        }
        let disagreement = raw - memory.zero;
        memory.disagreement = disagreement;
        let stretched = self.of_tension.component_mul(&(tensions - memory.tensions)) * self.stretch_error;
        let turned = (joints - memory.joints).component_mul(&self.joint_error);
        let mut terms = Terms::zeros();
        terms.fixed_rows_mut::<4>(0).copy_from(&stretched);
        terms.fixed_rows_mut::<3>(4).copy_from(&turned);
        let mismatch = &mut memory.mismatch;
        // Friction may have acted in the opposite direction during zeroing.
        let expected = self.friction * self.of_tension.dot(&(tensions + memory.tensions));
        let friction = mismatch.friction(expected);
        let (explained, deviation) = mismatch.explained(&terms);
        memory.difference = unexplained(disagreement, explained);
        let tolerated = self.tolerance + friction + DEVIATIONS * deviation;
        let hanging = memory.difference < 0.0 && hangs;
        memory.ratio = if hanging { 0.0 } else { memory.difference.abs() / tolerated };
        // If the tension of a tendon is suddenly low, the mismatch was not learned at this tension. So the term of this
        // tendon is left out.
        memory.missing = Vector4::from_fn(|tendon, _| {
            let by_others = explained - mismatch.explained_by(tendon, &terms);
            unexplained(disagreement, by_others) / self.of_tension[tendon]
        });
        memory.by_friction = self.of_tension.map(|weight| expected / weight);
        if !hangs && memory.ratio <= 1.0 {
            mismatch.learn(&terms, disagreement, memory.ratio, sample.elapsed);
        }
    }

    /// Returns whether an error of this gauge, 0 to 3, explains the present disagreement approximately. `imbalance` is
    /// the difference between pull and shown tension, N, that the error causes.
    pub fn explains(&self, memory: &Memory, gauge: usize, imbalance: f64) -> bool {
        (0.6..1.6).contains(&(memory.disagreement / self.of_tension[gauge] / imbalance))
    }

    /// Returns an alarm if the disagreement has lasted too long. `explained` means that another fault causes the
    /// disagreement.
    pub fn watch(&self, memory: &mut Memory, sample: &Sample, explained: bool) -> Option<Alarm> {
        let counts = memory.ratio > 1.0 && !explained;
        memory.duration = if counts { memory.duration + sample.elapsed } else { 0.0 };
        // The suspect is the gauge that differs most from the pull of its motor.
        let suspect = Part::gauge(memory.unbalanced.iamax());
        let alarm = Alarm { symptom: Symptom::GaugeDisagrees, part: suspect, value: memory.difference };
        (memory.duration >= DURATION).then_some(alarm)
    }
}

/// Returns the part of a disagreement that is not explained. What is learned may reduce a disagreement, but must not
/// cause one.
fn unexplained(disagreement: f64, explained: f64) -> f64 {
    (disagreement - explained).clamp(disagreement.min(0.0), disagreement.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_tells_which_error_of_a_gauge_is_always_tolerated() {
        let finger = ConfiguredFinger::default();
        let agreement = Agreement::new(&finger, &finger.tendons().expect("the default tendons"));
        let errors = agreement.of_tension.map(|weight| finger.monitors.disagreement / weight);
        assert!((errors[0] - errors[3]).abs() + (errors[1] - errors[2]).abs() < 1e-6, "{errors}");
        let reported =
            format!("an error of {:.1} N at gauge 1 or 4, or of {:.1} N at gauge 2 or 3", errors[0], errors[1]);
        let reference = include_str!("../../../docs/sun2xp.toml").replace("\n# ", " ");
        assert!(reference.contains(&reported), "{reported}");
    }
}

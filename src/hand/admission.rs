//! The checks of a planner's commands. A command that fails a check does not reach the servo.

mod joint_springs;
mod ranges;

use crate::control::{AdmissibleDamping, Controller, JointSprings, SetPoint, TensionDistribution, spatial};
use crate::hand::{MotionLimits, SetPointError};
use crate::model::FingerNumber;
use crate::model::InverseKinematics;
use crate::model::configuration::{Configuration, Law, OutOfRange};
use crate::model::{Contact, Links};
use nalgebra::{Matrix3, Matrix3x4, Matrix6, Vector3};
pub use ranges::Ranges;

/// Distance by which a path may exceed a joint limit, rad. A pose at the limit is accepted despite rounding.
pub(super) const PATH_ROUNDING: f64 = 1e-4;

/// The limits of one finger, and the geometry of its tip.
#[derive(Clone, Debug)]
pub(super) struct Admission {
    /// Number of the finger, 1 to 3.
    pub finger: FingerNumber,
    /// Lower and upper joint limits, rad.
    pub joint_limits: (Vector3<f64>, Vector3<f64>),
    /// Bound on the largest eigenvalue of Kx, N/cm.
    pub stiffness_bound: f64,
    /// The inverse kinematics (the block A^-1 of the report) within the joint limits.
    pub inverse_kinematics: InverseKinematics,
    pub links: Links,
    /// Moment arms of the tendons (R of eq. 14 of the report), cm.
    pub r: Matrix3x4<f64>,
    /// The springs of the finger. There are none if the rank of R is below 3, and no hand opens with such an R.
    pub springs: Option<JointSprings>,
    /// The distribution of joint torques to tensions. There is none if no controller can use the configuration, and no
    /// hand opens with such a configuration.
    pub distribution: Option<TensionDistribution>,
    /// The check of damping against stiffness.
    pub damping: DampingAdmission,
    /// The stiffness law for set points in joint angles.
    pub law: Law,
    /// The limits of the motion on a path.
    pub motion_limits: MotionLimits,
    /// Whether a value outside its range is refused or clamped.
    pub out_of_range: OutOfRange,
}

impl Admission {
    pub fn new(configuration: &Configuration, number: FingerNumber) -> Self {
        let finger = &configuration.fingers[number.index()];
        let joint_limits = finger.joint_limits();
        let (rate, out_of_range) = (configuration.hand.rate, configuration.hand.out_of_range);
        Self {
            finger: number,
            joint_limits,
            inverse_kinematics: InverseKinematics::new(finger.links(), joint_limits),
            links: finger.links(),
            r: finger.r(),
            springs: JointSprings::new(finger, rate),
            distribution: Controller::new(finger, rate).ok().map(|controller| controller.distribution().clone()),
            stiffness_bound: finger.stiffness_bound(rate),
            damping: DampingAdmission {
                finger: number,
                admissible: AdmissibleDamping::new(finger, rate),
                lever: finger.links().0[2],
                out_of_range,
            },
            law: finger.controller.law,
            motion_limits: MotionLimits([finger.motion.speed, finger.motion.acceleration, finger.motion.jerk]),
            out_of_range,
        }
    }

    // Without `inline`, the ranges are copied for every set point.
    #[inline]
    pub(super) fn ranges(&self) -> Ranges {
        let Self { finger, joint_limits, stiffness_bound, out_of_range, .. } = *self;
        Ranges { finger, joint_limits, stiffness_bound, out_of_range }
    }

    /// Checks desired joint angles, rad, and returns the angles for the servo.
    pub fn joints(&self, joints: [f64; 3]) -> Result<Vector3<f64>, SetPointError> {
        self.ranges().joints(joints)
    }

    /// Checks the planner's Kx and converts it to the stiffness of a set point, which the servo uses.
    pub fn stiffness(&self, rows: [[f64; 3]; 3]) -> Result<Matrix6<f64>, SetPointError> {
        self.kx(rows).map(|kx| spatial(&kx))
    }

    /// Checks that Kx, N/cm, is symmetric, positive semi-definite and within the bound, and returns it. Mirrored
    /// entries are averaged. If `out_of_range` is `Clamp`, a Kx beyond the bound is not refused: the nearest one within
    /// the bound is returned. The argument is `rows[row][column]`.
    pub fn kx(&self, rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, SetPointError> {
        self.ranges().kx(rows)
    }

    /// Returns the joint angles, rad, for a tip position, cm. Of several solutions it returns the one nearest to
    /// `present`. The position is never clamped, because the nearest point of the workspace may be on the other side
    /// of an object.
    pub fn tip(&self, tip: [f64; 3], present: &Vector3<f64>) -> Result<Vector3<f64>, SetPointError> {
        self.finite("Tip", &tip)?;
        let found = self.inverse_kinematics.joints(&Vector3::from(tip), present);
        found.map_err(|source| SetPointError::OutOfReach { finger: self.finger, tip, source })
    }

    /// Checks the stiffness of a contact against the bound, and returns it. If `out_of_range` is `Clamp`, a stiffness
    /// beyond the bound is not refused: the nearest one within the bound is returned. A rotational stiffness is
    /// converted with the length of the last link.
    pub fn contact(&self, contact: &Contact) -> Result<Matrix6<f64>, SetPointError> {
        let (bound, lever) = (self.stiffness_bound, self.links.0[2]);
        let largest = contact.largest_eigenvalue(lever);
        // A stiffness at the bound may be rounded beyond the bound when it is sent as `float`. It must be accepted.
        if largest <= bound * (1.0 + 8.0 * f64::from(f32::EPSILON)) {
            return Ok(*contact.stiffness());
        }
        match self.out_of_range {
            OutOfRange::Refuse => Err(SetPointError::TooStiffContact { finger: self.finger, largest, bound }),
            OutOfRange::Clamp => Ok(*contact.clamped(bound, lever).stiffness()),
        }
    }

    /// Refuses NaN and infinity, which must never reach the servo.
    pub fn finite(&self, what: &'static str, values: &[f64]) -> Result<(), SetPointError> {
        self.ranges().finite(what, values)
    }
}

/// The check that the damping of a finger's set point is within the range for its stiffness. One planner may change the
/// damping while another one changes the stiffness. So the check runs under the lock under which `Mailbox::try_send`
/// changes and sends the whole set point. The closure that makes the change owns a copy of the check.
#[derive(Clone, Copy, Debug)]
pub(super) struct DampingAdmission {
    /// Number of the finger, 1 to 3.
    pub finger: FingerNumber,
    /// The damping that the finger's controller admits.
    pub admissible: AdmissibleDamping,
    /// Length of the last link, cm, with which a rotational stiffness is converted to N/cm.
    pub lever: f64,
    /// Whether a damping outside its range is refused or clamped.
    pub out_of_range: OutOfRange,
}

impl DampingAdmission {
    /// Refuses a set point whose damping is outside the range of its stiffness, or clamps its damping.
    pub fn admit(&self, set_point: &mut SetPoint) -> Result<(), SetPointError> {
        if set_point.damping == 1.0 {
            return Ok(()); // A ratio of 1 is always admitted, so the most frequent calls need no eigenvalue.
        }
        let finger = self.finger;
        // The largest eigenvalue of a sum is at most the sum of the largest eigenvalues.
        let of_joints = set_point.joint_spring.map_or(0.0, |spring| spring.equivalent(self.lever));
        let stiffness = self.largest(&set_point.stiffness)? + of_joints;
        let (least, most) = self.admissible.range(stiffness);
        let ratio = set_point.damping;
        // A ratio at a limit may be rounded beyond the limit when it is sent as `float`. It must be accepted.
        let rounding = f64::from(f32::EPSILON) * most;
        if !(least - rounding..=most + rounding).contains(&ratio) && self.out_of_range == OutOfRange::Refuse {
            return Err(SetPointError::Damping { finger, ratio, stiffness, least, most });
        }
        set_point.damping = ratio.clamp(least, most);
        Ok(())
    }

    /// Returns the spring with the narrowest range of damping, which is the stiffer one.
    pub fn with_narrowest_range(&self, springs: [Matrix6<f64>; 2]) -> Result<Matrix6<f64>, SetPointError> {
        let mut narrowest = (f64::NEG_INFINITY, Matrix6::zeros());
        for spring in springs {
            let largest = self.largest(&spring)?;
            if largest > narrowest.0 {
                narrowest = (largest, spring);
            }
        }
        Ok(narrowest.1)
    }

    /// Returns the largest eigenvalue of the stiffness of a set point, N/cm.
    fn largest(&self, stiffness: &Matrix6<f64>) -> Result<f64, SetPointError> {
        let contact = Contact::general(stiffness, &Matrix6::identity());
        let contact = contact.map_err(|source| SetPointError::Contact { finger: self.finger, source })?;
        Ok(contact.largest_eigenvalue(self.lever))
    }
}

#[cfg(test)]
mod tests;

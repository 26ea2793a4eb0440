//! The installation of reflexes. Every rule is checked here, so that no reaction leaves the limits of its finger.

use crate::finger::{Condition, Reaction, Reflex};
use crate::hand::admission::Admission;
use crate::hand::kinematics::rows;
use crate::hand::{Hand, HandError, ReflexError, SetPointError};
use crate::model::FingerNumber;

/// Largest time of a rule, s.
const LONGEST: f64 = 3600.0;

/// Largest force and tension of a rule, N.
const STRONGEST: f64 = 1000.0;

/// Largest angle of a rule, rad.
const WIDEST: f64 = std::f64::consts::PI;

/// Largest damping ratio of a rule. When the rule reacts, the servo clamps the ratio to the range that the stiffness of
/// the finger admits.
const MOST_DAMPED: f64 = 10.0;

impl Hand {
    /// Installs a reflex of finger 1, 2 or 3, and returns its number. The reflex acts whenever the finger is a spring,
    /// until it is removed or the hand is closed. A finger has at most 16 reflexes.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger already has 16 reflexes. Returns an error if the
    /// rule names a joint that does not exist. Returns an error if [`Condition::OtherFinger`] names a finger that is
    /// not opened, or the finger of the reflex itself. Returns an error if a value of the rule is outside its range:
    /// times of 0 to 3600 s, forces and tensions of 0 to 1000 N, angles of -pi to pi, damping ratios of 0 to 10. A
    /// direction must be finite. Returns the errors of [`Hand::send_position`] for the pose of [`Reaction::Retract`],
    /// and those of [`Hand::send_stiffness`] for the Kx of [`Reaction::Soften`].
    pub fn install_reflex(&self, finger: i32, reflex: Reflex) -> Result<u32, HandError> {
        self.install_reflex_with(finger, reflex, reflex.priority.into())
    }

    /// Does the same as [`Self::install_reflex`], but with this priority. A C program may pass a priority outside the
    /// range of 0 to 255, which is refused.
    pub(crate) fn install_reflex_with(&self, finger: i32, reflex: Reflex, priority: i32) -> Result<u32, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let member = self.dispatcher.member(finger)?;
        check_finite(&member.admission.read(), reflex.reaction)?;
        let condition = self.condition(finger, reflex.condition)?;
        within(finger, "priority", priority.into(), 0.0, u8::MAX.into(), "")?;
        within(finger, "refractory time", reflex.refractory, 0.0, LONGEST, " s")?;
        within(finger, "inhibition", reflex.inhibition, 0.0, LONGEST, " s")?;
        let reaction = reaction(&member.admission.read(), reflex.reaction)?;
        let installed = member.reflexes.install(Reflex { condition, reaction, priority: priority as u8, ..reflex });
        Ok(installed.ok_or(ReflexError::TooMany(finger))?)
    }

    /// Removes a reflex of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if it has no reflex with this number.
    pub fn remove_reflex(&self, finger: i32, rule: u32) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        match self.dispatcher.member(finger)?.reflexes.remove(rule) {
            true => Ok(()),
            false => Err(ReflexError::NoSuchRule { finger, rule }.into()),
        }
    }

    /// Removes all reflexes of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn clear_reflexes(&self, finger: i32) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?.reflexes.clear();
        Ok(())
    }

    fn condition(&self, finger: FingerNumber, condition: Condition) -> Result<Condition, HandError> {
        match condition {
            Condition::OtherFinger { finger: other, .. } => {
                self.dispatcher.member(other)?;
                if other == finger {
                    return Err(ReflexError::OwnFinger(finger).into());
                }
            }
            Condition::ForceAbove(force) => within(finger, "force", force, 0.0, STRONGEST, " N")?,
            Condition::TensionAbove(tension) | Condition::TensionBelow(tension) => {
                within(finger, "tension", tension, 0.0, STRONGEST, " N")?;
            }
            Condition::JointAbove { joint, angle } | Condition::JointBelow { joint, angle } => {
                if joint > 2 {
                    let joint = i64::try_from(joint).unwrap_or(i64::MAX);
                    return Err(ReflexError::NoSuchJoint { finger, joint }.into());
                }
                within(finger, "angle", angle, -WIDEST, WIDEST, " rad")?;
            }
            Condition::LinkLost(time) | Condition::PlannerSilent(time) => {
                within(finger, "time", time, 0.0, LONGEST, " s")?;
            }
            Condition::Event(_) => {}
        }
        Ok(condition)
    }
}

/// Refuses NaN and infinity in the vector or the matrix of a reaction.
fn check_finite(admission: &Admission, reaction: Reaction) -> Result<(), SetPointError> {
    match reaction {
        Reaction::Retract(joints) => admission.finite("Pos", joints.as_slice()),
        Reaction::Soften(kx) => admission.finite("Kx", kx.as_slice()),
        Reaction::Grip { direction, .. } => admission.finite("the direction of the grip", direction.as_slice()),
        Reaction::Stop | Reaction::Hold | Reaction::Damp(_) => Ok(()),
    }
}

/// Checks a reaction, and returns it with the pose or the stiffness for the servo.
fn reaction(admission: &Admission, reaction: Reaction) -> Result<Reaction, HandError> {
    let finger = admission.finger;
    Ok(match reaction {
        Reaction::Stop | Reaction::Hold => reaction,
        Reaction::Retract(joints) => Reaction::Retract(admission.joints(joints.into())?),
        Reaction::Soften(kx) => Reaction::Soften(admission.kx(rows(&kx))?),
        Reaction::Grip { by, most, .. } => {
            within(finger, "increase of the force", by, 0.0, STRONGEST, " N")?;
            within(finger, "largest force", most, 0.0, STRONGEST, " N")?;
            reaction
        }
        Reaction::Damp(ratio) => {
            within(finger, "damping ratio", ratio, 0.0, MOST_DAMPED, "")?;
            reaction
        }
    })
}

fn within(
    finger: FingerNumber,
    what: &'static str,
    value: f64,
    low: f64,
    high: f64,
    unit: &'static str,
) -> Result<(), ReflexError> {
    // A range contains no NaN.
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(ReflexError::Value { finger, what, value, low, high, unit })
    }
}

//! The calls that send set points. Each call checks the planner's arguments and writes to the mailbox of the finger.

use crate::control::{Law, SetPoint};
use crate::finger::{Replaced, Validity};
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError, SetPointError};
use crate::model::Contact;
use crate::model::FingerNumber;
use std::time::Duration;

impl Hand {
    /// Sends theta_d, the desired angles of joints 0, 1 and 2 of finger 1, 2 or 3, rad. They take effect within a
    /// cycle.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if an angle is NaN, infinite or beyond a joint limit, or if the
    /// finger is faulted. With `hand.out_of_range = "clamp"`, a value outside its limits is clamped instead.
    pub fn send_position(&self, finger: i32, joints: [f64; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let member = self.dispatcher.member(finger)?;
        let admission = member.admission.read();
        let (joints, law) = (admission.joints(joints)?, admission.law);
        let sent = member.mailbox.send(|set_point| (set_point.joints, set_point.law) = (joints, law));
        sent.map_err(|fault| HandError::Faulted { finger, fault })
    }

    /// Sends desired joint angles as [`Hand::send_position`] does. They are valid for the time `valid`, or for the
    /// configured time if `valid` is none. If nothing else is sent within this time, the finger reacts as
    /// `[finger.motion]` says.
    ///
    /// # Errors
    /// Returns the errors of [`Hand::send_position`].
    pub fn send_position_for(&self, finger: i32, joints: [f64; 3], valid: Option<Duration>) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Place, Validity::hold_after(valid)), |admission| {
            let (joints, law) = (admission.joints(joints)?, admission.law);
            Ok(move |set_point: &mut SetPoint| {
                (set_point.joints, set_point.law) = (joints, law);
                Ok(())
            })
        })
    }

    /// Renews the validity of what was sent last to finger 1, 2 or 3, without a new set point. The times of `validity`
    /// count from `validity.since`, or from the next cycle if it is none, even if a path has not ended. A finger whose
    /// set point has already expired continues to hold its pose, and only the time until its end state begins anew.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn keep_valid(&self, finger: i32, validity: Validity) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let kept = self.dispatcher.member(finger)?.mailbox.keep_valid(validity);
        kept.map_err(|fault| HandError::Faulted { finger, fault })
    }

    /// Sends Kx of finger 1, 2 or 3 in the finger's frame, N/cm: `rows[row][column]`. The whole matrix takes effect
    /// without a jump in torque; 95 % of the change is reached after 50 ms.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if the stiffness has
    /// an entry that is NaN or infinite, is not symmetric, has a negative eigenvalue, is above the bound, or is too
    /// high for the damping that was sent last. With `hand.out_of_range = "clamp"`, a value outside its limits is
    /// clamped instead.
    pub fn send_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Stiffness, Validity::default()), |admission| {
            let (stiffness, damping) = (admission.stiffness(rows)?, admission.damping);
            Ok(move |set_point: &mut SetPoint| {
                set_point.stiffen_tip(stiffness);
                damping.admit(set_point)
            })
        })
    }

    /// Sends the desired position of the tip of finger 1, 2 or 3 in the finger's frame, cm. The fingertip becomes the
    /// exact spring tau = J^T Kx (x_d - x), with the stiffness Kx that was sent last. Here tau are the joint torques, J
    /// is the Jacobian, x_d is the desired position of the tip, and x is its measured position. Of several joint
    /// solutions within the limits, the one nearest to the present pose is used. The position takes effect within a
    /// cycle. The motion is straight in joint space. Its largest joint speed is `controller.set_point_speed`, or
    /// `finger.motion.speed` if set points are interpolated.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if a number is NaN or
    /// infinite. Returns an error if the position is out of reach or outside the joint limits, even if commands are
    /// clamped.
    pub fn send_tip(&self, finger: i32, tip: [f64; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let present = self.dispatcher.last_report(finger)?.cycle.joints;
        self.send(finger, (Replaced::Place, Validity::default()), |admission| {
            let joints = admission.tip(tip, &present)?;
            Ok(move |set_point: &mut SetPoint| {
                (set_point.joints, set_point.law) = (joints, Law::Exact);
                Ok(())
            })
        })
    }

    /// Sends a contact for finger 1, 2 or 3: the tip becomes the spring of that contact, without a jump in torque. The
    /// contact replaces the last Kx, and a later Kx replaces the contact. Three joints turn the tip only by moving it,
    /// so a rotational stiffness acts as an additional stiffness of the tip.
    /// [`FingerTip::stiffness`](super::FingerTip::stiffness) includes it.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if the stiffness is
    /// above the bound, or is too high for the damping that was sent last. A rotational stiffness k, N cm/rad, counts
    /// as k / l2^2 N/cm, because the last joint moves the tip by l2, the length of the last link, per rad. With
    /// `hand.out_of_range = "clamp"`, a value outside its limits is clamped instead.
    pub fn send_contact(&self, finger: i32, contact: Contact) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Stiffness, Validity::default()), |admission| {
            let (stiffness, damping) = (admission.contact(&contact)?, admission.damping);
            Ok(move |set_point: &mut SetPoint| {
                set_point.stiffen_tip(stiffness);
                damping.admit(set_point)
            })
        })
    }

    /// Sends the joint stiffness K_theta of finger 1, 2 or 3, N cm/rad: `rows[row][column]`. The joints become springs
    /// between their angles and the desired angles, without a jump in torque. K_theta replaces the last Kx or contact,
    /// and a later Kx or contact replaces K_theta. No eigenvalue may be above the bound of Kx times the square of the
    /// last link's length.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if the stiffness has
    /// an entry that is NaN or infinite, is not symmetric, has a negative eigenvalue, is above the bound, or is too
    /// high for the damping that was sent last. With `hand.out_of_range = "clamp"`, a value outside its limits is
    /// clamped instead.
    pub fn send_joint_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Stiffness, Validity::default()), |admission| {
            let (k_theta, damping) = (admission.k_theta(rows)?, admission.damping);
            Ok(move |set_point: &mut SetPoint| {
                set_point.stiffen_joints(k_theta);
                damping.admit(set_point)
            })
        })
    }

    /// Sends a constant torque of joints 0, 1 and 2 of finger 1, 2 or 3, N cm. It acts in addition to the spring of the
    /// tip or of the joints, without a jump in torque, until the next call replaces it. With a stiffness of zero, the
    /// finger is controlled by torque alone.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if a torque is NaN or
    /// infinite, or more than the tendons can make. With `hand.out_of_range = "clamp"`, a value outside its limits is
    /// clamped instead.
    pub fn send_joint_torque(&self, finger: i32, torque: [f64; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Other, Validity::default()), |admission| {
            let torque = admission.torque(torque)?;
            Ok(move |set_point: &mut SetPoint| {
                set_point.torque_joints(torque);
                Ok(())
            })
        })
    }

    /// Sends the damping of finger 1, 2 or 3, relative to the damping that the controller chooses from the stiffness.
    /// The ratio is 1 after open. Its range depends on controller, rate and stiffness
    /// (`control::AdmissibleDamping`). While a path changes Kx, the stiffest Kx of the whole path counts.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted. Returns an error if the ratio is NaN,
    /// infinite or outside the range for the stiffness that was sent last. With `hand.out_of_range = "clamp"`, a value
    /// outside its limits is clamped instead.
    pub fn send_damping(&self, finger: i32, ratio: f64) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.send(finger, (Replaced::Other, Validity::default()), |admission| {
            admission.finite("Ratio", &[ratio])?;
            let damping = admission.damping;
            Ok(move |set_point: &mut SetPoint| {
                set_point.damping = ratio;
                damping.admit(set_point)
            })
        })
    }

    /// Returns the set point that was sent last to finger 1, 2 or 3. If none was sent since the finger became a spring,
    /// since a set point expired or since a reflex reacted, returns the set point that the finger holds. If a path was
    /// sent, returns the set point at the end of the path. A relative command must start from the returned set point.
    /// What was sent during the last cycle has not taken effect yet, so the set point of [`Hand::report`] does not
    /// contain it.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn last_set_point(&self, finger: i32) -> Result<SetPoint, HandError> {
        Ok(self.dispatcher.member(FingerNumber::try_from(finger)?)?.mailbox.sent())
    }

    /// Calls `admit`, which checks the arguments and returns a change of the set point. Then sends the change. The
    /// limits cannot change between the check and the sending. The change may still return an error, for example if the
    /// new stiffness does not suit the damping that was sent before.
    pub(super) fn send<C: FnOnce(&mut SetPoint) -> Result<(), SetPointError>>(
        &self,
        finger: FingerNumber,
        what: (Replaced, Validity),
        admit: impl FnOnce(&Admission) -> Result<C, SetPointError>,
    ) -> Result<(), HandError> {
        let member = self.dispatcher.member(finger)?;
        let admission = member.admission.read();
        let change = admit(&admission)?;
        member.mailbox.try_send(what, change).map_err(|fault| HandError::Faulted { finger, fault })??;
        Ok(())
    }
}

//! The calls that send set points: from a planner's arguments through their checks to the mailbox of the finger.

use crate::control::{Law, SetPoint};
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError, SetPointError};
use crate::model::Contact;

impl Hand {
    /// theta_d of finger 1, 2 or 3: joints 0, 1, 2, rad. Takes effect within a cycle.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, beyond a joint limit, finger faulted.
    pub fn send_position(&self, finger: i32, joints: [f64; 3]) -> Result<(), HandError> {
        let member = self.dispatcher.member(finger)?;
        let admission = member.admission.read();
        let (joints, law) = (admission.joints(joints)?, admission.law);
        let sent = member.mailbox.send(|set_point| (set_point.joints, set_point.law) = (joints, law));
        sent.map_err(|fault| HandError::Faulted { finger, fault })
    }

    /// Kx of finger 1, 2 or 3 in the finger's frame, N/cm: `rows[row][column]`. Taken over whole, without a
    /// jump in torque: 95 % of the change is there after 50 ms.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, not symmetric, a negative eigenvalue, stiffer than the bound, too stiff for the
    /// damping sent last, finger faulted.
    pub fn send_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), HandError> {
        self.send(finger, |admission| {
            let (stiffness, damping) = (admission.stiffness(rows)?, admission.damping);
            Ok(move |set_point: &mut SetPoint| {
                set_point.stiffness = stiffness;
                damping.admit(set_point)
            })
        })
    }

    /// Where the tip of finger 1, 2 or 3 shall be, cm, in the finger's frame. The fingertip is the exact spring there,
    /// tau = J^T Kx (x_d - x), with the stiffness sent last; of several joint solutions within the limits it takes the
    /// one that is nearest to the present pose. Takes effect within a cycle; the way there is straight in the joints,
    /// at their bounded speed.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, out of reach or of the joint limits (also where commands are clamped), finger
    /// faulted.
    pub fn send_tip(&self, finger: i32, tip: [f64; 3]) -> Result<(), HandError> {
        let present = self.dispatcher.last_report(finger)?.cycle.joints;
        self.send(finger, |admission| {
            let joints = admission.tip(tip, &present)?;
            Ok(move |set_point: &mut SetPoint| {
                (set_point.joints, set_point.law) = (joints, Law::Exact);
                Ok(())
            })
        })
    }

    /// What finger 1, 2 or 3 may exchange with an object: its tip becomes the spring of that contact, without a jump in
    /// torque. Takes the place of the Kx sent last, as a Kx takes its.
    ///
    /// # Errors
    /// No such finger, stiffer than the bound, too stiff for the damping sent last, finger faulted. A rotation counts
    /// for the bound by how far it moves the last joint: k N cm/rad as k / l2^2 N/cm.
    pub fn send_contact(&self, finger: i32, contact: Contact) -> Result<(), HandError> {
        self.send(finger, |admission| {
            let (stiffness, damping) = (admission.contact(&contact)?, admission.damping);
            Ok(move |set_point: &mut SetPoint| {
                set_point.stiffness = stiffness;
                damping.admit(set_point)
            })
        })
    }

    /// Damping of finger 1, 2 or 3 relative to what the controller chooses from the stiffness: 1 is that, and is in
    /// force after open. The range depends on controller, rate and stiffness
    /// ([`AdmissibleDamping`](crate::control::AdmissibleDamping)).
    ///
    /// # Errors
    /// No such finger, NaN or infinity, outside the range of the stiffness sent last, finger faulted.
    pub fn send_damping(&self, finger: i32, ratio: f64) -> Result<(), HandError> {
        self.send(finger, |admission| {
            admission.finite("Ratio", &[ratio])?;
            let damping = admission.damping;
            Ok(move |set_point: &mut SetPoint| {
                set_point.damping = ratio;
                damping.admit(set_point)
            })
        })
    }

    /// Sends the change that `admit` lets through. Both are one step: limits do not change between them. The change
    /// itself may still refuse the set point that it starts from.
    fn send<C: FnOnce(&mut SetPoint) -> Result<(), SetPointError>>(
        &self,
        finger: i32,
        admit: impl FnOnce(&Admission) -> Result<C, SetPointError>,
    ) -> Result<(), HandError> {
        let member = self.dispatcher.member(finger)?;
        let admission = member.admission.read();
        let change = admit(&admission)?;
        member.mailbox.try_send(change).map_err(|fault| HandError::Faulted { finger, fault })??;
        Ok(())
    }
}

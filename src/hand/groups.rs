//! Groups: one call sends set points to several fingers, and all of them take effect in the same period.

use crate::control::{Law, SetPoint};
use crate::finger::{Replaced, Validity};
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError, SetPointError};
use crate::model::FingerNumber;
use nalgebra::Vector3;

/// A desired pose of a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Pose {
    /// Angles of joints 0, 1 and 2, rad, as in [`Hand::send_position`].
    Joints([f64; 3]),
    /// Position of the tip in the finger's frame, cm, as in [`Hand::send_tip`].
    Tip([f64; 3]),
}

/// The command for one finger in a group. All commands of a group take effect in the same period. A quantity that is
/// `None` keeps its value.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FingerCommand {
    /// Number of the finger, 1 to 3.
    pub finger: i32,
    /// Desired pose.
    pub pose: Option<Pose>,
    /// Kx in the finger's frame, N/cm: `rows[row][column]`, as in [`Hand::send_stiffness`].
    pub stiffness: Option<[[f64; 3]; 3]>,
    /// Relative damping, as in [`Hand::send_damping`].
    pub damping: Option<f64>,
    /// How long the resulting set point is valid.
    pub validity: Validity,
}

impl FingerCommand {
    /// Returns a command that changes nothing.
    #[must_use]
    pub fn new(finger: i32) -> Self {
        Self { finger, ..Self::default() }
    }

    /// Sets the desired joint angles, rad.
    #[must_use]
    pub fn joints(self, joints: [f64; 3]) -> Self {
        Self { pose: Some(Pose::Joints(joints)), ..self }
    }

    /// Sets the desired position of the tip, cm.
    #[must_use]
    pub fn tip(self, tip: [f64; 3]) -> Self {
        Self { pose: Some(Pose::Tip(tip)), ..self }
    }

    /// Sets Kx, N/cm.
    #[must_use]
    pub fn stiffness(self, rows: [[f64; 3]; 3]) -> Self {
        Self { stiffness: Some(rows), ..self }
    }

    /// Sets the relative damping.
    #[must_use]
    pub fn damping(self, ratio: f64) -> Self {
        Self { damping: Some(ratio), ..self }
    }

    /// Sets how long the resulting set point is valid.
    #[must_use]
    pub fn validity(self, validity: Validity) -> Self {
        Self { validity, ..self }
    }

    /// Returns what the command replaces.
    pub(super) fn replaced(&self) -> Replaced {
        match (self.pose, self.stiffness) {
            (Some(_), _) => Replaced::Place,
            (None, Some(_)) => Replaced::Stiffness,
            (None, None) => Replaced::Other,
        }
    }

    /// Refuses NaN and infinity in every quantity.
    pub(super) fn check_finite(&self, admission: &Admission) -> Result<(), SetPointError> {
        match &self.pose {
            None => {}
            Some(Pose::Joints(joints)) => admission.finite("Pos", joints)?,
            Some(Pose::Tip(tip)) => admission.finite("Tip", tip)?,
        }
        admission.finite("Kx", self.stiffness.as_slice().as_flattened().as_flattened())?;
        admission.finite("Damping", self.damping.as_slice())
    }

    /// Checks the command. Returns a function that changes the set point. That function returns an error if it refuses
    /// the resulting damping. `present` is the pose of the finger, rad. A Kx that is no spring is reported before a
    /// value that is out of range, because the manual of the C call lists the reasons in this order.
    pub(super) fn admit(
        &self,
        admission: &Admission,
        present: &Vector3<f64>,
    ) -> Result<impl FnOnce(&mut SetPoint) -> Result<(), SetPointError> + use<>, SetPointError> {
        self.check_finite(admission)?;
        let stiffness = match self.stiffness.map(|rows| admission.stiffness(rows)).transpose() {
            Err(error) if error.is_no_spring() => return Err(error),
            checked => checked,
        };
        let pose = match self.pose {
            None => None,
            Some(Pose::Joints(joints)) => Some((admission.joints(joints)?, admission.law)),
            Some(Pose::Tip(tip)) => Some((admission.tip(tip, present)?, Law::Exact)),
        };
        let stiffness = stiffness?;
        let ratio = self.damping;
        let damping = admission.damping;
        Ok(move |set_point: &mut SetPoint| {
            (set_point.joints, set_point.law) = pose.unwrap_or((set_point.joints, set_point.law));
            if let Some(stiffness) = stiffness {
                set_point.stiffen_tip(stiffness);
            }
            set_point.damping = ratio.unwrap_or(set_point.damping);
            if stiffness.is_some() || ratio.is_some() { damping.admit(set_point) } else { Ok(()) }
        })
    }
}

impl Hand {
    /// Sends commands to several fingers. All of them take effect in the same period of the hand, even if different
    /// threads serve the fingers. The period begins at most two periods after the call. Either every command is sent,
    /// or none is. A single command takes effect in the next cycle of its finger.
    ///
    /// If a servo is so late that it skips this period, its fingers follow in their next cycle. With `hand.clock` set
    /// to "board", the cycles of a thread follow the clock of its board, but the periods are counted by the host's
    /// clock. So the cycles skip or repeat a period now and then, and a group may then take effect one period later in
    /// the fingers of this thread.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if a finger has two commands, if a finger refuses its command, if a
    /// finger is faulted, or if 16 groups of a finger have not taken effect yet.
    pub fn send_group(&self, commands: &[FingerCommand]) -> Result<(), HandError> {
        if commands.is_empty() {
            return Ok(());
        }
        if let [alone] = commands {
            // A command for a single finger does not wait for other fingers.
            let finger = FingerNumber::try_from(alone.finger)?;
            let present = self.dispatcher.last_report(finger)?.cycle.joints;
            let what = (alone.replaced(), alone.validity);
            return self.send(finger, what, |admission| alone.admit(admission, &present));
        }
        self.send_together(commands, &[])
    }
}

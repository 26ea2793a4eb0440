//! The state of a fingertip: position, force and tendon tensions.

use crate::control::ContactEstimate;
use crate::finger::{FingerReport, FingertipState, Stage};
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;

/// The state of a fingertip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FingerTip {
    /// Position in the finger's frame, cm, from the measured joint angles.
    pub tip: [f64; 3],
    /// Force on the touched object in the finger's frame, N: J^-T R t (eqs. 1 and 13 of the report) with the Jacobian
    /// J, the moment arms R and the measured tensions t. The force includes the effects of the finger's friction,
    /// weight and acceleration. It is never NaN: near singular poses, the component in a direction that the joints do
    /// not feel is zero.
    pub force: [f64; 3],
    /// Number of directions that the joints feel: 3, or fewer near a singular pose.
    pub felt: usize,
    /// Measured tendon tensions, N.
    pub tensions: [f64; 4],
    /// Stiffness of the tip in the present pose, in the finger's frame, N/cm. It is the part of Kx, or of the joint
    /// stiffness, that the present pose admits. The field also contains the effect of three other springs: a rotational
    /// stiffness of the contact, the soft joint limits, and the spring of joint 0 while the tip is near the axis of
    /// this joint. (The rotational stiffness contributes, because a force that displaces the tip also turns it.) After
    /// a change of Kx, this field has its new value in the next cycle, although the stiffness of the finger itself
    /// changes over 50 ms. The stiffness is zero in a direction that the joints do not feel, and while the finger is
    /// not in the stage `Running`.
    pub stiffness: [[f64; 3]; 3],
    /// Force on the touched object in the finger's frame, N, without the friction, weight and acceleration of the
    /// finger, and without constant errors of the gauges: from the momentum observer of docs/contact.md. It is zero
    /// while the finger is not in the stage `Running`.
    pub contact: [f64; 3],
    /// Whether the finger touches something, as far as tensions and motion show it. It is false while the finger is
    /// not in the stage `Running`.
    pub touching: bool,
    /// Speed of the tip perpendicular to `contact`, cm/s, while the finger touches something. A speed above 0 means
    /// that the tip slides on the object, or moves it.
    pub slide: f64,
}

impl Hand {
    /// Position and force of the tip of finger 1, 2 or 3, and the tensions of its tendons. They are at most one cycle
    /// old.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn fingertip(&self, finger: i32) -> Result<FingerTip, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let report = self.dispatcher.report(finger)?;
        Ok(FingerTip::new(&self.dispatcher.member(finger)?.admission.read(), &report))
    }
}

impl FingerTip {
    fn new(admission: &Admission, report: &FingerReport) -> Self {
        let running = report.stage == Stage::Running;
        // At the beginning of a calibration the finger can still be a spring, with an estimate of a contact.
        let contact = if running { report.cycle.contact } else { ContactEstimate::default() };
        let springs = admission.springs.as_ref().filter(|_| running);
        let spring = springs.map(|springs| (springs, &report.set_point));
        let state = FingertipState::new(admission.links, &admission.r, &report.cycle, spring);
        Self {
            tip: state.tip.into(),
            force: state.force.into(),
            felt: state.felt,
            tensions: report.cycle.tensions.into(),
            // The matrix is symmetric, so its rows are its columns.
            stiffness: state.stiffness.into(),
            contact: contact.force_on_surroundings().into(),
            touching: contact.touching,
            slide: contact.slide,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::SetPoint;
    use crate::model::configuration::Configuration;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn only_a_running_finger_reports_a_contact() {
        let admission = Admission::new(&Configuration::default(), FingerNumber::ONE);
        let joints = Vector3::new(0.2, 0.6, 1.1);
        let mut report = FingerReport::opening(SetPoint::hard_finger(joints, Matrix3::identity()));
        report.cycle.joints = joints;
        report.cycle.contact =
            ContactEstimate { force: Vector3::x(), touching: true, slide: 2.0, ..ContactEstimate::default() };
        let touched = ([-1.0, 0.0, 0.0], true, 2.0);
        let none = ([0.0; 3], false, 0.0);
        for (stage, expected) in [(Stage::Running, touched), (Stage::Calibrating, none), (Stage::Limp, none)] {
            report.stage = stage;
            let tip = FingerTip::new(&admission, &report);
            assert_eq!((tip.contact, tip.touching, tip.slide), expected, "{stage:?}");
        }
    }
}

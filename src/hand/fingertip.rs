//! The state of a fingertip: position, force and tendon tensions.

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
    /// weight and acceleration. It is never NaN: near the straight pose, the component in a direction that the joints
    /// do not feel is zero.
    pub force: [f64; 3],
    /// Number of directions that the joints feel: 3, or fewer near a singular pose.
    pub felt: usize,
    /// Measured tendon tensions, N.
    pub tensions: [f64; 4],
    /// Stiffness of the tip in the present pose, in the finger's frame, N/cm. It is the part of the sent stiffness of
    /// tip and joints that is in force. Three other springs add to it: a rotational stiffness of the contact, the soft
    /// joint limits, and the spring of joint 0 near its axis. A force that displaces the tip also turns it, because the
    /// joints turn. The stiffness is zero in a direction that the joints do not feel, and while the finger is not a
    /// spring.
    pub stiffness: [[f64; 3]; 3],
    /// Force on the touched object in the finger's frame, N, without the friction, weight and acceleration of the
    /// finger, and without constant errors of the gauges: from the momentum observer of docs/contact.md. It is zero
    /// while the finger does not follow a set point.
    pub contact: [f64; 3],
    /// Whether the finger touches something, as far as tensions and motion show it.
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
            contact: (-report.cycle.contact.force).into(),
            touching: report.cycle.contact.touching,
            slide: report.cycle.contact.slide,
        }
    }
}

//! Runs all detectors of a finger. The servo calls them in each cycle that has a reply and in which the finger follows
//! a set point.

use super::arrival::{Arrival, ArrivalDetector, ArrivalState};
use super::contact_edges::{ContactBefore, ContactEdges};
use super::joint_limits::JointLimits;
use super::observation::Observations;
use super::slip::{SlipDetector, SlipState};
use super::tension_bounds::{Side, TensionBounds};
use crate::control::signals::{Report, SetPoint};
use crate::model::configuration::ConfiguredFinger;

/// All detectors of a finger.
#[derive(Clone, Debug)]
pub struct Detectors {
    contact: ContactEdges,
    tensions: TensionBounds,
    joints: JointLimits,
    arrival: ArrivalDetector,
    slip: SlipDetector,
}

/// The state of the detectors.
#[derive(Clone, Copy, Debug)]
pub struct DetectorState {
    contact: ContactBefore,
    /// For each tension, the bound that it crossed last, until it is back inside by the hysteresis; otherwise none.
    tensions: [Option<Side>; 4],
    /// Whether each joint is at a limit.
    joints: [bool; 3],
    arrival: ArrivalState,
    slip: SlipState,
}

impl Detectors {
    /// Constructs the detectors of a finger with this `rate`, Hz.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        Self {
            contact: ContactEdges::new(&finger.events),
            tensions: TensionBounds::new(&finger.events),
            joints: JointLimits::new(finger),
            arrival: ArrivalDetector::new(&finger.events, rate),
            slip: SlipDetector::new(&finger.events, rate),
        }
    }

    /// Runs the detectors after a cycle with a reply. The finger followed `set_point` in this cycle.
    pub fn observe(&self, state: &mut DetectorState, report: &Report, set_point: &SetPoint) -> Observations {
        let mut observations = Observations::default();
        self.contact.observe(&mut state.contact, &report.contact, &mut observations);
        self.tensions.observe(&mut state.tensions, report, &mut observations);
        self.joints.observe(&mut state.joints, report, &mut observations);
        self.arrival.observe(&mut state.arrival, report, set_point, &mut observations);
        let settled = state.arrival().settled;
        self.slip.observe(&mut state.slip, &report.contact, settled, &mut observations);
        observations
    }
}

impl DetectorState {
    /// Returns the state of a finger that begins to follow set points and holds this one. This beginning does not count
    /// as an arrival.
    pub fn holding(set_point: SetPoint) -> Self {
        Self {
            contact: ContactBefore::default(),
            tensions: [None; 4],
            joints: [false; 3],
            arrival: ArrivalState::holding(set_point),
            slip: SlipState::default(),
        }
    }

    /// Returns two facts: whether the finger has arrived at its set point, and whether it has settled.
    pub fn arrival(&self) -> Arrival {
        self.arrival.arrival()
    }
}

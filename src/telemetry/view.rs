//! Conversion of cycles to samples, with the geometry of the controller that each cycle names.

use super::message::Message;
use super::sample::Sample;
use crate::control::{Activity, ContactEstimate, JointSprings, Report};
use crate::finger::{ControlRecord, ControllerSource, CycleRecord, FingertipState, Stage};
use crate::model::configuration::{Configuration, ConfiguredFinger, FINGERS};
use crate::model::{FingerNumber, Links};
use crate::realtime::CycleStage;
use nalgebra::{Isometry3, Matrix3, Matrix3x4, Vector3};
use std::collections::BTreeMap;

/// Largest number of controllers whose mechanics are kept for a finger. A servo begins to use a controller soon after
/// the controller is announced, or never uses it. So the oldest controllers can be forgotten.
const MOST_ADJUSTED: usize = 4096;

/// Converts the cycles of a hand's fingers to samples.
pub struct View {
    rate: f64,
    fingers: [FingerView; FINGERS],
}

struct FingerView {
    to_palm: Isometry3<f64>,
    /// The finger as it was configured at open, for cycles whose controller has not been announced.
    configured: Mechanics,
    /// The mechanics for which each controller is made, by the number of the controller.
    adjusted: BTreeMap<u32, Mechanics>,
    /// The last cycle in which the controller ran.
    last: Option<ControlRecord>,
}

/// Geometry, springs and tension bounds of a finger.
struct Mechanics {
    links: Links,
    r: Matrix3x4<f64>,
    springs: Option<JointSprings>,
    tension_bounds: (f64, f64),
}

impl Mechanics {
    fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        Self {
            links: finger.links(),
            r: finger.r(),
            springs: JointSprings::new(finger, rate),
            tension_bounds: (finger.tendon.minimum, finger.tendon.maximum),
        }
    }
}

impl View {
    /// Creates the view of a hand with this configuration.
    pub fn new(configuration: &Configuration) -> Self {
        let rate = configuration.hand.rate;
        let finger = |number: FingerNumber| FingerView {
            to_palm: configuration.finger_to_palm(number),
            configured: Mechanics::new(&configuration.fingers[number.index()], rate),
            adjusted: BTreeMap::new(),
            last: None,
        };
        Self { rate, fingers: FingerNumber::ALL.map(finger) }
    }

    /// Takes note of a controller. Later cycles that name this controller are converted with the configuration for
    /// which it was made.
    pub fn note_controller(&mut self, finger: FingerNumber, source: &ControllerSource) {
        let mechanics = Mechanics::new(&source.finger, self.rate);
        let adjusted = &mut self.fingers[finger.index()].adjusted;
        adjusted.insert(source.number, mechanics);
        while adjusted.len() > MOST_ADJUSTED {
            adjusted.pop_first();
        }
    }

    /// Takes note of a controller, or converts a cycle to its sample. Returns None for every message except a cycle.
    pub fn take(&mut self, message: &Message) -> Option<Sample> {
        match message {
            Message::Controller { finger, source, .. } => {
                self.note_controller(*finger, source);
                None
            }
            Message::Cycle { finger, record } => Some(self.sample(*finger, record)),
            _ => None,
        }
    }

    /// Converts a cycle.
    pub fn sample(&mut self, finger: FingerNumber, record: &CycleRecord) -> Sample {
        let view = &mut self.fingers[finger.index()];
        let control = record.control.or(view.last);
        view.last = control;
        let adjusted = control.and_then(|control| view.adjusted.get(&control.controller));
        let mechanics = adjusted.unwrap_or(&view.configured);
        let report = control.map_or_else(Report::default, |control| control.report);
        let set_point = control.and_then(|control| match control.input.activity {
            Activity::Follow(set_point) => Some(set_point),
            _ => None,
        });
        let running = record.stage == Stage::Running;
        // When a calibration begins, the finger remains a spring until the calibration gives the first activity. In
        // this time the report still has an estimate of a contact, but a sample has one only in the stage `Running`.
        let contact = if running { report.contact } else { ContactEstimate::default() };
        let springs = mechanics.springs.as_ref().filter(|_| running);
        let spring = springs.zip(set_point.as_ref());
        let state = FingertipState::new(mechanics.links, &mechanics.r, &report, spring);
        let (to_palm, turn) = (&view.to_palm, view.to_palm.rotation.to_rotation_matrix());
        let in_palm = |tip: Vector3<f64>| to_palm.transform_point(&tip.into()).coords.into();
        let microseconds = |stage| record.timing.duration(stage).map(|time| f64::from(time) * 1e-3);
        Sample {
            finger,
            cycle: record.cycle,
            began: record.began,
            stage: record.stage,
            computed: record.control.is_some(),
            joints: report.joints.into(),
            joint_rates: report.joint_rates.into(),
            joint_set_point: set_point.map(|set_point| set_point.joints.into()),
            tip: in_palm(state.tip),
            tip_set_point: set_point.map(|set_point| in_palm(mechanics.links.tip(&set_point.joints))),
            tip_force: state.force.into(),
            tip_force_in_palm: (turn * state.force).into(),
            kx: set_point.map(|set_point| rows(&set_point.stiffness.fixed_view::<3, 3>(0, 0).into_owned())),
            stiffness: rows(&state.stiffness),
            stiffness_in_palm: rows(&(turn * state.stiffness * turn.transpose())),
            joint_torques: report.joint_torques.into(),
            measured_joint_torques: state.torques.into(),
            desired_tensions: report.desired_tensions.into(),
            tensions: report.tensions.into(),
            t_min: mechanics.tension_bounds.0,
            t_max: mechanics.tension_bounds.1,
            motor_torques: report.motor_torques.into(),
            torque_scale: report.torque_scale,
            stiffness_scale: report.stiffness_scale,
            contact_force: contact.force_on_surroundings().into(),
            touching: contact.touching,
            slide: contact.slide,
            wake_up: microseconds(CycleStage::WakeUp),
            whole: microseconds(CycleStage::Whole),
        }
    }
}

fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::{MotorCommand, SetPoint};
    use crate::finger::ControlInput;
    use crate::realtime::CycleTiming;

    #[test]
    fn a_hand_that_is_adjusted_all_the_time_does_not_fill_the_memory() {
        let configuration = Configuration::default();
        let (mut view, mut finger) = (View::new(&configuration), configuration.fingers[0].clone());
        // Without moment arms no springs are computed. Their computation would take most of the time of this test.
        finger.geometry.r = [[0.0; 4]; 3];
        let gravity = configuration.gravity(FingerNumber::ONE);
        let mut source = ControllerSource { number: 0, gravity, finger };
        for number in 0..=MOST_ADJUSTED as u32 + 10 {
            source.number = number;
            view.note_controller(FingerNumber::ONE, &source);
        }
        let adjusted = &view.fingers[0].adjusted;
        let (oldest, newest) = (adjusted.keys().next().copied(), adjusted.keys().next_back().copied());
        assert_eq!((oldest, newest, adjusted.len()), (Some(11), Some(source.number), MOST_ADJUSTED));
    }

    #[test]
    fn only_a_running_finger_has_a_contact() {
        let joints = Vector3::new(0.2, 0.6, 1.1);
        let input = ControlInput {
            anew_from: None,
            activity: Activity::Follow(SetPoint::hard_finger(joints, Matrix3::identity())),
            skipped: 0,
            fading: None,
            gravity: None,
            path_begins: false,
        };
        let contact = ContactEstimate { force: Vector3::x(), touching: true, slide: 2.0, ..ContactEstimate::default() };
        let report = Report { joints, contact, ..Report::default() };
        let control = ControlRecord { controller: 0, previous: 0, input, command: MotorCommand::default(), report };
        let (touched, none) = (([-1.0, 0.0, 0.0], true, 2.0), ([0.0; 3], false, 0.0));
        for (stage, expected) in [(Stage::Running, touched), (Stage::Calibrating, none), (Stage::Limp, none)] {
            let (timing, control) = (CycleTiming::default(), Some(control));
            let record = CycleRecord { cycle: 1, began: 0, stage, timing, feedback: None, status: 0, control };
            let sample = View::new(&Configuration::default()).sample(FingerNumber::ONE, &record);
            assert_eq!((sample.contact_force, sample.touching, sample.slide), expected, "{stage}");
        }
    }
}

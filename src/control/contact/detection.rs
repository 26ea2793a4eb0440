//! Decides whether a finger touches something, by thresholds with hysteresis. Before the torques are compared with a
//! threshold, their slowly varying error is subtracted. This error is learned while the finger touches nothing.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Time constant with which the recent motion is forgotten, s. It exceeds the delay of the residual with the default
/// `contact.bandwidth`.
const CALMING: f64 = 0.1;

/// Duration of the first average of the error, s, unless the learning time is shorter. No contact is reported before
/// its end.
const FIRST: f64 = 0.2;

/// Joint rate at which the error of the torques is learned half as fast as at rest, rad/s. A motion adds errors of its
/// own: friction that depends on the direction of the motion, and the inertia of links whose configured masses are
/// wrong. If these errors were learned, a contact right after the motion would preserve them, because nothing is
/// learned during a contact. So a finger learns fully at rest and during the first average. After the first average, a
/// moving finger learns only slow drifts.
const SLOW: f64 = 0.1;

/// The constant part of the detection.
#[derive(Clone, Debug)]
pub(super) struct Detection {
    force: f64,
    force_per_rate: f64,
    torque: Vector3<f64>,
    mass_tolerance: f64,
    lost: f64,
    learning_time: f64,
    /// Duration of the first average, s.
    first: f64,
}

/// The state of the detection.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct DetectionState {
    /// Residual torques of a finger that touches nothing, N cm.
    pub error: Vector3<f64>,
    /// Fastest joint rate of the recent past, rad/s.
    rate: f64,
    /// Largest inertial torque of each joint in the recent past, N cm.
    inertial: Vector3<f64>,
    /// Time for which the error has been learned, s. It does not exceed the learning time.
    time: f64,
    /// Speed of the learning, 0 to 1.
    pub learning: f64,
    pub touching: bool,
}

/// The torques of one sample, N cm.
pub(super) struct Torques<'a> {
    /// The residual of the momentum observer.
    pub residual: &'a Vector3<f64>,
    /// The derivative of the momentum.
    pub inertial: &'a Vector3<f64>,
    /// The part of the thresholds that depends on pose and tensions.
    pub allowed: &'a Vector3<f64>,
}

impl Detection {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let contact = &finger.contact;
        Self {
            force: contact.force,
            force_per_rate: contact.force_per_rate,
            torque: contact.torque.into(),
            mass_tolerance: contact.mass_tolerance,
            lost: contact.lost,
            learning_time: contact.learning_time_s,
            first: FIRST.min(contact.learning_time_s),
        }
    }

    /// Decides whether the finger touches something, from the torques, the force at the tip, N, and the joint rates,
    /// rad/s. `elapsed` is the time since the previous sample, s.
    pub fn decide(
        &self,
        state: &mut DetectionState,
        torques: &Torques,
        force: &Vector3<f64>,
        rates: &Vector3<f64>,
        elapsed: f64,
    ) {
        let fades = 1.0 - (elapsed * (1.0 / CALMING)).min(1.0);
        state.rate = (state.rate * fades).max(rates.amax());
        state.inertial = (state.inertial * fades).sup(&torques.inertial.abs());
        let part = if state.touching { self.lost } else { 1.0 };
        let least = (self.force + self.force_per_rate * state.rate) * part;
        let bounds = (self.torque + torques.allowed + state.inertial * self.mass_tolerance) * part;
        let excess = torques.residual - state.error;
        let loaded = (excess.abs() - bounds).max() > 0.0;
        state.touching = loaded && force.norm_squared() > least * least && state.time >= self.first;
        let motion = if state.time < self.first { 0.0 } else { state.rate * (1.0 / SLOW) };
        state.learning = if state.touching { 0.0 } else { 1.0 / (1.0 + motion * motion) };
        let learned = elapsed * state.learning;
        state.time = (state.time + learned).min(self.learning_time);
        state.error += excess * (learned / state.time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_is_detected_with_any_learning_time() {
        for learning_time in [0.05, 0.1, 0.2, 5.0] {
            let mut finger = ConfiguredFinger::default();
            finger.contact.learning_time_s = learning_time;
            let detection = Detection::new(&finger);
            let (none, push) = (Vector3::zeros(), Vector3::new(0.0, 20.0, 0.0));
            let mut state = DetectionState::default();
            let mut decide = |residual: &Vector3<f64>| {
                let torques = Torques { residual, inertial: &none, allowed: &none };
                detection.decide(&mut state, &torques, &Vector3::new(0.0, 5.0, 0.0), &none, 1e-3);
                state.touching
            };
            assert!((0..1000).all(|_| !decide(&none)), "{learning_time} s");
            assert!((0..1000).all(|_| decide(&push)), "{learning_time} s");
        }
    }
}

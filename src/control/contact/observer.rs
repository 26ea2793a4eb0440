//! One cycle of the contact estimate.

use super::detection::{Detection, DetectionState, Torques};
use super::estimate::ContactEstimate;
use super::momentum_observer::{MomentumObserver, MomentumState};
use super::tip_force::TipForce;
use crate::control::signals::Report;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{LinkDynamics, LinkMomentum, Links, Tendons};
use nalgebra::{Matrix3x4, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Time between two samples of the estimate, s. It is short compared with the delay of the residual. An estimate at
/// every sample of the servo would need four times the computing time at 1000 Hz, and would detect the same forces.
const INTERVAL: f64 = 0.005;

/// Each slowly varying quantity is computed again once in this number of samples. At each sample, at most one of these
/// quantities is computed. A joint that turns at 1 rad/s moves by 0.02 rad during these samples, which changes the
/// inertia by less than 2 %.
const REFRESH: u8 = 4;

/// The constant part of the contact estimate.
#[derive(Clone, Debug)]
pub(in crate::control) struct ContactObserver {
    links: Links,
    dynamics: LinkDynamics,
    observer: MomentumObserver,
    detection: Detection,
    /// Largest change of a joint's torque that the friction of a tendon on its pulleys causes, per tension, cm.
    rubbing: Matrix3x4<f64>,
    mass_tolerance: f64,
    /// Shortest time between two samples, s.
    interval: f64,
    /// At full learning speed, this fraction of a change in the torque of gravity enters `learned_weight` in
    /// [`REFRESH`] samples.
    learned: f64,
}

/// The state of the contact estimate.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(in crate::control) struct ContactState {
    /// None while the finger does not follow a set point.
    following: Option<Following>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
struct Following {
    /// Time since the last sample, s.
    waited: f64,
    /// Number of the sample, 0 to [`REFRESH`] - 1.
    sample: u8,
    /// Inertia matrix of the links and its derivatives, N cm s^2.
    links: LinkMomentum,
    /// Average torque of gravity in the poses in which the error of the residual torques was learned, N cm.
    learned_weight: Vector3<f64>,
    /// Torque that friction of the tendons and the uncertain weight of the links can cause, N cm.
    allowed: Vector3<f64>,
    tip: TipForce,
    momentum: MomentumState,
    detection: DetectionState,
}

impl ContactObserver {
    /// Constructs the estimate of a finger at `rate`, Hz.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, rate: f64) -> Self {
        let links = &finger.links;
        let pulley = finger.friction.pulley;
        Self {
            links: finger.links(),
            dynamics: LinkDynamics::new(finger.links(), links.masses, links.radii, Vector3::zeros()),
            observer: MomentumObserver::new(finger, tendons),
            detection: Detection::new(finger),
            // The factor is 2, because the learned error contains the friction of one direction of motion, and the
            // friction changes its sign in the other direction.
            rubbing: Matrix3x4::from_fn(|joint, tendon| 2.0 * tendons.r[(joint, tendon)].abs() * pulley[tendon]),
            mass_tolerance: finger.contact.mass_tolerance,
            // Rounding errors of the time must not delay a sample by a period.
            interval: INTERVAL - 0.5 / rate,
            learned: (f64::from(REFRESH) * INTERVAL / finger.contact.learning_time_s).min(1.0),
        }
    }

    /// Returns whether both observers compute with the same moment arms.
    pub fn has_arms_of(&self, other: &Self) -> bool {
        self.observer.r == other.observer.r
    }

    /// If the next sample is due, computes it from the joint angles and tensions in `report`, and writes the estimate
    /// to the report. The finger must follow a set point. `weight` returns the torques of gravity at joint angles,
    /// N cm. `elapsed` is the time since the previous measurement, s.
    pub fn follow(
        &self,
        state: &mut ContactState,
        report: &mut Report,
        weight: impl Fn(&Vector3<f64>) -> Vector3<f64>,
        elapsed: f64,
    ) {
        let Report { joints, tensions, .. } = &*report;
        let now = state.following.get_or_insert_with(|| self.start(joints, tensions, &weight(joints)));
        now.waited += elapsed;
        if now.waited < self.interval {
            return;
        }
        let elapsed = std::mem::take(&mut now.waited);
        self.refresh(now, joints, tensions);
        self.observer.advance(&mut now.momentum, &now.links, &weight(joints), (joints, tensions), elapsed);
        let MomentumState { residual, inertial, rates, .. } = &now.momentum;
        let torques = residual - now.detection.error;
        let force = now.tip.of(&torques);
        let parts = Torques { residual, inertial, allowed: &now.allowed };
        self.detection.decide(&mut now.detection, &parts, &force, rates, elapsed);
        let touching = now.detection.touching;
        let slide = if touching { slide(&force, &now.tip.speed(rates)) } else { 0.0 };
        report.contact = ContactEstimate { torques, force, touching, slide };
    }

    /// Ends the estimate, because the finger does not follow a set point.
    pub fn end(&self, state: &mut ContactState, report: &mut Report) {
        state.following = None;
        report.contact = ContactEstimate::default();
    }

    /// `weight` is the torque of gravity, N cm.
    fn start(&self, joints: &Vector3<f64>, tensions: &Vector4<f64>, weight: &Vector3<f64>) -> Following {
        Following {
            waited: 0.0,
            sample: 0,
            links: self.momentum(joints),
            learned_weight: *weight,
            allowed: self.rubbing * tensions,
            tip: TipForce::at(&self.links, joints),
            momentum: self.observer.start(joints, tensions, weight),
            detection: DetectionState::default(),
        }
    }

    fn refresh(&self, now: &mut Following, joints: &Vector3<f64>, tensions: &Vector4<f64>) {
        now.sample = now.sample.wrapping_add(1) % REFRESH;
        match now.sample {
            0 => now.links = self.momentum(joints),
            1 => now.tip = TipForce::at(&self.links, joints),
            2 => {
                let change = now.momentum.weight - now.learned_weight;
                now.allowed = self.rubbing * tensions + change.abs() * self.mass_tolerance;
                now.learned_weight += change * (self.learned * now.detection.learning);
            }
            _ => {}
        }
    }

    fn momentum(&self, joints: &Vector3<f64>) -> LinkMomentum {
        self.dynamics.momentum(joints).scaled(100.0)
    }
}

/// Returns the part of the tip's speed that is perpendicular to the force, cm/s.
fn slide(force: &Vector3<f64>, speed: &Vector3<f64>) -> f64 {
    // The force of a finger that touches something is not zero.
    let along = force.dot(speed);
    (speed.norm_squared() - along * along / force.norm_squared()).max(0.0).sqrt()
}

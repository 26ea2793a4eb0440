//! One cycle of the contact estimate.

use super::detection::Detection;
use super::estimate::ContactEstimate;
use super::momentum_observer::{MomentumObserver, MomentumState};
use super::tip_force::TipForce;
use crate::control::signals::Report;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{LinkDynamics, LinkMomentum, Links, Tendons};
use nalgebra::{Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Number of cycles after which the quantities that depend only on the pose are computed again. Their parts are
/// computed in different cycles, so that no cycle takes much longer than the others. A joint that turns at 1 rad/s
/// moves by 0.016 rad in this time at 1000 Hz, which changes the inertia by less than 2 %.
const REFRESH: u8 = 16;

/// The constant part of the contact estimate.
#[derive(Clone, Debug)]
pub(in crate::control) struct ContactObserver {
    links: Links,
    /// The links with gravity.
    dynamics: LinkDynamics,
    observer: MomentumObserver,
}

/// The state of the contact estimate.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(in crate::control) struct ContactState {
    /// None while the finger does not follow a set point.
    following: Option<Following>,
}

#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
struct Following {
    links: LinkMomentum,
    /// Torque of gravity, N m.
    gravity: Vector3<f64>,
    tip: TipForce,
    momentum: MomentumState,
    detection: Detection,
    cycle: u8,
}

impl ContactObserver {
    /// Constructs the estimate of a finger in `gravity`, m/s^2 in the finger's frame.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, gravity: &Vector3<f64>) -> Self {
        let links = &finger.links;
        Self {
            links: finger.links(),
            dynamics: LinkDynamics::new(finger.links(), links.masses, links.radii, *gravity),
            observer: MomentumObserver::new(finger, tendons),
        }
    }

    /// Advances the estimate to the sample of `report`, of a finger that follows a set point, and writes the estimate
    /// to the report. `elapsed` is the time since the previous sample, s.
    pub fn follow(&self, state: &mut ContactState, report: &mut Report, elapsed: f64) {
        let Report { joints, joint_rates: rates, tensions, .. } = &*report;
        let now = state.following.get_or_insert_with(|| self.start(joints, tensions, rates));
        self.refresh(now, joints);
        self.observer.advance(&mut now.momentum, &now.links, &now.gravity, (tensions, rates), elapsed);
        let residual = &now.momentum.residual;
        let torques = (residual - now.detection.error) * 100.0;
        let force = now.tip.of(&torques);
        now.detection.decide(residual, &force, &now.momentum.rates, elapsed);
        report.contact = ContactEstimate { torques, force, touching: now.detection.touching };
    }

    /// Ends the estimate, because the finger does not follow a set point.
    pub fn end(&self, state: &mut ContactState, report: &mut Report) {
        state.following = None;
        report.contact = ContactEstimate::default();
    }

    fn start(&self, joints: &Vector3<f64>, tensions: &Vector4<f64>, rates: &Vector3<f64>) -> Following {
        let links = self.dynamics.momentum(joints);
        Following {
            links,
            gravity: self.dynamics.gravity_torque(joints),
            tip: TipForce::at(&self.links, joints),
            momentum: self.observer.start(&links, tensions, rates),
            detection: Detection::default(),
            cycle: 0,
        }
    }

    fn refresh(&self, now: &mut Following, joints: &Vector3<f64>) {
        now.cycle = (now.cycle + 1) % REFRESH;
        match now.cycle {
            0 => now.links = self.dynamics.momentum(joints),
            5 => now.gravity = self.dynamics.gravity_torque(joints),
            10 => now.tip = TipForce::at(&self.links, joints),
            _ => {}
        }
    }
}

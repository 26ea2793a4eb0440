//! The torques of the surroundings on the joints, from a momentum observer.
//!
//! De Luca and Mattone, Sensorless robot collision detection and hybrid force/motion control, ICRA 2005. The momentum
//! of the links is p = H(theta) theta_dot. Its derivative is
//!
//! p_dot = R t + C^T theta_dot + g - friction + external torques.
//!
//! The residual r follows r_dot = K (external torques - r). It is computed without the acceleration of the joints and
//! without an inversion of H:
//!
//! r = K (p - integral of (R t + C^T theta_dot + g - friction + r)).
//!
//! R t and the measured joint rates are low-pass filtered with the bandwidth K before. Without this filter, the noise
//! of the joint rates would exceed the torques that are to be noticed.
//!
//! The tensions are measured between motors and joints, so the friction and the inertia of the motors do not matter.

use crate::model::configuration::ConfiguredFinger;
use crate::model::{LinkMomentum, Tendons};
use nalgebra::{Matrix3x4, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// K: bandwidth of the residual and of the filter of its inputs, 1/s.
const BANDWIDTH: f64 = 60.0;

/// Joint rate from which the whole Coulomb friction of a joint is expected, rad/s. A step at zero rate would convert
/// the noise of the rates to torque.
const CREEP: f64 = 0.1;

/// The constant part of the observer, in SI units.
#[derive(Clone, Debug)]
pub(super) struct MomentumObserver {
    /// R, m.
    r: Matrix3x4<f64>,
    /// Coulomb friction of the joints, N m.
    coulomb: Vector3<f64>,
    /// Viscous friction of the joints, N m s/rad.
    viscous: Vector3<f64>,
}

/// The state of the observer.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct MomentumState {
    /// Low-pass filtered joint rates, rad/s.
    pub rates: Vector3<f64>,
    /// Low-pass filtered joint torques of the tendons, N m.
    torques: Vector3<f64>,
    /// p at the last sample, N m s.
    momentum: Vector3<f64>,
    /// r, N m.
    pub residual: Vector3<f64>,
}

impl MomentumObserver {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        Self {
            r: tendons.r * 0.01,
            coulomb: Vector3::from(finger.friction.joint_coulomb) * 0.01,
            viscous: Vector3::from(finger.friction.joint_viscous) * 0.01,
        }
    }

    /// Returns the state of a finger with these tensions, N, and joint rates, rad/s, on which nothing acts.
    pub fn start(&self, links: &LinkMomentum, tensions: &Vector4<f64>, rates: &Vector3<f64>) -> MomentumState {
        let torques = self.r * tensions;
        MomentumState { rates: *rates, torques, momentum: links.of(rates), residual: Vector3::zeros() }
    }

    /// Advances the residual to a sample with these tensions, N, and joint rates, rad/s. `gravity` is the torque of
    /// gravity, N m, and `elapsed` the time since the previous sample, s.
    pub fn advance(
        &self,
        state: &mut MomentumState,
        links: &LinkMomentum,
        gravity: &Vector3<f64>,
        (tensions, rates): (&Vector4<f64>, &Vector3<f64>),
        elapsed: f64,
    ) {
        // The implicit Euler method. It is stable for any time between two samples.
        let keeps = 1.0 / (1.0 + BANDWIDTH * elapsed);
        state.rates += (rates - state.rates) * (1.0 - keeps);
        state.torques += (self.r * tensions - state.torques) * (1.0 - keeps);
        let rates = &state.rates;
        let momentum = links.of(rates);
        let known = state.torques + links.energy_gradient(rates) + gravity - self.friction(rates);
        let gained = momentum - state.momentum - known * elapsed;
        state.residual = (state.residual + gained * BANDWIDTH) * keeps;
        state.momentum = momentum;
    }

    fn friction(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let direction = rates.map(|rate| (rate * (1.0 / CREEP)).clamp(-1.0, 1.0));
        self.viscous.component_mul(rates) + self.coulomb.component_mul(&direction)
    }
}

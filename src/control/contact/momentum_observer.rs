//! The torques of the surroundings on the joints, from a momentum observer.
//!
//! De Luca and Mattone, Sensorless robot collision detection and hybrid force/motion control, ICRA 2005. The momentum
//! of the links is p = H(theta) theta_dot, with the inertia matrix H and the joint angles theta. Its derivative is
//!
//! p_dot = R t + C^T theta_dot + g - friction + external torques.
//!
//! R is the matrix of the moment arms of the tendons, t are the tensions, C are the Coriolis terms, and g is the torque
//! of gravity. The residual r follows r_dot = K (external torques - r). It is computed without the acceleration of the
//! joints and without an inversion of H:
//!
//! r = K (p - integral of (R t + C^T theta_dot + g - friction + r)).
//!
//! The joint rates are the differences of the joint angles. Tensions, rates and the torque of gravity first pass a
//! low-pass filter with the bandwidth K. Without this filter, the noise of the rates would exceed the torques that must
//! be detected. All three signals need the same delay, because gravity changes while a finger moves or the hand turns.
//!
//! The tensions are measured between motors and joints, so the friction and the inertia of the motors do not matter.

use crate::model::configuration::ConfiguredFinger;
use crate::model::{LinkMomentum, Tendons};
use nalgebra::{Matrix3x4, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Joint rate from which the whole Coulomb friction of a joint is expected, rad/s. A step at zero rate would convert
/// the noise of the rates to torque.
const CREEP: f64 = 0.1;

/// The constant part of the observer.
#[derive(Clone, Debug)]
pub(super) struct MomentumObserver {
    /// K, 1/s.
    bandwidth: f64,
    /// R, cm.
    pub r: Matrix3x4<f64>,
    /// Coulomb friction of the joints, N cm.
    coulomb: Vector3<f64>,
    /// Viscous friction of the joints, N cm s/rad.
    viscous: Vector3<f64>,
}

/// The state of the observer.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct MomentumState {
    /// Joint angles of the last sample, rad.
    joints: Vector3<f64>,
    /// Tensions of the last sample, N.
    tensions: Vector4<f64>,
    /// Low-pass filtered tensions, N.
    filtered: Vector4<f64>,
    /// Low-pass filtered torque of gravity, N cm.
    pub weight: Vector3<f64>,
    /// Low-pass filtered joint rates, rad/s.
    pub rates: Vector3<f64>,
    /// p at the last sample, N cm s.
    momentum: Vector3<f64>,
    /// r, N cm.
    pub residual: Vector3<f64>,
    /// p_dot with the same low-pass filter as r, N cm.
    pub inertial: Vector3<f64>,
}

impl MomentumObserver {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        Self {
            bandwidth: finger.contact.bandwidth,
            r: tendons.r,
            coulomb: finger.friction.joint_coulomb.into(),
            viscous: finger.friction.joint_viscous.into(),
        }
    }

    /// Returns the state of a finger at rest at these joint angles, rad. Only these tensions, N, and the torque of
    /// gravity `weight`, N cm, act on the finger.
    pub fn start(&self, joints: &Vector3<f64>, tensions: &Vector4<f64>, weight: &Vector3<f64>) -> MomentumState {
        let (joints, tensions, weight) = (*joints, *tensions, *weight);
        MomentumState { joints, tensions, filtered: tensions, weight, ..MomentumState::default() }
    }

    /// Advances the residual to a sample with these joint angles, rad, and tensions, N. `links` has the unit N cm s^2.
    /// `weight` is the torque of gravity, N cm, and `elapsed` the time since the previous sample, s.
    pub fn advance(
        &self,
        state: &mut MomentumState,
        links: &LinkMomentum,
        weight: &Vector3<f64>,
        (joints, tensions): (&Vector3<f64>, &Vector4<f64>),
        elapsed: f64,
    ) {
        // The implicit Euler method. It is stable for any time between two samples.
        let keeps = 1.0 / (1.0 + self.bandwidth * elapsed);
        let passes = 1.0 - keeps;
        // The difference of the angles gives the rate in the middle between the two samples. The mean of the tensions
        // is their value at the same time.
        state.rates = state.rates * keeps + (joints - state.joints) * (self.bandwidth * keeps);
        state.filtered = state.filtered * keeps + (tensions + state.tensions) * (0.5 * passes);
        state.weight = state.weight * keeps + weight * passes;
        (state.joints, state.tensions) = (*joints, *tensions);
        let rates = &state.rates;
        let momentum = links.of(rates);
        let known = self.r * state.filtered + links.energy_gradient(rates) + state.weight - self.friction(rates);
        let gained = (momentum - state.momentum) * (self.bandwidth * keeps);
        state.inertial = state.inertial * keeps + gained;
        state.residual = state.residual * keeps + gained - known * passes;
        state.momentum = momentum;
    }

    fn friction(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let direction = rates.map(|rate| (rate * (1.0 / CREEP)).clamp(-1.0, 1.0));
        self.viscous.component_mul(rates) + self.coulomb.component_mul(&direction)
    }
}

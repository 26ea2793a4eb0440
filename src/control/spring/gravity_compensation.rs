//! Joint torques that hold the links against gravity.

use crate::model::LinkDynamics;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// tau = - sum of J_i^T m_i g over the centres of mass.
#[derive(Clone, Debug)]
pub(crate) struct GravityCompensation(Option<LinkDynamics>);

impl GravityCompensation {
    /// Constructs the compensation of `gravity`, m/s^2 in the finger's frame.
    pub fn new(finger: &ConfiguredFinger, gravity: &Vector3<f64>) -> Self {
        let wanted = finger.controller.gravity_compensation && *gravity != Vector3::zeros();
        let links = &finger.links;
        Self(wanted.then(|| LinkDynamics::new(finger.links(), links.masses, links.radii, *gravity)))
    }

    /// Returns the torques, N cm, at joint angles, rad.
    pub fn torques(&self, joints: &Vector3<f64>) -> Vector3<f64> {
        self.0.as_ref().map_or_else(Vector3::zeros, |links| links.gravity_torque(joints) * -100.0)
    }
}

//! The momentum of the links at one pose, and the derivatives of their kinetic energy.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The inertia matrix H(theta) and its derivatives, kg m^2.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct LinkMomentum {
    /// H(theta). Joint 0 is decoupled from the other joints.
    pub(super) inertia: Matrix3<f64>,
    /// Half the derivative of `inertia.m11`, the inertia about the axis of joint 0, with respect to theta_1.
    pub(super) by_1: f64,
    /// Half the derivative of `inertia.m11` with respect to theta_2.
    pub(super) by_2: f64,
    /// The negative of the derivative of `inertia.m23` with respect to theta_2. `inertia.m23` couples joints 1 and 2.
    pub(super) bend: f64,
}

impl LinkMomentum {
    /// Returns the same quantities in another unit: each one is multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        let Self { inertia, by_1, by_2, bend } = *self;
        Self { inertia: inertia * factor, by_1: by_1 * factor, by_2: by_2 * factor, bend: bend * factor }
    }

    /// Returns p = H(theta) theta_dot, N m s.
    pub fn of(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let h = &self.inertia;
        Vector3::new(h.m11 * rates.x, h.m22 * rates.y + h.m23 * rates.z, h.m23 * rates.y + h.m33 * rates.z)
    }

    /// Returns the derivative of the kinetic energy with respect to theta, N m. It equals C^T theta_dot, where C is
    /// the Coriolis matrix with H_dot = C + C^T. So p_dot equals this derivative plus the joint torques.
    pub fn energy_gradient(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        let squared = rates.x * rates.x;
        Vector3::new(0.0, self.by_1 * squared, self.by_2 * squared - self.bend * rates.y * (rates.y + rates.z))
    }
}

#[cfg(test)]
mod tests {
    use crate::model::LinkDynamics;
    use crate::model::configuration::ConfiguredFinger;
    use nalgebra::Vector3;

    /// Along a motion, the derivative of the momentum equals the joint torques H theta_dd + c plus the energy gradient.
    /// Here, c is the vector of the Coriolis and centrifugal torques.
    #[test]
    fn momentum_changes_by_the_torques_and_the_energy_gradient() {
        let finger = ConfiguredFinger::default();
        let dynamics = LinkDynamics::new(finger.links(), finger.links.masses, finger.links.radii, Vector3::zeros());
        let (theta, rate) = (Vector3::new(0.3, 0.7, 1.1), Vector3::new(2.0, -3.0, 4.0));
        let acceleration = Vector3::new(-10.0, 20.0, 30.0);
        let at = |time: f64| {
            let pose = theta + rate * time + acceleration * (0.5 * time * time);
            dynamics.momentum(&pose).of(&(rate + acceleration * time))
        };
        let step = 1e-5;
        let change = (at(step) - at(-step)) / (2.0 * step);
        let torques = dynamics.inertia(&theta) * acceleration + dynamics.coriolis(&theta, &rate);
        let expected = torques + dynamics.momentum(&theta).energy_gradient(&rate);
        assert!((change - expected).amax() < 1e-9 * change.amax().max(1.0), "{change} {expected}");
        let kinetic = |change: Vector3<f64>| dynamics.kinetic_energy(&(theta + change), &rate);
        let gradient = Vector3::from_fn(|joint, _| {
            let mut change = Vector3::zeros();
            change[joint] = step;
            (kinetic(change) - kinetic(-change)) / (2.0 * step)
        });
        assert!((gradient - dynamics.momentum(&theta).energy_gradient(&rate)).amax() < 1e-9, "{gradient}");
    }
}

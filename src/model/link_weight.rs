//! Torques of gravity on the joints, from the first moments of the links.
//!
//! The torques follow from the sum of mass times Jacobian over all centres of mass. The links are straight, so this sum
//! is the Jacobian of another finger, whose link lengths are the first moments.

use crate::model::Links;
use nalgebra::Vector3;

/// First moments of links 0, 1 and 2 about their joints, kg m. The moment of a link contains the masses that the link
/// carries at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkWeight([f64; 3]);

impl LinkWeight {
    /// Constructs the moments from the masses of the links and of the tip, kg.
    pub fn new(links: Links, [first, second, third, tip]: [f64; 4]) -> Self {
        let [l0, l1, l2] = links.0.map(|cm| cm * 0.01);
        let carried = third + tip;
        Self([l0 * (first / 2.0 + second + carried), l1 * (second / 2.0 + carried), l2 * (third / 2.0 + tip)])
    }

    /// Returns the torques, N m, that `gravity`, m/s^2 in the finger's frame, exerts on the joints at angles `theta`,
    /// rad.
    pub fn torques(&self, gravity: &Vector3<f64>, theta: &Vector3<f64>) -> Vector3<f64> {
        if *gravity == Vector3::zeros() {
            return Vector3::zeros();
        }
        let [l0, l1, l2] = self.0;
        let (s0, c0) = theta[0].sin_cos();
        let (s1, c1) = theta[1].sin_cos();
        let (s12, c12) = (theta[1] + theta[2]).sin_cos();
        let outward = gravity.x * s0 + gravity.z * c0;
        let last = -l2 * (s12 * outward + c12 * gravity.y);
        Vector3::new(
            (l0 + l1 * c1 + l2 * c12) * (gravity.x * c0 - gravity.z * s0),
            last - l1 * (s1 * outward + c1 * gravity.y),
            last,
        )
    }

    /// Returns the sum of mass times place over the centres of mass, kg m.
    pub fn moment(&self, theta: &Vector3<f64>) -> Vector3<f64> {
        Links(self.0).tip(theta)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    /// The torques are the sum of J^T m g over the centres of mass of the links and the tip. Each centre is the tip of
    /// a shorter finger.
    #[test]
    fn the_torques_are_those_of_the_centres_of_mass() {
        let finger = ConfiguredFinger::default();
        let (links, masses) = (finger.links(), finger.links.masses);
        let [l0, l1, l2] = links.0.map(|cm| cm * 0.01);
        let centres = [[l0 / 2.0, 0.0, 0.0], [l0, l1 / 2.0, 0.0], [l0, l1, l2 / 2.0], [l0, l1, l2]];
        let gravity = Vector3::new(3.0, -8.0, 5.0);
        for pose in [[0.0, 0.0, 0.0], [0.4, 0.7, 1.1], [-0.9, -0.3, 2.0]].map(Vector3::from) {
            let of = |(centre, mass)| Links(centre).jacobian(&pose).tr_mul(&gravity) * mass;
            let expected: Vector3<f64> = centres.into_iter().zip(masses).map(of).sum();
            let found = LinkWeight::new(links, masses).torques(&gravity, &pose);
            assert!((found - expected).amax() < 1e-14, "{found} {expected}");
        }
    }
}

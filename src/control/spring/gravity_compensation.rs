//! Joint torques that hold the links against gravity.

use crate::model::LinkWeight;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// Fastest change of the compensated gravity, m/s^3. Because of this limit, a step of gravity causes no jump in torque.
/// Gravity that turns once a second changes by 62 m/s^3.
const FASTEST: f64 = 2000.0;

/// tau = - sum of J_i^T m_i g over the centres of mass.
#[derive(Clone, Debug)]
pub(crate) struct GravityCompensation {
    weight: LinkWeight,
    /// Whether gravity is compensated.
    wanted: bool,
    /// Gravity for which the controller was constructed, m/s^2 in the finger's frame. It acts until the servo has
    /// another value.
    initial: Vector3<f64>,
    /// Whether `initial` is zero, as with the default of `hand.gravity`.
    weightless: bool,
    /// Largest change of gravity in a cycle, m/s^2.
    step: f64,
}

impl GravityCompensation {
    /// Constructs the compensation of `gravity`, m/s^2 in the finger's frame, at `rate`, Hz.
    pub fn new(finger: &ConfiguredFinger, gravity: &Vector3<f64>, rate: f64) -> Self {
        Self {
            weight: LinkWeight::new(finger.links(), finger.links.masses),
            wanted: finger.controller.gravity_compensation,
            initial: *gravity,
            weightless: *gravity == Vector3::zeros(),
            step: FASTEST / rate,
        }
    }

    /// Moves `gravity` toward `target` by at most the largest change of a cycle. Both are in m/s^2. The first value
    /// takes effect at once.
    pub fn approach(&self, gravity: &mut Option<Vector3<f64>>, target: &Vector3<f64>) {
        let now = gravity.get_or_insert(*target);
        if now != target {
            let way = *target - *now;
            let distance = way.norm();
            *now = if distance > self.step { *now + way * (self.step / distance) } else { *target };
        }
    }

    /// Returns the torques, N cm, that compensate gravity at joint angles, rad. `changed` is the gravity that has
    /// replaced `initial`, m/s^2.
    pub fn torques(&self, changed: &Option<Vector3<f64>>, joints: &Vector3<f64>) -> Vector3<f64> {
        if !self.wanted || (self.weightless && changed.is_none()) {
            return Vector3::zeros();
        }
        self.weight.torques(changed.as_ref().unwrap_or(&self.initial), joints) * -100.0
    }

    /// Returns the torques of gravity on the joints, N cm, whether they are compensated or not.
    pub fn weight(&self, changed: &Option<Vector3<f64>>, joints: &Vector3<f64>) -> Vector3<f64> {
        self.weight.torques(changed.as_ref().unwrap_or(&self.initial), joints) * 100.0
    }

    /// Returns whether the links have weight. `compensation` are the torques of [`GravityCompensation::torques`], N cm,
    /// which are zero if the weight is not compensated.
    pub fn weighs(&self, compensation: &Vector3<f64>, changed: &Option<Vector3<f64>>, joints: &Vector3<f64>) -> bool {
        *compensation != Vector3::zeros() || (!self.wanted && self.weight(changed, joints) != Vector3::zeros())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_gravity_is_spread_over_cycles_and_a_turn_is_followed_at_once() {
        let down = Vector3::new(0.0, 9.81, 0.0);
        let compensation = GravityCompensation::new(&ConfiguredFinger::default(), &down, 1000.0);
        let mut gravity = None;
        compensation.approach(&mut gravity, &down);
        assert_eq!(gravity, Some(down));
        for cycle in 1..=10 {
            compensation.approach(&mut gravity, &-down);
            let expected = 9.81 - f64::from(cycle) * 2.0;
            assert!(gravity.is_some_and(|now| (now.y - expected.max(-9.81)).abs() < 1e-12), "{gravity:?}");
        }
        assert_eq!(gravity, Some(-down));
        let turned = Vector3::new(9.81 * 0.1f64.sin(), -9.81 * 0.1f64.cos(), 0.0);
        compensation.approach(&mut gravity, &turned);
        assert_eq!(gravity, Some(turned));
    }

    #[test]
    fn links_have_weight_whether_it_is_compensated_or_not() {
        let joints = Vector3::new(0.1, 0.5, 0.8);
        for compensated in [true, false] {
            let mut finger = ConfiguredFinger::default();
            finger.controller.gravity_compensation = compensated;
            for gravity in [Vector3::zeros(), Vector3::new(0.0, 9.81, 0.0)] {
                let compensation = GravityCompensation::new(&finger, &gravity, 1000.0);
                let torques = compensation.torques(&None, &joints);
                assert_eq!(compensation.weighs(&torques, &None, &joints), gravity.y > 0.0, "{compensated} {gravity}");
            }
        }
    }
}

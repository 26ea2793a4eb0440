//! Checks that a step of the simulation is short enough for the links of a finger and for the friction of its joints.

use super::ranges::unusable;
use crate::model::LinkDynamics;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use crate::model::physics::{STEP, STOP_DAMPING, STOP_STIFFNESS};
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// The simulation is stable if this multiple of M is larger than h^2 K + 2 h C in every direction. M is the inertia of
/// the joints, K their stiffness, C their damping, and h the step.
///
/// A step computes v' = v - h M^-1 (C v + K x) and x' = x + h v'. A motion x_n = z^n u satisfies
/// m (z - 1)^2 + h c (z - 1) + h^2 k z = 0 with m = u* M u, c = u* C u and k = u* K u. No z is outside the unit circle
/// if h^2 k + 2 h c <= 4 m.
const STABLE: f64 = 4.0;

/// Largest factor on the stiffness of the tendons. If a tendon sticks on its pulleys, only its section between pulleys
/// and joint can stretch. This section has a fifth of the compliance, so the tendon is five times as stiff. The factor
/// 2 allows for motion of the motor: the energy of a stretch, k (a - b)^2 / 2, is at most k a^2 + k b^2, where a and b
/// are the travels of the two ends of the tendon.
const STIFFEST: f64 = 2.0 * 5.0;

/// Number of equal intervals into which the range of a joint between its stops is divided. The inertia is computed at
/// the ends of all intervals.
const INTERVALS: u8 = 8;

impl ConfiguredFinger {
    /// Checks that the links of a simulated finger are heavy enough for its stops and tendons, and for the viscous
    /// friction of its joints. A finger at a port is not checked: its simulation values are usually the defaults, which
    /// need not suit its `geometry.links`.
    pub(super) fn check_simulated_links(&self) -> Result<(), Unusable> {
        let (true, Ok(tendons)) = (self.simulated(), self.true_tendons()) else { return Ok(()) };
        let simulation = &self.simulation;
        // The moment arms are in cm. N/cm times cm^2 is N cm, which the factor 0.01 converts to N m.
        let stiffness = Vector4::from(simulation.tendon_stiffness) * (0.01 * STIFFEST * (1.0 + simulation.hardening));
        let of_tendons = tendons.r * Matrix4::from_diagonal(&stiffness) * tendons.r.transpose();
        let of_stops = Matrix3::from_diagonal_element(STOP_STIFFNESS * STEP * STEP + 2.0 * STEP * STOP_DAMPING);
        let without_friction = of_tendons * (STEP * STEP) + of_stops;
        let friction = Vector3::from(simulation.joint_viscous_friction);
        let inertias = self.simulated_inertias();
        let stable =
            |strain: Matrix3<f64>| inertias.iter().all(|inertia| (inertia * STABLE - strain).cholesky().is_some());
        let strain = without_friction + Matrix3::from_diagonal(&(friction * (2.0 * STEP)));
        if stable(strain) {
            return Ok(());
        }
        let largest = |strain| inertias.iter().map(|inertia| share(inertia, strain)).fold(0.0, f64::max);
        let used = largest(&without_friction);
        if used >= STABLE {
            // Raising all masses by a factor raises the inertia by this factor. The held object is one of these masses,
            // so the text names it too.
            let held = if simulation.held_mass > 0.0 { " and a simulation.held_mass" } else { "" };
            let reason = format!(
                "are too small for the step of the simulation, which would diverge at a joint's stop: masses{held} \
                 {:.2} times as large are stable. Raise them, or check simulation.link_radii and geometry.links",
                1.01 * largest(&strain) / STABLE
            );
            return unusable("simulation.masses", reason);
        }
        let lightest = inertias.iter().map(|inertia| inertia.symmetric_eigenvalues().min()).fold(f64::MAX, f64::min);
        let reason = format!(
            "{} N m s/rad is too much for the step of the simulation, which would diverge: {:.2e} N m s/rad is stable. \
             Lower it, or raise simulation.masses",
            friction.max(),
            0.99 * (STABLE - used) * lightest / (2.0 * STEP)
        );
        unusable("simulation.joint_viscous_friction", reason)
    }

    /// Returns the inertia matrices of the simulated finger in poses between its stops, kg m^2. The inertia does not
    /// depend on the angle of joint 0. In most fingers it is smallest where joints 1 and 2 are at ends of their ranges.
    fn simulated_inertias(&self) -> Vec<Matrix3<f64>> {
        let simulation = &self.simulation;
        let [link_0, link_1, link_2, tip] = simulation.masses;
        let masses = [link_0, link_1, link_2, tip + simulation.held_mass];
        let dynamics = LinkDynamics::new(self.links(), masses, simulation.link_radii, Vector3::zeros());
        let ((low, high), margin) = (self.joint_limits(), simulation.stop_margin_degrees.to_radians());
        let angle = |joint: usize, interval: u8| {
            let (low, high) = (low[joint] - margin, high[joint] + margin);
            low + (high - low) * f64::from(interval) / f64::from(INTERVALS)
        };
        let ends = || 0..=INTERVALS;
        let poses = ends().flat_map(|first| ends().map(move |second| (first, second)));
        poses.map(|(first, second)| dynamics.inertia(&Vector3::new(0.0, angle(1, first), angle(2, second)))).collect()
    }
}

/// Returns the largest eigenvalue of M^-1 S, or infinity if rounding makes M singular. M is `inertia`, and S is
/// `strain`, the sum h^2 K + 2 h C.
fn share(inertia: &Matrix3<f64>, strain: &Matrix3<f64>) -> f64 {
    let inverse = inertia.cholesky().and_then(|factor| factor.l().try_inverse());
    inverse.map_or(f64::INFINITY, |inverse| (inverse * strain * inverse.transpose()).symmetric_eigenvalues().max())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(change: fn(&mut ConfiguredFinger)) -> Result<(), &'static str> {
        let mut finger = ConfiguredFinger::default();
        change(&mut finger);
        finger.check().map_err(|unusable| unusable.key)
    }

    #[test]
    fn the_viscous_friction_of_a_joint_must_suit_the_step() {
        assert_eq!(refused(|finger| finger.simulation.joint_viscous_friction = [0.08; 3]), Ok(()));
        let key = Err("simulation.joint_viscous_friction");
        assert_eq!(refused(|finger| finger.simulation.joint_viscous_friction = [0.1; 3]), key);
        assert_eq!(refused(|finger| finger.simulation.joint_viscous_friction[2] = 0.5), key);
        let at_a_port = |finger: &mut ConfiguredFinger| {
            finger.port = "/dev/ttyUSB0".into();
            finger.simulation.joint_viscous_friction = [0.5; 3];
        };
        assert_eq!(refused(at_a_port), Ok(()));
    }

    #[test]
    fn links_must_not_be_too_light_for_the_step() {
        let key = Err("simulation.masses");
        assert_eq!(refused(|finger| finger.simulation.masses = [0.018, 0.0135, 0.0075, 0.0015]), Ok(()));
        assert_eq!(refused(|finger| finger.simulation.masses = [0.012, 0.009, 0.005, 0.001]), key);
        assert_eq!(refused(|finger| finger.simulation.masses = [1e-6; 4]), key);
        assert_eq!(refused(|finger| finger.geometry.links = [0.1; 3]), key);
    }

    #[test]
    fn the_refusal_names_values_that_are_stable() {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.joint_viscous_friction = [0.5; 3];
        let reason = finger.check().expect_err("refused").reason;
        let (_, stable) = reason.split_once("diverge: ").expect("a value");
        let (stable, _) = stable.split_once(' ').expect("a unit");
        finger.simulation.joint_viscous_friction = [stable.parse().expect("a number"); 3];
        assert_eq!(finger.check(), Ok(()));
        finger.simulation.masses = finger.simulation.masses.map(|mass| 0.01 * mass);
        let reason = finger.check().expect_err("refused").reason;
        let (_, ratio) = reason.split_once("masses ").expect("a ratio");
        let ratio: f64 = ratio.split_once(' ').expect("a word").0.parse().expect("a number");
        finger.simulation.masses = finger.simulation.masses.map(|mass| ratio * mass);
        assert_eq!(finger.check(), Ok(()));
    }

    #[test]
    fn the_refusal_of_light_links_with_a_held_object_names_its_mass() {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.joint_viscous_friction = [0.0; 3];
        finger.simulation.masses = finger.simulation.masses.map(|mass| 0.001 * mass);
        finger.simulation.held_mass = 1e-4;
        let reason = finger.check().expect_err("refused").reason;
        let (_, ratio) = reason.split_once("masses and a simulation.held_mass ").expect("both masses");
        let ratio: f64 = ratio.split_once(' ').expect("a word").0.parse().expect("a number");
        finger.simulation.masses = finger.simulation.masses.map(|mass| ratio * mass);
        assert_ne!(finger.check(), Ok(()), "raising the masses of the links alone is not enough");
        finger.simulation.held_mass *= ratio;
        assert_eq!(finger.check(), Ok(()));
    }
}

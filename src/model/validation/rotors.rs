//! Checks that the oscillation of a rotor on its tendon is slow enough for a simulation with the controller's model.

use super::ranges::unusable;
use crate::model::configuration::{ConfiguredFinger, Unusable};

/// Step of the simulation, s.
const STEP: f64 = 1e-4;

impl ConfiguredFinger {
    /// Checks the angular frequency of each rotor on its tendon, from `motor.inertia` and `tendon.stiffness`: its
    /// product with the step of the simulation must not exceed 1. A simulation with these values diverges above 2.
    pub(super) fn check_rotors(&self) -> Result<(), Unusable> {
        for motor in 0..4 {
            // N/m and m.
            let (stiffness, radius) = (self.tendon.stiffness[motor] * 100.0, self.geometry.motor_radius[motor] * 0.01);
            let least = stiffness * (radius * STEP).powi(2);
            if self.motor.inertia[motor] < least {
                let reason = format!(
                    "{} kg m^2 of motor {} is too little for its tendon.stiffness and geometry.motor_radius: it must \
                     be at least {least:.3e}. Check these three values",
                    self.motor.inertia[motor],
                    motor + 1
                );
                return unusable("motor.inertia", reason);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotor_must_not_be_too_light_for_its_tendon() {
        let mut finger = ConfiguredFinger::default();
        finger.motor.inertia = [1e-8; 4];
        finger.tendon.stiffness = [3000.0; 4];
        assert_eq!(finger.check_rotors(), Ok(()));
        finger.geometry.motor_radius[2] = 1.0;
        assert_eq!(finger.check_rotors().map_err(|unusable| unusable.key), Err("motor.inertia"));
    }
}

//! Checks that the oscillation of a rotor on its tendon is slow enough for a simulation.

use super::ranges::unusable;
use crate::model::configuration::{ConfiguredFinger, Unusable};

/// Step of the simulation, s.
const STEP: f64 = 1e-4;

impl ConfiguredFinger {
    /// Checks the rotors and tendons of the controller's model, with which the tools simulate every finger.
    pub(super) fn check_rotors(&self) -> Result<(), Unusable> {
        let keys = ("motor.inertia", "tendon.stiffness");
        self.check_oscillation(keys, &self.motor.inertia, &self.tendon.stiffness)
    }

    /// Checks the rotors and tendons of a simulated finger. A finger at a port is not checked, because it has the
    /// default values, which need not suit its `geometry.motor_radius`.
    pub(super) fn check_simulated_rotors(&self) -> Result<(), Unusable> {
        if !self.simulated() {
            return Ok(());
        }
        let keys = ("simulation.rotor_inertia", "simulation.tendon_stiffness");
        self.check_oscillation(keys, &self.simulation.rotor_inertia, &self.simulation.tendon_stiffness)
    }

    /// Checks the angular frequency of each rotor on its tendon: its product with the step of the simulation must not
    /// exceed 1. A simulation with these values diverges above 2.
    fn check_oscillation(
        &self,
        (key, key_of_stiffness): (&'static str, &str),
        inertia: &[f64; 4],
        stiffness: &[f64; 4],
    ) -> Result<(), Unusable> {
        for motor in 0..4 {
            // N/m and m.
            let (stiffness, radius) = (stiffness[motor] * 100.0, self.geometry.motor_radius[motor] * 0.01);
            let least = stiffness * (radius * STEP).powi(2);
            if inertia[motor] < least {
                let reason = format!(
                    "{} kg m^2 of motor {} is too little for its {key_of_stiffness} and geometry.motor_radius: it must \
                     be at least {least:.3e}. Check these three values",
                    inertia[motor],
                    motor + 1
                );
                return unusable(key, reason);
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

    #[test]
    fn a_simulated_rotor_must_not_be_too_light_for_its_simulated_tendon() {
        let mut finger = ConfiguredFinger::default();
        finger.simulation.tendon_stiffness = [3000.0; 4];
        finger.geometry.motor_radius = [0.2; 4];
        assert_eq!(finger.check(), Ok(()));
        finger.simulation.rotor_inertia[1] = 1e-8;
        assert_eq!(finger.check().map_err(|unusable| unusable.key), Err("simulation.rotor_inertia"));
        finger.port = "/dev/ttyUSB0".into();
        assert_eq!(finger.check(), Ok(()));
    }
}

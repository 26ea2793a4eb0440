//! Checks that a step of the simulation is short enough for the rotors of a finger.

use super::ranges::unusable;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use crate::model::physics::{inertia_for, largest_viscous_friction, least_inertia};

impl ConfiguredFinger {
    /// Checks the rotors and tendons of the controller's model, with which the tools simulate every finger.
    pub(super) fn check_rotors(&self) -> Result<(), Unusable> {
        let motor = &self.motor;
        let keys = ["motor.inertia", "tendon.stiffness", "motor.viscous_friction"];
        self.check_step(keys, [&motor.inertia, &self.tendon.stiffness, &motor.viscous_friction])
    }

    /// Checks the rotors and tendons of a simulated finger. A finger at a port is not checked: its simulation values
    /// are usually the defaults, which need not suit its `geometry.motor_radius`.
    pub(super) fn check_simulated_rotors(&self) -> Result<(), Unusable> {
        if !self.simulated() {
            return Ok(());
        }
        let simulation = &self.simulation;
        let keys = ["simulation.rotor_inertia", "simulation.tendon_stiffness", "simulation.motor_viscous_friction"];
        let values = [&simulation.rotor_inertia, &simulation.tendon_stiffness, &simulation.motor_viscous_friction];
        self.check_step(keys, values)
    }

    /// Checks that h^2 k r^2 + 2 h b is at most the inertia of each rotor. h is the step, k the stiffness of the
    /// tendon, r the radius of the motor, and b the viscous friction. A simulation of a rotor diverges if the sum
    /// exceeds four times the inertia. If the sum is at most the inertia, the observers of state feedback can also
    /// follow the motion of the rotor. `keys` are the keys of inertia, stiffness and friction, and `values` are their
    /// values.
    fn check_step(&self, keys: [&'static str; 3], values: [&[f64; 4]; 3]) -> Result<(), Unusable> {
        let ([key, key_of_stiffness, key_of_viscous], [inertia, stiffness, viscous]) = (keys, values);
        for motor in 0..4 {
            let least = least_inertia(stiffness[motor], self.geometry.motor_radius[motor]);
            // The margin covers the rounding of the printed value.
            let advised = 1.01 * inertia_for(viscous[motor], least);
            if inertia[motor] < least {
                let reason = format!(
                    "{} kg m^2 of motor {} is too little for its {key_of_stiffness}, {key_of_viscous} and \
                     geometry.motor_radius: the computed motion of the rotor would be wrong. The inertia must be at \
                     least {advised:.3e}. Check these four values",
                    inertia[motor],
                    motor + 1
                );
                return unusable(key, reason);
            }
            let most = largest_viscous_friction(inertia[motor], least);
            if viscous[motor] > most {
                let reason = format!(
                    "{} N m s/rad of motor {} is too much for its {key}: the computed motion of the rotor would be \
                     wrong. The friction must be at most {:.2e}, or the inertia at least {advised:.3e} kg m^2. Check \
                     both values",
                    viscous[motor],
                    motor + 1,
                    0.99 * most
                );
                return unusable(key_of_viscous, reason);
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
    fn the_value_that_the_error_names_is_accepted() {
        for stiffness in [1000.0, 3000.0, 3001.0, 7777.0] {
            for radius in [0.313, 1.0, 1.7] {
                let mut finger = ConfiguredFinger::default();
                finger.motor.inertia = [1e-12; 4];
                finger.tendon.stiffness = [stiffness; 4];
                finger.geometry.motor_radius = [radius; 4];
                let reason = finger.check_rotors().expect_err("too light").reason;
                let named = reason.split("at least ").nth(1).and_then(|rest| rest.split(". ").next()).expect("a value");
                finger.motor.inertia = [named.parse().expect("a number"); 4];
                assert_eq!(finger.check_rotors(), Ok(()), "{reason}");
            }
        }
    }

    #[test]
    fn a_rotor_must_not_be_too_viscous_for_its_inertia() {
        let refused = |change: fn(&mut ConfiguredFinger)| {
            let mut finger = ConfiguredFinger::default();
            change(&mut finger);
            finger.check().map_err(|unusable| unusable.key)
        };
        assert_eq!(refused(|finger| finger.motor.viscous_friction = [2e-3; 4]), Ok(()));
        assert_eq!(refused(|finger| finger.motor.viscous_friction[3] = 1.0), Err("motor.viscous_friction"));
        let key = Err("simulation.motor_viscous_friction");
        assert_eq!(refused(|finger| finger.simulation.motor_viscous_friction[3] = 1.0), key);
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

//! Checks that the motors can hold the pretension of their tendons.

use super::ranges::unusable;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Vector4;

impl ConfiguredFinger {
    /// Checks that the torque limit and the continuous torque of every motor suffice to pull its tendon to the
    /// pretension against friction. Otherwise the finger could give no joint torque, or its motors would overheat at
    /// rest.
    pub(super) fn check_pretension(&self) -> Result<(), Unusable> {
        let Ok(tendons) = self.tendons() else { return Ok(()) };
        let past_conduit = Vector4::from(self.friction.conduit).add_scalar(1.0);
        let pull = tendons.pretension(self.tendon.minimum).component_mul(&past_conduit);
        let needed = pull.component_mul(&tendons.radius) + Vector4::from(self.friction.motor_coulomb);
        let motor = &self.motor;
        let limits = [("motor.torque_limit", motor.torque_limit), ("motor.continuous_torque", motor.continuous_torque)];
        for (key, limits) in limits {
            if let Some(motor) = (0..4).find(|&motor| needed[motor] >= limits[motor]) {
                let reason = format!(
                    "motor {} cannot hold the pretension of its tendon against friction, because it needs {:.3} N cm: \
                     raise the limit, or lower tendon.minimum",
                    motor + 1,
                    needed[motor]
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
    fn a_motor_must_hold_its_pretension_against_friction() {
        assert_eq!(ConfiguredFinger::default().check(), Ok(()));
        let refused = |change: fn(&mut ConfiguredFinger)| {
            let mut finger = ConfiguredFinger::default();
            change(&mut finger);
            finger.check().map_err(|unusable| unusable.key)
        };
        assert_eq!(refused(|finger| finger.motor.torque_limit = [0.3; 4]), Err("motor.torque_limit"));
        assert_eq!(refused(|finger| finger.motor.continuous_torque[2] = 0.3), Err("motor.continuous_torque"));
        let sufficient = |finger: &mut ConfiguredFinger| {
            finger.motor.torque_limit = [0.6; 4];
            finger.motor.continuous_torque = [0.6; 4];
        };
        assert_eq!(refused(sufficient), Ok(()));
        assert_eq!(
            refused(|finger| {
                finger.motor.torque_limit = [0.6; 4];
                finger.friction.conduit = [0.5; 4];
            }),
            Err("motor.torque_limit")
        );
    }
}

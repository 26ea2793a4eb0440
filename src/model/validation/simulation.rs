//! Checks of the parameters of a simulated finger.

use super::ranges::{each, unusable, within};
use crate::model::configuration::{ConfiguredFinger, Surface, Unusable};

impl ConfiguredFinger {
    /// Checks every value of `[finger.simulation]`.
    pub(super) fn check_simulation(&self) -> Result<(), Unusable> {
        let simulation = &self.simulation;
        each("simulation.masses", &simulation.masses, 1e-6, 10.0, "kg")?;
        each("simulation.link_radii", &simulation.link_radii, 1e-4, 1.0, "m")?;
        each("simulation.joint_viscous_friction", &simulation.joint_viscous_friction, 0.0, 1.0, "N m s/rad")?;
        each("simulation.joint_coulomb_friction", &simulation.joint_coulomb_friction, 0.0, 1.0, "N m")?;
        each("simulation.tendon_stiffness", &simulation.tendon_stiffness, 1.0, 3000.0, "N/cm")?;
        each("simulation.rotor_inertia", &simulation.rotor_inertia, 1e-8, 1.0, "kg m^2")?;
        each("simulation.motor_viscous_friction", &simulation.motor_viscous_friction, 0.0, 1.0, "N m s/rad")?;
        self.check_simulated_rotors()?;
        each("simulation.motor_coulomb_friction", &simulation.motor_coulomb_friction, 0.0, 1.0, "N m")?;
        within("simulation.shaft_friction", simulation.shaft_friction, 0.0, 1.0, "")?;
        within("simulation.stiction_ratio", simulation.stiction_ratio, 1.0, 10.0, "")?;
        within("simulation.held_mass", simulation.held_mass, 0.0, 10.0, "kg")?;
        self.check_simulated_tendons()?;
        each("simulation.motor_constant_ratio", &simulation.motor_constant_ratio, 0.0, 10.0, "")?;
        within("simulation.torque_ripple", simulation.torque_ripple, 0.0, 1.0, "")?;
        within("simulation.amplifier_lag_ms", simulation.amplifier_lag_ms, 0.0, 100.0, "ms")?;
        within("simulation.command_delay_ms", simulation.command_delay_ms, 0.0, 100.0, "ms")?;
        each("simulation.gauge_gain_ratio", &simulation.gauge_gain_ratio, 0.0, 10.0, "")?;
        each("simulation.gauge_offset", &simulation.gauge_offset, -100.0, 100.0, "N")?;
        within("simulation.gauge_bandwidth", simulation.gauge_bandwidth, 0.0, 1e5, "Hz")?;
        within("simulation.gauge_noise", simulation.gauge_noise, 0.0, 100.0, "N")?;
        within("simulation.stop_margin_degrees", simulation.stop_margin_degrees, 0.0, 90.0, "degrees")?;
        each("simulation.start_degrees", &simulation.start_degrees, -180.0, 180.0, "degrees")?;
        self.check_simulated_links()?;
        check_surface(simulation.surface.as_ref())
    }

    fn check_simulated_tendons(&self) -> Result<(), Unusable> {
        let simulation = &self.simulation;
        within("simulation.conduit_friction", simulation.conduit_friction, 0.0, 1.0, "")?;
        within("simulation.pulley_friction", simulation.pulley_friction, 0.0, 1.0, "")?;
        within("simulation.hardening", simulation.hardening, 0.0, 0.9, "")?;
        within("simulation.creep", simulation.creep, 0.0, 1.0, "")?;
        within("simulation.creep_time", simulation.creep_time, 0.1, 1e6, "s")?;
        simulation
            .moment_arm_ratio
            .iter()
            .try_for_each(|row| each("simulation.moment_arm_ratio", row, 0.5, 2.0, ""))?;
        // geometry.r itself has passed its check. So the remedy in the text of the error, to check the signs of R, does
        // not apply here.
        self.true_tendons().map(|_| ()).or_else(|_| {
            let reason = "with these moment arms, the tendons of the simulated finger cannot all pull while the joints \
                          are at rest: set ratios that are nearer to 1";
            unusable("simulation.moment_arm_ratio", reason.into())
        })
    }
}

fn check_surface(surface: Option<&Surface>) -> Result<(), Unusable> {
    match surface {
        None => Ok(()),
        Some(&Surface::Wall { point, normal, stiffness }) => {
            each("simulation.surface.wall.point", &point, -1000.0, 1000.0, "cm")?;
            if let Some(part) = normal.iter().find(|part| !part.is_finite()) {
                let reason = format!("the wall's normal has the component {part}: set finite numbers");
                return unusable("simulation.surface.wall.normal", reason);
            }
            if normal.iter().all(|&part| part == 0.0) {
                let reason = "the wall's normal is zero: set its direction";
                return unusable("simulation.surface.wall.normal", reason.into());
            }
            within("simulation.surface.wall.stiffness", stiffness, 0.0, 1e4, "N/cm")
        }
        Some(&Surface::Ball { centre, radius, stiffness }) => {
            each("simulation.surface.ball.centre", &centre, -1000.0, 1000.0, "cm")?;
            within("simulation.surface.ball.radius", radius, 1e-3, 1000.0, "cm")?;
            within("simulation.surface.ball.stiffness", stiffness, 0.0, 1e4, "N/cm")
        }
    }
}

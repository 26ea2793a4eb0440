//! Combines the results of all phases.

use super::Identification;
use super::joint_friction::FreeFinger;
use super::moment_arms::{MomentArmsFound, SIGNIFICANT};
use super::motor_friction::MotorFrictionFound;
use super::tendon_stiffness::{StiffnessFound, UNCERTAIN};
use crate::calibration::findings::{Identified, IdentifiedArms, Tolerances};
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::control::monitors::SHARE_OF_FRICTION;
use crate::model::configuration::GaugeReference;
use crate::model::physics::{LARGEST_INERTIA, SMALLEST_INERTIA, resolves_rotor};
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// The configured inertia of a rotor stays if it differs from the measured one by at most this part. A lag of 1 ms of
/// the amplifiers or gauges changes the measured inertia by about as much.
const SIGNIFICANT_INERTIA: f64 = 0.05;
/// Largest configurable tolerance of moment arms and gauges.
const LARGEST_TOLERANCE: f64 = 0.5;

impl Identification {
    /// Returns all results. The configured reference determines the mean of the gauge gains.
    pub(super) fn identified(
        &self,
        elasticity: &StiffnessFound,
        instruments: &Instruments,
    ) -> Result<Identified, Obstacle> {
        let measured = self.moment_arms.map(|arms| arms.solve(instruments, elasticity, &self.stops, self.stops_known));
        let (mut free, mut motors, mut moment_arms) = (self.free, self.motors, None);
        if let Some(arms) = measured.transpose()?.flatten() {
            let corrected = self.with_moment_arms(&arms, instruments)?;
            free = self.joint_friction.solve(&corrected)?;
            motors = self.motor_friction.solve(&free.gains)?;
            // The elasticity is in the scale of the gauges, but t_min is in the scale of the reference. The division
            // converts the pretension to the scale of the gauges.
            let pretension = corrected.pretension / self.scale(&motors);
            let encoder_zero = self.encoder_zero(&arms, elasticity, instruments, &pretension);
            moment_arms = Some(IdentifiedArms { r: arms.r, encoder_zero });
        }
        // The stiffness of the tendons was found with the gauge gains of the first evaluation.
        let ratio = free.gains.component_div(&self.free.gains);
        let found = Identified {
            tendon_stiffness: elasticity.stiffness.component_mul(&ratio),
            stiffness_tolerance: elasticity.tolerance,
            travel_residual: elasticity.residual,
            tolerances: self.tolerances(&free, &motors, elasticity, instruments),
            gauge_gain: free.gains,
            motor_coulomb: motors.coulomb.component_mul(&instruments.radius),
            conduit: motors.conduit,
            pulley: free.pulley,
            motor_ratio: motors.ratio.map(f64::recip),
            joint_coulomb: free.coulomb,
            joint_viscous: free.viscous,
            rotor_inertia: None,
            moment_arms,
        };
        let found = match self.reference {
            GaugeReference::Gauges => found,
            GaugeReference::Motors => found.scaled(self.scale(&motors)),
        };
        Ok(Identified { rotor_inertia: self.other_inertia(&found.tendon_stiffness, &instruments.radius), ..found })
    }

    /// Returns the inertia of the rotors, kg m^2, if one differs from its configured value. A rotor keeps its
    /// configured inertia if its inertia could not be measured, or if a configuration must not contain the measured
    /// inertia. `stiffness` is the identified stiffness of the tendons, N/cm, and `radius` is in cm.
    fn other_inertia(&self, stiffness: &Vector4<f64>, radius: &Vector4<f64>) -> Option<Vector4<f64>> {
        let (configured, viscous) = &self.rotors;
        let inertia = Vector4::from_fn(|motor, _| {
            let differs = |found: &f64| (found / configured[motor] - 1.0).abs() > SIGNIFICANT_INERTIA;
            let usable = |found: &f64| {
                (SMALLEST_INERTIA..=LARGEST_INERTIA).contains(found)
                    && resolves_rotor(*found, stiffness[motor], radius[motor], viscous[motor])
            };
            self.rotor_inertia[motor].filter(differs).filter(usable).unwrap_or(configured[motor])
        });
        (inertia != *configured).then_some(inertia)
    }

    /// Returns the factor from the tensions that the gauges show to those of the configured reference.
    fn scale(&self, motors: &MotorFrictionFound) -> f64 {
        match self.reference {
            GaugeReference::Gauges => 1.0,
            GaugeReference::Motors => motors.ratio.mean(),
        }
    }

    /// Returns the errors that the monitors must tolerate.
    fn tolerances(
        &self,
        free: &FreeFinger,
        motors: &MotorFrictionFound,
        elasticity: &StiffnessFound,
        instruments: &Instruments,
    ) -> Tolerances {
        // The friction of a conduit is a pull of the motor divided by a tension at the gauge, so it depends on the
        // scale of the gauges. The other terms are ratios of values in one scale.
        let conduit = motors.conduit / self.scale(motors);
        let friction = (conduit + free.pulley).max().max(elasticity.rubbing / SHARE_OF_FRICTION);
        let moment_arms = self.moment_arms.map(|arms| {
            let uncertainty = arms.uncertainty(instruments, elasticity, &self.stops);
            (SIGNIFICANT + uncertainty).min(LARGEST_TOLERANCE)
        });
        Tolerances {
            friction: (friction + UNCERTAIN + elasticity.unexplained).min(1.0),
            moment_arms,
            gauges: (UNCERTAIN + free.gain_uncertainty).min(LARGEST_TOLERANCE),
        }
    }

    /// Returns the instruments with other moment arms.
    fn with_moment_arms(&self, arms: &MomentArmsFound, instruments: &Instruments) -> Result<Instruments, Obstacle> {
        let what = "the moment arms of the tendons";
        let impossible = |_| Obstacle::Implausible { part: Part::Finger, what, value: f64::NAN };
        let tendons = Tendons::new(arms.r, instruments.radius, self.ghost).map_err(impossible)?;
        let mut corrected = instruments.clone();
        corrected.pretension = tendons.pretension(instruments.minimum);
        corrected.tendons = tendons;
        Ok(corrected)
    }

    /// Returns the `encoder.zero` that corrects the joint angles for the moment arms `arms` and for their pretension
    /// `pretension`, N in the scale of the gauges. The angles are then right at the stops, if the angles of the stops
    /// are known. Otherwise they are right in the pose in which the encoders were zeroed.
    fn encoder_zero(
        &self,
        arms: &MomentArmsFound,
        elasticity: &StiffnessFound,
        instruments: &Instruments,
        pretension: &Vector4<f64>,
    ) -> [i32; 4] {
        let stretched = |tensions: &Vector4<f64>| elasticity.stretch(tensions, &Vector4::zeros());
        let too_far = if self.stops_known {
            // `at_zero` is measured from the configured zero and does not include any stretch. The zeros of the
            // encoders are defined at the pretension, so the stretch by the pretension is added. A counter rounds down
            // to whole counts, so its count is half a count too low on average.
            arms.at_zero + stretched(pretension) + instruments.cm_per_count() * 0.5
        } else {
            let change = instruments.tendons.r - arms.r;
            change.tr_mul(&self.pose) + stretched(pretension) - stretched(&instruments.pretension)
        };
        let counts = too_far.component_div(&instruments.cm_per_count());
        std::array::from_fn(|motor| self.zero[motor].wrapping_add(counts[motor].round() as i32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    /// Returns the inertia that replaces the configured 6e-7 kg m^2 of all rotors if the inertia `measured` was found.
    fn replaced(measured: [Option<f64>; 4], stiffness: f64) -> Option<[f64; 4]> {
        let finger = ConfiguredFinger::default();
        let mut identification = Identification::new(&finger);
        identification.rotor_inertia = measured;
        let radius = Vector4::from(finger.geometry.motor_radius);
        identification.other_inertia(&Vector4::repeat(stiffness), &radius).map(Into::into)
    }

    #[test]
    fn only_an_inertia_that_differs_and_is_usable_replaces_the_configured_one() {
        assert_eq!(replaced([None, Some(6.2e-7), Some(5.8e-7), None], 300.0), None);
        let some = [Some(9e-7), Some(6.2e-7), None, Some(3e-7)];
        assert_eq!(replaced(some, 300.0), Some([9e-7, 6e-7, 6e-7, 3e-7]));
        assert_eq!(replaced([Some(1e-9), Some(2.0), Some(f64::NAN), None], 300.0), None);
        // The step of a simulation is too long for such a light rotor on such a stiff tendon.
        assert_eq!(replaced([Some(1e-8); 4], 1e5), None);
    }

    #[test]
    fn the_tolerated_friction_is_in_the_scale_of_the_reference() {
        let mut finger = ConfiguredFinger::default();
        let instruments = Instruments::new(&finger, 1000.0).expect("usable");
        let (coulomb, conduit, ratio) = (Vector4::zeros(), Vector4::repeat(0.1), Vector4::repeat(0.8));
        let motors = MotorFrictionFound { coulomb, conduit, ratio };
        for (reference, friction) in [(GaugeReference::Gauges, 0.1), (GaugeReference::Motors, 0.1 / 0.8)] {
            finger.gauge.reference = reference;
            let identification = Identification::new(&finger);
            let elasticity = StiffnessFound::default();
            let found = identification.tolerances(&identification.free, &motors, &elasticity, &instruments).friction;
            assert!((found - friction - UNCERTAIN).abs() < 1e-12, "{found} instead of {friction} + {UNCERTAIN}");
        }
    }
}

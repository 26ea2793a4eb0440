//! Determines the friction of the motors. The commanded pull of a motor is larger than the tension while the motor
//! winds its tendon in, and smaller while it lets its tendon out.
//!
//! u = a t + s (C + mu t). u is the commanded pull, t the tension, C the Coulomb friction, and mu the friction of the
//! conduit. s is +1 while winding in and -1 while letting out. a is the mean of the ratios of u to t in these two
//! directions. Only motors that turn steadily and fast contribute: at rest and at low speeds static friction is larger
//! than C.

use super::least_squares::LeastSquares;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::{Vector3, Vector4};

/// Smallest tendon speed of a motor that contributes, as a part of its largest speed in all motions.
const TURNING: f64 = 0.7;
/// Plausible ratios of the commanded pull to the tension.
const RATIOS: std::ops::Range<f64> = 0.2..5.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct MotorFriction {
    fits: [LeastSquares<3>; 4],
}

/// The friction of all four motors.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotorFrictionFound {
    /// C, N at the tendon.
    pub coulomb: Vector4<f64>,
    /// mu.
    pub conduit: Vector4<f64>,
    /// Commanded pull divided by the tension, without friction.
    pub ratio: Vector4<f64>,
}

impl MotorFriction {
    pub fn new() -> Self {
        Self { fits: [LeastSquares::new(); 4] }
    }

    /// Adds a sample of a steady motion. `speeds` are the speeds of the tendons toward their motors, cm/s. `fastest`
    /// are the largest speeds of the tendons in all motions, cm/s.
    pub fn add(&mut self, instruments: &Instruments, sample: &Sample, speeds: &Vector4<f64>, fastest: &Vector4<f64>) {
        let tensions = instruments.tensions(sample.feedback);
        let pulls = sample.report.motor_torques.component_div(&instruments.signed_radius);
        for motor in 0..4 {
            if speeds[motor].abs() > TURNING * fastest[motor] {
                let (sign, tension) = (speeds[motor].signum(), tensions[motor]);
                self.fits[motor].add(&Vector3::new(tension, sign, sign * tension), pulls[motor]);
            }
        }
    }

    /// Returns the friction. The true tensions are the measured ones multiplied by `gains`.
    pub fn solve(&self, gains: &Vector4<f64>) -> Result<MotorFrictionFound, Obstacle> {
        let mut friction =
            MotorFrictionFound { coulomb: Vector4::zeros(), conduit: Vector4::zeros(), ratio: Vector4::zeros() };
        for (motor, fit) in self.fits.iter().enumerate() {
            let implausible = |what, value| Obstacle::Implausible { part: Part::motor(motor), what, value };
            let (found, _) = fit.solve().ok_or(implausible("the friction", f64::NAN))?;
            let [a, coulomb, conduit]: [f64; 3] = found.into();
            let (a, conduit) = (a / gains[motor], conduit / gains[motor]);
            if !RATIOS.contains(&a) {
                return Err(implausible("the ratio of commanded pull to tension", a));
            }
            // If the friction of the conduit exceeded `a`, the ratio below would be the root of a negative number.
            if conduit.abs() >= a {
                return Err(implausible("the friction of the conduit", conduit));
            }
            friction.coulomb[motor] = coulomb.max(0.0);
            friction.conduit[motor] = conduit.max(0.0);
            // A conduit multiplies the pull by a factor of about 1 + mu while winding in, and divides it by the same
            // factor while letting out. So the geometric mean of both pulls is free of friction.
            friction.ratio[motor] = ((a + conduit) * (a - conduit)).sqrt();
        }
        Ok(friction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Solves for motors whose only friction is that of their conduits. The commanded pull is 1 + `conduit` times the
    /// tension while winding in, and 1 - `conduit` times the tension while letting out.
    fn solved(conduit: f64) -> Result<MotorFrictionFound, Obstacle> {
        let mut friction = MotorFriction::new();
        for fit in &mut friction.fits {
            for (tension, sign) in [(5.0, 1.0), (5.0, -1.0), (12.0, 1.0), (12.0, -1.0), (20.0, 1.0), (20.0, -1.0)] {
                fit.add(&Vector3::new(tension, sign, sign * tension), tension + sign * conduit * tension);
            }
        }
        friction.solve(&Vector4::repeat(1.0))
    }

    #[test]
    fn a_friction_that_no_conduit_has_is_refused() {
        let found = solved(0.1).expect("plausible");
        assert!(found.ratio.add_scalar(-0.99f64.sqrt()).amax() < 1e-9, "{}", found.ratio);
        for conduit in [1.5, -1.5] {
            let found = solved(conduit);
            assert!(matches!(found, Err(Obstacle::Implausible { .. })), "{found:?}");
        }
    }
}

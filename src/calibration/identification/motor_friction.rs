//! Determines the friction of the motors. The commanded pull of a motor is larger than the tension while the motor
//! winds its tendon in, and smaller while it lets its tendon out.
//!
//! u = a t + s (C + mu t). u is the commanded pull. s is +1 while winding in and -1 while letting out.

use super::least_squares::LeastSquares;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::model::Part;
use nalgebra::{Vector3, Vector4};

/// Time constant of each filter on the travel, s.
const SMOOTHING: f64 = 0.03;
/// A motor counts as turning above this speed, cm/s at the tendon.
const TURNING: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
pub(super) struct MotorFriction {
    fits: [LeastSquares<3>; 4],
    /// Travel after one and after two low-pass filters, cm. Their difference over the time constant is the speed.
    smooth: Option<(Vector4<f64>, Vector4<f64>)>,
}

/// C (N at the tendon), mu and a, each for all four motors.
pub(super) type Friction = [Vector4<f64>; 3];

impl MotorFriction {
    pub fn new() -> Self {
        Self { fits: [LeastSquares::new(); 4], smooth: None }
    }

    pub fn add(&mut self, instruments: &Instruments, sample: &Sample) {
        let travel = instruments.travel(sample.feedback);
        let (once, twice) = self.smooth.get_or_insert((travel, travel));
        let gain = (instruments.period / SMOOTHING).min(1.0);
        *once += (travel - *once) * gain;
        *twice += (*once - *twice) * gain;
        let speeds = (*once - *twice) / SMOOTHING;
        let tensions = instruments.tensions(sample.feedback);
        let pulls = sample.report.motor_torques.component_div(&instruments.signed_radius);
        for motor in 0..4 {
            if speeds[motor].abs() > TURNING {
                let (sign, tension) = (speeds[motor].signum(), tensions[motor]);
                self.fits[motor].add(&Vector3::new(tension, sign, sign * tension), pulls[motor]);
            }
        }
    }

    pub fn solve(&self) -> Result<Friction, Obstacle> {
        let mut friction = [Vector4::zeros(); 3];
        for (motor, fit) in self.fits.iter().enumerate() {
            let implausible = |what, value| Obstacle::Implausible { part: Part::motor(motor), what, value };
            let (found, _) = fit.solve().ok_or(implausible("the friction", f64::NAN))?;
            let [a, coulomb, conduit]: [f64; 3] = found.into();
            if !(0.2..5.0).contains(&a) {
                return Err(implausible("the ratio of commanded pull to tension", a));
            }
            if coulomb < -0.5 || conduit < -0.1 {
                return Err(implausible("the friction, N,", coulomb));
            }
            friction[0][motor] = coulomb.max(0.0);
            friction[1][motor] = conduit.max(0.0);
            friction[2][motor] = a;
        }
        Ok(friction)
    }
}

//! The figures of a finger: what it has, and what it needs.

use super::Wanted;
use super::mechanics::Mechanics;
use crate::failure::Failure;
use serde::Serialize;
use std::f64::consts::TAU;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::Vector4;

/// Largest Kx at which a finger is stable at 1000 Hz, with some margin, as a fraction of the smallest stiffness that
/// its tip has while the motors are locked.
const STABLE_PART: f64 = 0.7;

/// Each motor oscillates on its tendon. This is the least number of servo cycles in one period of the fastest of these
/// oscillations.
const CYCLES: f64 = 20.0;

/// Least bandwidth of a current loop, as a multiple of the rate of the servo.
const CURRENT_LOOP: f64 = 1.0;

/// Range of a gauge as a multiple of the largest tension: a gauge at the end of its range is a fault.
const GAUGE_RANGE: f64 = 1.2;

/// One line of the result.
#[derive(Serialize)]
pub struct Figure {
    /// What is computed.
    pub what: &'static str,
    /// The value of the configured hand, or none if the configuration does not contain it.
    pub has: Option<f64>,
    /// The value that is necessary, or none if there is no limit.
    pub needs: Option<f64>,
    /// The unit of both.
    pub unit: &'static str,
    /// Whether the configured value suffices.
    pub sufficient: bool,
    /// What to change if the configured value does not suffice, or what to look for in a data sheet.
    pub advice: &'static str,
}

impl Figure {
    /// The configured value must be at least `needs`.
    fn least(what: &'static str, has: f64, needs: f64, unit: &'static str, advice: &'static str) -> Self {
        Self { what, has: Some(has), needs: Some(needs), unit, sufficient: has >= needs, advice }
    }

    /// The configured value must be at most `needs`.
    fn most(what: &'static str, has: f64, needs: f64, unit: &'static str, advice: &'static str) -> Self {
        Self { what, has: Some(has), needs: Some(needs), unit, sufficient: has <= needs, advice }
    }

    /// A requirement that has no configured value. It helps to choose a part.
    fn choose(what: &'static str, needs: f64, unit: &'static str, advice: &'static str) -> Self {
        Self { what, has: None, needs: Some(needs), unit, sufficient: true, advice }
    }
}

/// A finger, and the data from which its figures are computed.
struct Finger<'a> {
    configured: &'a ConfiguredFinger,
    mechanics: Mechanics,
    /// Radius of each drum, cm.
    radius: Vector4<f64>,
}

/// Returns the figures of a finger. The worst tendon determines each figure.
pub fn figures(configured: &ConfiguredFinger, rate: f64, wanted: &Wanted) -> Result<Vec<Figure>, Failure> {
    let radius = Vector4::from(configured.geometry.motor_radius);
    let finger = Finger { configured, mechanics: Mechanics::new(configured)?, radius };
    let mut figures = finger.forces(wanted.force)?;
    figures.extend(finger.drives(wanted.speed, rate));
    figures.extend(finger.sensors(wanted));
    figures.extend(finger.tendons(wanted, rate));
    Ok(figures)
}

impl Finger<'_> {
    /// Returns the tension that each motor produces with `torque` when it pulls against its friction, N (eq. 22).
    fn tension(&self, torque: &[f64; 4]) -> Vector4<f64> {
        let friction = &self.configured.friction;
        Vector4::from_fn(|motor, _| {
            (torque[motor] - friction.motor_coulomb[motor]) / (self.radius[motor] * (1.0 + friction.conduit[motor]))
        })
    }

    fn forces(&self, wanted: f64) -> Result<Vec<Figure>, Failure> {
        let (motor, maximum) = (&self.configured.motor, self.configured.tendon.maximum);
        let most = self.tension(&motor.torque_limit);
        let peak = most.map(|tension| tension.min(maximum));
        let continuous = self.tension(&motor.continuous_torque).inf(&peak);
        Ok(vec![
            Figure::least(
                "force of the tip, continuous",
                self.mechanics.force(&continuous),
                wanted,
                "N",
                "motors with more continuous torque, a smaller motor radius, or a lower finger.tendon.minimum",
            ),
            Figure::least(
                "force of the tip, for some seconds",
                self.mechanics.force(&peak),
                wanted,
                "N",
                "a higher finger.tendon.maximum and motors with more torque",
            ),
            Figure::least(
                "tension that the weakest motor can make",
                most.min(),
                maximum,
                "N",
                "motors with more torque, a smaller motor radius, or a lower finger.tendon.maximum",
            ),
            Figure::choose(
                "tension of the tendons at the required force",
                self.mechanics.tensions(wanted)?.max(),
                "N",
                "tendons that break at ten times this tension",
            ),
        ])
    }

    fn drives(&self, speed: f64, rate: f64) -> Vec<Figure> {
        let motor = &self.configured.motor;
        let speed = self.mechanics.tendon_speed(speed).component_div(&self.radius);
        let constant = Vector4::from(motor.torque_constant);
        let current = |torque: &[f64; 4]| Vector4::from(*torque).component_div(&constant).max();
        vec![
            Figure::choose(
                "speed of a motor",
                speed.max() * 60.0 / TAU,
                "rpm",
                "motors that reach this speed while they pull with finger.tendon.minimum",
            ),
            Figure::choose(
                "voltage that turns a motor at that speed",
                // The factor converts N cm/A to V s/rad.
                speed.component_mul(&constant).max() * 1e-2,
                "V",
                "a supply above this voltage plus winding resistance times current",
            ),
            Figure::choose(
                "continuous current of a driver",
                current(&motor.continuous_torque),
                "A",
                "drivers that regulate the current; four for each finger",
            ),
            Figure::choose(
                "peak current of a driver",
                current(&motor.torque_limit),
                "A",
                "drivers and a supply for this current",
            ),
            Figure::choose(
                "bandwidth of a current loop",
                CURRENT_LOOP * rate,
                "Hz",
                "a driver whose data sheet gives at least this bandwidth with the inductance of the motor",
            ),
        ]
    }

    fn sensors(&self, wanted: &Wanted) -> Vec<Figure> {
        let counts = Vector4::from(self.configured.encoder.counts_per_revolution.map(f64::from));
        let travel = self.radius.component_div(&counts) * TAU;
        let gauge = Vector4::from(self.configured.gauge.newton_per_count.map(f64::abs));
        vec![
            Figure::most(
                "displacement of the tip by one encoder count",
                self.mechanics.tip_by_travel(&travel) * 1e4,
                wanted.resolution,
                "um",
                "encoders with more counts, or a smaller motor radius",
            ),
            Figure::most(
                "displacement of the tip by one gauge count",
                self.mechanics.tip_force_by_tension(&gauge) / wanted.stiffness * 1e4,
                wanted.resolution,
                "um",
                "a converter with more bits, or gauges with a smaller range",
            ),
            Figure::choose(
                "range of a gauge",
                GAUGE_RANGE * self.configured.tendon.maximum,
                "N",
                "a gauge and an amplifier that reach this tension within the converter's range",
            ),
        ]
    }

    fn tendons(&self, wanted: &Wanted, rate: f64) -> Vec<Figure> {
        let stiffness = Vector4::from(self.configured.tendon.stiffness);
        let oscillation = Vector4::from_fn(|motor, _| {
            // `mass` is the equivalent mass of the rotor at its tendon, kg. The factor 1e2 converts N/cm to N/m.
            let mass = self.configured.motor.inertia[motor] / (self.radius[motor] * 1e-2).powi(2);
            (stiffness[motor] * 1e2 / mass).sqrt() / TAU
        });
        vec![
            Figure::least(
                "stiffness that the tendons permit",
                STABLE_PART * self.mechanics.locked_stiffness(),
                wanted.stiffness,
                "N/cm",
                "stiffer tendons (shorter, thicker, steel), or larger pulleys at the joints",
            ),
            Figure::choose(
                "E A of a tendon",
                stiffness.max() * wanted.tendon_length,
                "N",
                "a tendon with this product of modulus and cross-section, so that it is as stiff as configured",
            ),
            Figure::least(
                "rate of the servo",
                rate,
                CYCLES * oscillation.max(),
                "Hz",
                "a higher hand.rate, or rotors with more inertia",
            ),
        ]
    }
}

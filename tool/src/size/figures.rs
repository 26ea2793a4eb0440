//! The figures of a finger: what it has, and what it needs.

use super::Wanted;
use super::mechanics::Mechanics;
use crate::failure::Failure;
use serde::Serialize;
use std::f64::consts::TAU;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::nalgebra::Vector4;

/// Part of the stiffness with locked motors up to which a finger is stable at 1000 Hz, with some margin.
const STABLE_PART: f64 = 0.7;

/// Least number of cycles in a period of the slowest oscillation of a motor on its tendon.
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
    /// What to change if it does not, or what to look for in a data sheet.
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

    /// A value for the choice of a part that the configuration does not describe.
    fn choose(what: &'static str, needs: f64, unit: &'static str, advice: &'static str) -> Self {
        Self { what, has: None, needs: Some(needs), unit, sufficient: true, advice }
    }
}

/// Returns the figures of a finger. The worst tendon determines each.
pub fn figures(finger: &ConfiguredFinger, rate: f64, wanted: &Wanted) -> Result<Vec<Figure>, Failure> {
    let mechanics = Mechanics::new(finger)?;
    let radius = Vector4::from(finger.geometry.motor_radius);
    let friction = &finger.friction;
    // The tension that a motor torque can hold against its friction, eq. 22.
    let tension = |torque: &[f64; 4]| {
        Vector4::from_fn(|motor, _| {
            (torque[motor] - friction.motor_coulomb[motor]) / (radius[motor] * (1.0 + friction.conduit[motor]))
        })
    };
    let peak = tension(&finger.motor.torque_limit).map(|tension| tension.min(finger.tendon.maximum));
    let continuous = tension(&finger.motor.continuous_torque).inf(&peak);
    let speed = mechanics.tendon_speed(wanted.speed).component_div(&radius);
    let counts = Vector4::from(finger.encoder.counts_per_revolution.map(f64::from));
    let travel = radius.component_div(&counts) * TAU;
    let gauge = Vector4::from(finger.gauge.newton_per_count.map(f64::abs));
    let locked = STABLE_PART * mechanics.locked_stiffness();
    let stiffness = Vector4::from(finger.tendon.stiffness);
    let oscillation = Vector4::from_fn(|motor, _| {
        // N/cm to N/m, and the mass of the rotor at its tendon, kg.
        let mass = finger.motor.inertia[motor] / (radius[motor] * 1e-2).powi(2);
        (stiffness[motor] * 1e2 / mass).sqrt() / TAU
    });
    let constant = Vector4::from(finger.motor.torque_constant);
    let current = |torque: &[f64; 4]| Vector4::from(*torque).component_div(&constant);
    let lowest = tension(&finger.motor.torque_limit).min();
    Ok(vec![
        Figure::least(
            "force of the tip, for any time",
            mechanics.force(&continuous),
            wanted.force,
            "N",
            "motors with more continuous torque, a smaller motor radius, or less finger.tendon.minimum",
        ),
        Figure::least(
            "force of the tip, for some seconds",
            mechanics.force(&peak),
            wanted.force,
            "N",
            "a higher finger.tendon.maximum and motors with more torque",
        ),
        Figure::least(
            "tension that the weakest motor can make",
            lowest,
            finger.tendon.maximum,
            "N",
            "motors with more torque, a smaller motor radius, or a lower finger.tendon.maximum",
        ),
        Figure::choose(
            "tension of the tendons at that force",
            mechanics.tensions(wanted.force)?.max(),
            "N",
            "tendons that break at ten times this tension",
        ),
        Figure::choose(
            "speed of a motor",
            speed.max() * 60.0 / TAU,
            "rpm",
            "motors with this speed at the torque of the lowest tension",
        ),
        Figure::choose(
            "voltage that turns a motor at that speed",
            speed.component_mul(&constant).max() * 1e-2,
            "V",
            "a supply above this voltage plus winding resistance times current",
        ),
        Figure::choose(
            "continuous current of a driver",
            current(&finger.motor.continuous_torque).max(),
            "A",
            "drivers that regulate the current; four for each finger",
        ),
        Figure::choose(
            "peak current of a driver",
            current(&finger.motor.torque_limit).max(),
            "A",
            "drivers and a supply for this current",
        ),
        Figure::choose(
            "bandwidth of a current loop",
            CURRENT_LOOP * rate,
            "Hz",
            "a driver whose data sheet gives at least this bandwidth with the inductance of the motor",
        ),
        Figure::most(
            "displacement of the tip by one encoder count",
            mechanics.tip_by_travel(&travel) * 1e4,
            wanted.resolution,
            "um",
            "encoders with more counts, or a smaller motor radius",
        ),
        Figure::most(
            "displacement of the tip by one gauge count",
            mechanics.tip_force_by_tension(&gauge) / wanted.stiffness * 1e4,
            wanted.resolution,
            "um",
            "a converter with more bits, or gauges with a smaller range",
        ),
        Figure::choose(
            "range of a gauge",
            GAUGE_RANGE * finger.tendon.maximum,
            "N",
            "a gauge and an amplifier that reach this tension within the converter's range",
        ),
        Figure::least(
            "stiffness that the tendons permit",
            locked,
            wanted.stiffness,
            "N/cm",
            "stiffer tendons (shorter, thicker, steel), or larger pulleys at the joints",
        ),
        Figure::choose(
            "E A of a tendon",
            stiffness.max() * wanted.tendon_length,
            "N",
            "a tendon with this product of modulus and cross-section, for finger.tendon.stiffness",
        ),
        Figure::least(
            "rate of the servo",
            rate,
            CYCLES * oscillation.max(),
            "Hz",
            "a higher hand.rate, or rotors with more inertia",
        ),
    ])
}

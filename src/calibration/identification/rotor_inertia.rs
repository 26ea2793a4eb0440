//! Determines the inertia of the rotors from an oscillation of the tensions at two frequencies.
//!
//! At each frequency w the Fourier coefficients of pull P, tension T and motor travel X are known. Newton's law for a
//! rotor whose mass at the tendon is m = J / r^2 gives
//!
//! Re[(a_0 T - P) X*] / |X|^2 = m w^2 - k
//!
//! a_0 is the ratio of the commanded pull to the tension, without friction. Friction is in phase with the speed, so it
//! is not in this equation. k is a stiffness that acts on the rotor without changing the tension at the gauge: a tendon
//! that sticks in its conduit is stretched between the motor and the gauge, and the ripple of the torque acts like a
//! spring too. The difference between the two frequencies eliminates k. A rotor with a delayed torque seems to have
//! another inertia: up to 7 % less with a dead time of 1 ms, and up to 5 % more with a lag of 1 ms.
//!
//! P is the commanded pull, and a_0 T is the tension in the scale of the commanded pull. So J is the inertia divided by
//! the ratio of the true torque to the commanded one. The controller computes with commanded torques, and needs this
//! value.

use nalgebra::Vector4;

/// Smallest amplitude of a motor that is evaluated, counts of its encoder.
const LEAST_COUNTS: f64 = 4.0;
/// Largest plausible k, as a part of m w^2 at the higher frequency. A motor that sticks seems to have a large k.
const LARGEST_REST: f64 = 0.5;

/// Sums of a signal times the cosine and the sine of the phase.
#[derive(Clone, Copy, Debug, Default)]
struct Harmonic {
    cos: Vector4<f64>,
    sin: Vector4<f64>,
}

impl Harmonic {
    fn add(&mut self, phase: f64, value: &Vector4<f64>) {
        let (sin, cos) = phase.sin_cos();
        self.cos += value * cos;
        self.sin += value * sin;
    }

    fn size(&self) -> Vector4<f64> {
        self.cos.zip_map(&self.sin, f64::hypot)
    }

    /// Returns Re[self other*].
    fn in_phase_with(&self, other: &Self) -> Vector4<f64> {
        self.cos.component_mul(&other.cos) + self.sin.component_mul(&other.sin)
    }

    /// Returns the harmonic of a signal that holds every value for a cycle, in which the phase rises by `step`, rad.
    fn held(&self, step: f64) -> Self {
        let half = 0.5 * step;
        let (sin, cos) = half.sin_cos();
        let size = sin / half;
        Self { cos: (self.cos * cos - self.sin * sin) * size, sin: (self.sin * cos + self.cos * sin) * size }
    }
}

/// Whole periods of an oscillation.
#[derive(Clone, Copy, Debug)]
pub(super) struct Oscillation {
    /// Change of the phase in a cycle, rad.
    step: f64,
    samples: f64,
    pull: Harmonic,
    tension: Harmonic,
    travel: Harmonic,
}

impl Oscillation {
    pub fn new(step: f64) -> Self {
        let none = Harmonic::default();
        Self { step, samples: 0.0, pull: none, tension: none, travel: none }
    }

    /// Adds the changes of pull, N, tension, N, and travel, cm, since the previous sample. The pull of a sample is the
    /// one that is commanded from this sample to the next one. The motion of the finger adds a trend to the values. To
    /// their changes it adds only a constant, which the sums over whole periods eliminate.
    pub fn add(&mut self, phase: f64, changes: &[Vector4<f64>; 3]) {
        self.samples += 1.0;
        for (harmonic, change) in [&mut self.pull, &mut self.tension, &mut self.travel].into_iter().zip(changes) {
            harmonic.add(phase, change);
        }
    }

    /// Returns the amplitude of the travel of every motor, cm.
    pub fn travel(&self) -> Vector4<f64> {
        self.travel.size() * self.scale()
    }

    /// Returns the amplitude of every tension, N.
    pub fn tension(&self) -> Vector4<f64> {
        self.tension.size() * self.scale()
    }

    /// Returns the factor from the sum of the changes to the amplitude of the values.
    fn scale(&self) -> f64 {
        1.0 / (self.samples.max(1.0) * (0.5 * self.step).sin())
    }

    /// Returns m w^2 - k, N/cm. `ratio` is the ratio a_0 of the commanded pull to the tension.
    fn stiffness(&self, ratio: &Vector4<f64>) -> Vector4<f64> {
        let tension = self.tension.in_phase_with(&self.travel).component_mul(ratio);
        let pull = self.pull.held(self.step).in_phase_with(&self.travel);
        (tension - pull).component_div(&self.travel.in_phase_with(&self.travel))
    }
}

/// Constants of the four motors, for the conversion of an oscillation to an inertia.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motors {
    /// Commanded pull divided by the tension, without friction.
    pub ratio: Vector4<f64>,
    /// cm of tendon per radian.
    pub radius: Vector4<f64>,
    /// cm of tendon per count of the encoder.
    pub count: Vector4<f64>,
}

/// Returns the inertia of every rotor, kg m^2, from oscillations at a higher and a lower frequency. A motor that hardly
/// turned, or whose motion the equation does not explain, has none. `period` is that of the servo, s.
pub(super) fn inertia(oscillations: &[Oscillation; 2], motors: &Motors, period: f64) -> [Option<f64>; 4] {
    let [high, low] = oscillations.map(|oscillation| oscillation.stiffness(&motors.ratio));
    let [fast, slow] = oscillations.map(|oscillation| (oscillation.step / period).powi(2));
    let travel = oscillations[0].travel().inf(&oscillations[1].travel());
    std::array::from_fn(|motor| {
        // N s^2/cm, which is 100 kg.
        let mass = (high[motor] - low[motor]) / (fast - slow);
        let rest = mass * fast - high[motor];
        let turned = travel[motor] >= LEAST_COUNTS * motors.count[motor];
        let explained = mass > 0.0 && rest.abs() <= LARGEST_REST * mass * fast;
        // The radius is in cm: 100 kg cm^2 is 0.01 kg m^2.
        (turned && explained).then(|| 0.01 * mass * motors.radius[motor].powi(2))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const PERIOD: f64 = 1e-3;
    /// Radius, cm, and inertia, kg m^2.
    const RADIUS: f64 = 0.0475;
    const INERTIA: f64 = 6e-7;

    /// A motor whose travel is a sine with the amplitude `amplitude`, cm. `hidden` is the stiffness that the gauge does
    /// not see, N/cm. `torque` is the true torque divided by the commanded one.
    #[derive(Clone, Copy)]
    struct Motor {
        amplitude: f64,
        friction: f64,
        viscous: f64,
        hidden: f64,
        torque: f64,
    }

    const MOTOR: Motor = Motor { amplitude: 0.01, friction: 3.0, viscous: 0.5, hidden: 0.0, torque: 1.0 };

    impl Motor {
        /// Returns the commanded pull, N, at a time, s.
        fn pull(&self, w: f64, time: f64) -> f64 {
            let (travel, speed) = (self.amplitude * (w * time).sin(), self.amplitude * w * (w * time).cos());
            let mass = 100.0 * INERTIA / RADIUS.powi(2);
            let force = (300.0 + self.hidden - mass * w * w) * travel;
            (14.0 + force + self.viscous * speed + self.friction * speed.signum()) / self.torque
        }

        fn oscillation(&self, cycles: usize) -> Oscillation {
            let step = TAU / cycles as f64;
            let w = step / PERIOD;
            let mut oscillation = Oscillation::new(step);
            let mut last = None;
            for cycle in 0..=40 * cycles {
                let time = cycle as f64 * PERIOD;
                // The pull is averaged over a cycle, and the average is held for this cycle. Both reduce the first
                // harmonic by `factor`, and their shifts of the phase cancel.
                let half = 0.5 * step;
                let factor = half / half.sin();
                let mean =
                    (0..50).map(|part| self.pull(w, time + (f64::from(part) + 0.5) / 50.0 * PERIOD)).sum::<f64>();
                let noise = 0.05 * ((cycle * 7919 % 101) as f64 - 50.0) / 50.0;
                let travel = self.amplitude * (w * time).sin();
                let count = TAU * RADIUS / 2000.0;
                // The finger moves during the oscillation.
                let trend = 0.5 * time;
                let values = [
                    14.0 + (mean / 50.0 - 14.0) * factor * factor + trend,
                    14.0 + 300.0 * travel + noise + trend,
                    3.0 + ((travel + 0.3 * trend) / count).floor() * count,
                ]
                .map(Vector4::repeat);
                if let Some(last) = last.replace(values) {
                    let last: [Vector4<f64>; 3] = last;
                    oscillation.add(step * cycle as f64, &std::array::from_fn(|value| values[value] - last[value]));
                }
            }
            oscillation
        }

        fn found(&self) -> Option<f64> {
            let motors = Motors {
                ratio: Vector4::repeat(self.torque.recip()),
                radius: Vector4::repeat(RADIUS),
                count: Vector4::repeat(TAU * RADIUS / 2000.0),
            };
            let found = inertia(&[self.oscillation(17), self.oscillation(25)], &motors, PERIOD)[0];
            found.map(|found| found * self.torque / INERTIA)
        }
    }

    #[test]
    fn friction_noise_and_hidden_stiffness_do_not_change_the_inertia() {
        let (without, stiff) = (Motor { friction: 0.0, viscous: 0.0, ..MOTOR }, Motor { hidden: 150.0, ..MOTOR });
        for motor in [MOTOR, without, stiff, Motor { hidden: -150.0, ..MOTOR }, Motor { friction: 9.0, ..MOTOR }] {
            let found = motor.found().expect("an inertia");
            assert!((found - 1.0).abs() < 0.02, "{found}");
        }
    }

    #[test]
    fn the_inertia_is_relative_to_the_commanded_torque() {
        for torque in [0.8, 1.25] {
            let found = Motor { torque, ..MOTOR }.found().expect("an inertia");
            assert!((found - 1.0).abs() < 0.02, "{found}");
        }
    }

    #[test]
    fn a_pull_that_is_not_held_gives_a_wrong_inertia() {
        let oscillation = Motor { friction: 20.0, ..MOTOR }.oscillation(17);
        let (held, not) = (oscillation.pull.held(oscillation.step), oscillation.pull);
        let of = |pull: &Harmonic| pull.in_phase_with(&oscillation.travel)[0];
        assert!((of(&held) / of(&not) - 1.0).abs() > 0.05, "{} {}", of(&held), of(&not));
    }

    #[test]
    fn a_motor_that_does_not_turn_has_no_inertia() {
        assert_eq!(Motor { amplitude: 1e-4, ..MOTOR }.found(), None);
    }

    /// A stuck motor only twists its shaft. The encoder shows this small travel, and the pull does not reach the gauge,
    /// so the motor looks like a stiff spring.
    #[test]
    fn a_motor_that_seems_to_be_a_spring_has_no_inertia() {
        assert_eq!(Motor { hidden: 5000.0, ..MOTOR }.found(), None);
    }
}

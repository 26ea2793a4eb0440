//! Finds the signs of motors, encoders and gauges without prior knowledge.
//!
//! First every motor receives a short push, which shows whether command and count have the same sign. From then on each
//! motor can be held in place, whichever direction pulls its tendon. Then one motor after the other turns back and
//! forth while the others are held. The tensions rise while it turns in the direction that tightens its tendon, and
//! vanish while it turns in the other. A free finger shares every pull among all its tendons (its tensions stay along
//! the null vector of R), so every gauge responds to every motor.

mod pushes;
mod sweep;
mod sweeping;
mod wiring;

use super::findings::{Findings, Signs};
use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::step::{Progress, Sample, Step, Stepped};
use crate::control::signals::{Activity, Feedback};
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use std::ops::ControlFlow::{Break, Continue};
use sweep::Sweep;
use wiring::Wiring;

/// Stiffness with which a motor is held, N/cm.
const HOLD: f64 = 150.0;
/// Damping of a held motor, N s/cm.
const DAMPING: f64 = 2.0;
/// Largest pull of a held motor, in multiples of t_min (`tendon.minimum`).
const STRONGEST_HOLD: f64 = 1.2;
/// Corner frequency of the speed filter, rad/s.
const SPEED_CORNER: f64 = 1000.0;

#[derive(Clone, Debug)]
pub(super) struct SignSearch {
    /// cm at the tendon per count, without sign.
    cm_per_count: Vector4<f64>,
    /// Scales of the gauges, N per count, without sign.
    newton_per_count: Vector4<f64>,
    /// Counts at the beginning, from which every distance is measured.
    start: Option<[i32; 4]>,
    /// Distances in the previous cycle, cm, measured from the counts at the beginning.
    last: Vector4<f64>,
    /// Low-pass filtered speeds, cm/s.
    speed: Vector4<f64>,
    /// Position at which every motor is held, cm in the direction of rising count.
    target: Vector4<f64>,
    /// +1 if a positive command raises the count, -1 if it lowers the count, 0 while this is unknown.
    agrees: [f64; 4],
    /// +1 if a rising count tightens the tendon, -1 if a falling count does, 0 while this is unknown.
    tightens: [f64; 4],
    /// Sign of each gauge, or 0 until it has responded.
    gauges: [f64; 4],
    /// The motor that is pushed or swept, 0 to 3.
    motor: usize,
    phase: Phase,
}

// The servo does not use the heap, so every phase has the size of the largest one.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug)]
enum Phase {
    Rest {
        seconds: f64,
    },
    Push {
        seconds: f64,
        /// N at the tendon.
        push: f64,
        /// Distances before the push, cm, measured from the counts at the beginning.
        from: Vector4<f64>,
    },
    Pause {
        seconds: f64,
    },
    Sweep(Sweep),
    /// Every sign is known, except that of a gauge that has never responded.
    Wiring(Wiring),
}

impl SignSearch {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let cm_per_count = |motor: usize| {
            finger.geometry.motor_radius[motor] * std::f64::consts::TAU
                / f64::from(finger.encoder.counts_per_revolution[motor])
        };
        Self {
            cm_per_count: Vector4::from_fn(|motor, _| cm_per_count(motor)),
            newton_per_count: Vector4::from(finger.gauge.newton_per_count.map(f64::abs)),
            start: None,
            last: Vector4::zeros(),
            speed: Vector4::zeros(),
            target: Vector4::zeros(),
            agrees: [0.0; 4],
            tightens: [0.0; 4],
            gauges: [0.0; 4],
            motor: 0,
            phase: Phase::Rest { seconds: 0.0 },
        }
    }

    /// Runs one cycle of the current phase. After a rest every motor is pushed, then every motor sweeps, then the
    /// wiring is checked.
    pub fn step(&mut self, instruments: &Instruments, sample: &Sample) -> Stepped {
        let travel = self.measure(instruments, sample.feedback);
        let progress = Progress { step: Step::TryingMotors, part: self.part() };
        let torques = match self.phase {
            Phase::Rest { seconds } => self.rest(seconds, instruments, &travel),
            Phase::Push { seconds, push, from } => self.push_motor(seconds, push, &from, instruments, &travel)?,
            Phase::Pause { seconds } => self.pause(seconds, instruments, &travel),
            Phase::Sweep(sweep) => self.sweep_motor(sweep, instruments, sample, &travel)?,
            Phase::Wiring(wiring) => match self.check_wiring(wiring, instruments, sample, &travel)? {
                Some(torques) => torques,
                None => return self.findings().map(Break),
            },
        };
        Ok(Continue((Activity::Turn(torques), progress)))
    }

    /// Returns the approximate part of the routine that is done, 0 to 1.
    fn part(&self) -> f64 {
        let motor = self.motor as f64;
        match self.phase {
            Phase::Sweep(_) | Phase::Wiring(_) => motor * 0.22 + 0.12,
            Phase::Rest { .. } | Phase::Push { .. } | Phase::Pause { .. } => motor * 0.03,
        }
    }

    /// Returns the distance of every motor from the beginning, cm in the direction of rising count.
    fn measure(&mut self, instruments: &Instruments, feedback: &Feedback) -> Vector4<f64> {
        let start = *self.start.get_or_insert(feedback.motor_counts);
        let counts = |motor: usize| f64::from(feedback.motor_counts[motor].wrapping_sub(start[motor]));
        let travel = Vector4::from_fn(|motor, _| counts(motor) * self.cm_per_count[motor]);
        let gain = (SPEED_CORNER * instruments.period).min(0.7);
        self.speed += ((travel - self.last) / instruments.period - self.speed) * gain;
        self.last = travel;
        travel
    }

    /// Returns the torques that hold every motor at its target, N cm.
    fn hold(&self, instruments: &Instruments, travel: &Vector4<f64>) -> Vector4<f64> {
        let strongest = STRONGEST_HOLD * instruments.minimum;
        let pulls = (self.target - travel) * HOLD - self.speed * DAMPING;
        let pulls = pulls.map(|pull| pull.clamp(-strongest, strongest));
        pulls.component_mul(&Vector4::from(self.agrees)).component_mul(&instruments.radius)
    }

    /// Returns the torques that pull with one motor after the other, N cm, or `None` when the wiring has been found
    /// correct.
    fn check_wiring(
        &mut self,
        mut wiring: Wiring,
        instruments: &Instruments,
        sample: &Sample,
        travel: &Vector4<f64>,
    ) -> Result<Option<Vector4<f64>>, Obstacle> {
        let scale = self.newton_per_count.component_mul(&Vector4::from(self.gauges));
        let tensions = Vector4::from(sample.feedback.gauge_counts.map(f64::from)).component_mul(&scale);
        let pulse = wiring.step(instruments, &tensions)?;
        self.phase = Phase::Wiring(wiring);
        let inward = Vector4::from(self.agrees).component_mul(&Vector4::from(self.tightens));
        let torques = |pulse: Vector4<f64>| pulse.component_mul(&inward).component_mul(&instruments.radius);
        Ok(pulse.map(|pulse| self.hold(instruments, travel) + torques(pulse)))
    }

    fn findings(&self) -> Result<Findings, Obstacle> {
        if let Some(gauge) = self.gauges.iter().position(|&sign| sign == 0.0) {
            return Err(Obstacle::InconsistentGauge { tendon: gauge as u8 + 1 });
        }
        let whole = |sign: f64| if sign < 0.0 { -1 } else { 1 };
        Ok(Findings::Signs(Signs {
            motor: std::array::from_fn(|motor| whole(self.agrees[motor] * self.tightens[motor])),
            encoder: self.tightens.map(whole),
            gauge: self.gauges.map(whole),
        }))
    }
}

//! Varies the four tensions independently while the finger presses against its lower stops.

use crate::calibration::instruments::Instruments;
use nalgebra::{Vector3, Vector4};

/// Largest tension, as a fraction of t_max, or of the largest pull of the weakest motor if that is smaller.
const HARDEST: f64 = 0.6;
/// Rate at which the tensions change, N/s. While a tendon tightens at this rate, the speed of its motor is well above
/// the quantisation of the encoder.
const SPEED: f64 = 20.0;
/// Pause at the end of each ramp, s.
const DWELL: f64 = 0.15;
/// Torque that keeps every joint at its stop, N cm.
const HOLDING: f64 = 2.0;
/// Number of times that every pattern is applied.
const ROUNDS: usize = 2;

/// Changes the tensions back and forth between a base and four patterns. The first pattern raises all tensions
/// together. Each of the others increases the torque of one joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pressing {
    base: Vector4<f64>,
    patterns: [Vector4<f64>; 4],
    leg: usize,
    /// Time since the beginning of this leg, s. A leg is a ramp and the pause after it.
    seconds: f64,
    begun: Option<Vector4<f64>>,
}

impl Pressing {
    pub fn new(instruments: &Instruments) -> Self {
        let hardest = HARDEST * instruments.maximum.min(instruments.strongest);
        let holding = Vector3::repeat(-HOLDING);
        let distribute = |torques: &Vector3<f64>| instruments.distribution.distribute(torques).tensions;
        let base = distribute(&holding);
        let common = base + instruments.pretension * ((hardest - base.max()) / instruments.pretension.max()).max(0.0);
        let press = |joint: usize| {
            // Selects, in steps of 1 N cm, the largest torque whose tensions are at most `hardest`. The search ends at
            // the first torque with a higher tension, because the tensions rise with the torque.
            let tensions = (0..100).map(|more| {
                let mut torques = holding;
                torques[joint] -= f64::from(more);
                distribute(&torques)
            });
            tensions.take_while(|tensions| tensions.max() <= hardest).last().unwrap_or(base)
        };
        Self { base, patterns: [common, press(0), press(1), press(2)], leg: 0, seconds: 0.0, begun: None }
    }

    /// Returns the tensions of this cycle, N, or `None` when every pattern has been applied. The first ramp starts at
    /// `now`, the present tensions, N.
    pub fn step(&mut self, instruments: &Instruments, now: &Vector4<f64>) -> Option<Vector4<f64>> {
        let begun = *self.begun.get_or_insert(*now);
        let pattern = |leg: usize| if leg.is_multiple_of(2) { self.base } else { self.patterns[leg / 2 % 4] };
        let from = if self.leg == 0 { begun } else { pattern(self.leg - 1) };
        let to = pattern(self.leg);
        let duration = (to - from).amax() / SPEED;
        self.seconds += instruments.period;
        let part = if duration > 0.0 { (self.seconds / duration).min(1.0) } else { 1.0 };
        if self.seconds > duration + DWELL {
            (self.leg, self.seconds) = (self.leg + 1, 0.0);
        }
        (self.leg <= 8 * ROUNDS).then(|| from + (to - from) * part)
    }

    /// Returns the part that is done, 0 to 1.
    pub fn part(&self) -> f64 {
        self.leg as f64 / (8 * ROUNDS) as f64
    }

    /// Returns whether the first ramp, which starts at the tensions of the first cycle, is complete.
    pub fn under_way(&self) -> bool {
        self.leg > 0
    }
}

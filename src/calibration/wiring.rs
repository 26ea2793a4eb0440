//! Whether every motor pulls at the tendon whose gauge has its number.
//!
//! At rest a free finger shares every pull among all its tendons, so that says nothing. But a pull reaches the other
//! tendons only by moving the links, and they are inert: for some milliseconds after a sudden one its own gauge is far
//! ahead.

use super::instruments::Instruments;
use super::obstacle::Obstacle;
use nalgebra::Vector4;

/// A jerk: N in t_min, and s.
const JERK: f64 = 2.0;
const LENGTH: f64 = 0.006;
/// How long the gauges are watched from its beginning, s.
const WATCHED: f64 = 0.010;
/// Rest before each, s: what the last one left has died away.
const REST: f64 = 0.15;
/// Of which the gauges are averaged in the end.
const BASE: f64 = 0.05;
/// Jerks of each motor.
const JERKS: u32 = 4;
/// Another gauge counts as ahead when it rises by more than so many times what the motor's own does, and by so much, N.
const AHEAD: f64 = 1.1;
const LEAST: f64 = 0.2;

#[derive(Clone, Copy, Debug)]
pub(super) struct Wiring {
    motor: usize,
    jerks: u32,
    seconds: f64,
    base: Vector4<f64>,
    bases: f64,
    /// Sum of what the gauges rose by.
    risen: Vector4<f64>,
    samples: f64,
}

impl Wiring {
    pub fn new() -> Self {
        let zeros = Vector4::zeros();
        Self { motor: 0, jerks: 0, seconds: 0.0, base: zeros, bases: 0.0, risen: zeros, samples: 0.0 }
    }

    /// The pull that jerks a motor inward in this cycle, N at each tendon; none when every motor has been. `tensions`,
    /// N, need no zero, but the signs of the gauges.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        tensions: &Vector4<f64>,
    ) -> Result<Option<Vector4<f64>>, Obstacle> {
        self.seconds += instruments.period;
        let since = self.seconds - REST;
        if since < 0.0 {
            if since > -BASE {
                self.base += tensions;
                self.bases += 1.0;
            }
            return Ok(Some(Vector4::zeros()));
        }
        self.risen += tensions - self.base / self.bases;
        self.samples += 1.0;
        if since > WATCHED.max(3.0 * instruments.period) {
            (self.jerks, self.seconds, self.base, self.bases) = (self.jerks + 1, 0.0, Vector4::zeros(), 0.0);
            if self.jerks == JERKS {
                self.check(self.risen / self.samples)?;
                *self = Self { motor: self.motor + 1, ..Self::new() };
            }
        }
        let jerk = if self.seconds > REST && since < LENGTH { JERK * instruments.minimum } else { 0.0 };
        let pull = |motor: usize| if motor == self.motor { jerk } else { 0.0 };
        Ok((self.motor < 4).then(|| Vector4::from_fn(|motor, _| pull(motor))))
    }

    fn check(&self, risen: Vector4<f64>) -> Result<(), Obstacle> {
        let first = risen.imax();
        if first != self.motor && risen[first] > LEAST && risen[first] > AHEAD * risen[self.motor] {
            return Err(Obstacle::Swapped { motor: self.motor as u8 + 1, gauge: first as u8 + 1 });
        }
        Ok(())
    }
}

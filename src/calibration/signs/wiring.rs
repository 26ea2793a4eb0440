//! Checks that every motor pulls the tendon whose gauge has the same number.
//!
//! At rest a free finger shares every pull among all its tendons, so a steady pull does not show which tendon the motor
//! pulls. But a pull reaches the other tendons only by moving the links, whose inertia delays it. For some milliseconds
//! after a sudden pull, the gauge of the pulled tendon therefore leads by far. It must be the gauge with the motor's
//! number, which is called the motor's own gauge.

use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use nalgebra::Vector4;

/// Pull of a pulse, in multiples of t_min (`tendon.minimum`).
const PULSE: f64 = 2.0;
/// Duration of a pulse, s.
const LENGTH: f64 = 0.006;
/// Time for which the gauges are observed from the start of a pulse, s.
const WATCHED: f64 = 0.010;
/// Rest before each pulse, s. The response to the previous one has decayed after this time.
const REST: f64 = 0.15;
/// Last part of the rest, in which the gauges are averaged, s.
const BASE: f64 = 0.05;
/// Number of pulses of each motor.
const PULSES: u32 = 4;
/// Another gauge leads only if it rises by more than this factor times the rise of the motor's own gauge.
const LEADING_RATIO: f64 = 1.1;
/// Another gauge leads only if it rises by more than this, N.
const LEADING_RISE: f64 = 0.2;

#[derive(Clone, Copy, Debug)]
pub(super) struct Wiring {
    motor: usize,
    pulses: u32,
    seconds: f64,
    /// Sum of the tensions in the time [`BASE`], N.
    base_sum: Vector4<f64>,
    /// Number of samples in `base_sum`.
    base_samples: f64,
    /// Sum of the rises of the gauges, N.
    risen: Vector4<f64>,
    /// Number of samples in `risen`.
    samples: f64,
}

impl Wiring {
    pub fn new() -> Self {
        let (base_sum, risen) = (Vector4::zeros(), Vector4::zeros());
        Self { motor: 0, pulses: 0, seconds: 0.0, base_sum, base_samples: 0.0, risen, samples: 0.0 }
    }

    /// Returns the pulls of this cycle, N at each tendon, or `None` when every motor has been checked. `tensions`, N,
    /// come from gauges whose signs are correct. The zeros of the gauges need not be correct.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        tensions: &Vector4<f64>,
    ) -> Result<Option<Vector4<f64>>, Obstacle> {
        self.seconds += instruments.period;
        let since = self.seconds - REST;
        if since < 0.0 {
            if since > -BASE {
                self.base_sum += tensions;
                self.base_samples += 1.0;
            }
            return Ok(Some(Vector4::zeros()));
        }
        self.risen += tensions - self.base_sum / self.base_samples;
        self.samples += 1.0;
        if since > WATCHED.max(3.0 * instruments.period) {
            (self.pulses, self.seconds) = (self.pulses + 1, 0.0);
            (self.base_sum, self.base_samples) = (Vector4::zeros(), 0.0);
            if self.pulses == PULSES {
                self.check(self.risen / self.samples)?;
                *self = Self { motor: self.motor + 1, ..Self::new() };
            }
        }
        let pulse = if self.seconds > REST && since < LENGTH { PULSE * instruments.minimum } else { 0.0 };
        let pull = |motor: usize| if motor == self.motor { pulse } else { 0.0 };
        Ok((self.motor < 4).then(|| Vector4::from_fn(|motor, _| pull(motor))))
    }

    fn check(&self, risen: Vector4<f64>) -> Result<(), Obstacle> {
        let (leading, own) = (risen.imax(), risen[self.motor]);
        if leading != self.motor && risen[leading] > LEADING_RISE && risen[leading] > LEADING_RATIO * own {
            return Err(Obstacle::Swapped { motor: self.motor as u8 + 1, gauge: leading as u8 + 1 });
        }
        Ok(())
    }
}

//! Determines the gauge offsets with the motors off. Friction in motor and conduit keeps a tendon tight although its
//! motor is off, so every motor first lets its tendon out.

use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use crate::control::signals::Activity;
use nalgebra::Vector4;
use std::ops::ControlFlow::{self, Break, Continue};

/// Length by which every tendon is let out, cm: several times its stretch under the pretension.
const LET_OUT: f64 = 0.15;
/// Force with which a motor begins to let its tendon out, as a fraction of t_min (`tendon.minimum`). If a motor can
/// control the tension t_min, its friction is in most cases less than this force.
const PUSH: f64 = 0.8;
/// Rise of the force until the tendon is out, t_min/s.
const HARDER: f64 = 0.5;
/// Largest force, in t_min.
const HARDEST: f64 = 2.0;
/// Time limit for letting the tendons out, s.
const LETTING_OUT_LIMIT: f64 = 5.0;
/// Settling time after the tendons are out, s.
const SETTLING: f64 = 0.2;
/// Averaging time after the settling time, s.
const AVERAGING: f64 = 0.5;
/// Largest permitted noise of a gauge, N rms. Normal noise is a tenth of it.
const LARGEST_SPREAD: f64 = 0.3;
/// Largest permitted offset, N.
const LARGEST_OFFSET: f64 = 10.0;
/// Smallest change of a gauge between a tight and a slack tendon, as a fraction of t_min.
const LEAST_FALL: f64 = 0.5;

#[derive(Clone, Copy, Debug)]
pub(super) struct GaugeZero {
    seconds: f64,
    /// Travel at the beginning, cm.
    start: Option<Vector4<f64>>,
    /// Tensions at the beginning, N, measured with the configured zeros. `None` if the tendons were slack.
    tight: Option<Vector4<f64>>,
    slack: Average,
    out_at: Option<f64>,
}

impl GaugeZero {
    /// `tight` contains the tensions, N, that were measured with the configured zeros while the tendons were tight. It
    /// is `None` if the tendons were slack.
    pub fn new(tight: Option<Vector4<f64>>) -> Self {
        Self { seconds: 0.0, start: None, tight, slack: Average::default(), out_at: None }
    }

    /// Runs one cycle. Returns the activity, or the gauge offsets, N, when done.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Result<ControlFlow<Vector4<f64>, Activity>, Obstacle> {
        self.seconds += instruments.period;
        let travel = instruments.travel(sample.feedback);
        let start = *self.start.get_or_insert(travel);
        let inside = (travel - start).map(|distance| distance > -LET_OUT);
        let Some(out_at) = self.out_at else {
            if inside.iter().all(|inside| !inside) {
                self.out_at = Some(self.seconds);
            } else if self.seconds > LETTING_OUT_LIMIT {
                let motor = inside.iter().position(|&inside| inside).unwrap_or(0) as u8 + 1;
                return Err(Obstacle::MotorStuck { motor });
            }
            let push = -(PUSH + HARDER * self.seconds).min(HARDEST) * instruments.minimum;
            return Ok(Continue(Activity::Pull(inside.map(|inside| if inside { push } else { 0.0 }))));
        };
        let since = self.seconds - out_at;
        if since > SETTLING {
            self.slack.add(instruments.tensions(sample.feedback));
        }
        if since < SETTLING + AVERAGING {
            return Ok(Continue(Activity::Turn(Vector4::zeros())));
        }
        let (offsets, spread) = (self.slack.mean(), self.slack.spread());
        for index in 0..4 {
            let tendon = index as u8 + 1;
            if spread[index] > LARGEST_SPREAD {
                return Err(Obstacle::UnsteadyGauge { tendon, newton: spread[index] });
            }
            if let Some(tight) = self.tight {
                check_fall(tendon, tight[index] - offsets[index], LEAST_FALL * instruments.minimum)?;
            }
            if offsets[index].abs() > LARGEST_OFFSET {
                return Err(Obstacle::GaugeOffset { tendon, newton: offsets[index] });
            }
        }
        Ok(Break(offsets))
    }
}

/// Checks `fall`, the tension that a gauge reports for the tight tendon minus the one for the slack tendon, N. It must
/// be `least` or more.
fn check_fall(tendon: u8, fall: f64, least: f64) -> Result<(), Obstacle> {
    match fall {
        fall if fall <= -least => Err(Obstacle::ReversedGauge { gauge: tendon }),
        fall if fall < least => Err(Obstacle::DeadGauge { tendon, newton: fall.abs() }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gauge_that_rises_when_its_tendon_is_let_out_is_reversed_and_not_dead() {
        let check = |fall| check_fall(2, fall, 1.5);
        assert_eq!(check(-5.0), Err(Obstacle::ReversedGauge { gauge: 2 }));
        assert_eq!(check(-0.1), Err(Obstacle::DeadGauge { tendon: 2, newton: 0.1 }));
        assert_eq!(check(1.4), Err(Obstacle::DeadGauge { tendon: 2, newton: 1.4 }));
        assert_eq!(check(1.5), Ok(()));
    }
}

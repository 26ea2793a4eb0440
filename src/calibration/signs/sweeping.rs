//! Sweeps one motor after the other. A sweep shows which direction tightens the motor's tendon, and the signs of the
//! gauges.

use super::sweep::{Sweep, TIGHT};
use super::wiring::Wiring;
use super::{Phase, SignSearch};
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use crate::calibration::step::Sample;
use nalgebra::Vector4;

/// Speed of a sweep, cm/s.
const SPEED: f64 = 0.5;
/// A gauge responds alone if every other gauge changes by less than this fraction of the change of that gauge. No gauge
/// of a free finger responds alone: the tensions change along the null vector of R, and every entry of this vector is
/// above this fraction of the largest entry.
const ALONE: f64 = 0.2;

impl SignSearch {
    /// Sweeps the motor while the others are held, and doubles the amplitude until one side is tight and the other
    /// slack. Returns the motor torques, N cm.
    pub(super) fn sweep_motor(
        &mut self,
        mut sweep: Sweep,
        instruments: &Instruments,
        sample: &Sample,
        travel: &Vector4<f64>,
    ) -> Result<Vector4<f64>, Obstacle> {
        let complete = self.advance(&mut sweep, instruments, sample, travel);
        self.phase = if !complete {
            Phase::Sweep(sweep)
        } else if let Some(side) = sweep.tight_side() {
            self.conclude(&sweep, side)?
        } else {
            Phase::Sweep(sweep.wider().ok_or(Obstacle::NothingTightens { motor: self.motor as u8 + 1 })?)
        };
        Ok(self.hold(instruments, travel))
    }

    /// Stores the signs that a sweep has shown. Continues with the next motor, or with the wiring after the last one.
    fn conclude(&mut self, sweep: &Sweep, side: f64) -> Result<Phase, Obstacle> {
        self.tightens[self.motor] = side;
        self.note_gauges(sweep, side)?;
        // The motor stays on the tight side, which takes up some slack for the motors that follow.
        self.target[self.motor] = sweep.centre + 0.5 * side * sweep.amplitude;
        if self.motor == 3 {
            return Ok(Phase::Wiring(Wiring::new()));
        }
        self.motor += 1;
        Ok(Phase::Sweep(Sweep::first(self.target[self.motor])))
    }

    /// Runs one cycle of the motor's motion. Returns whether the motor has been at every position.
    fn advance(
        &mut self,
        sweep: &mut Sweep,
        instruments: &Instruments,
        sample: &Sample,
        travel: &Vector4<f64>,
    ) -> bool {
        let motor = self.motor;
        let aim = sweep.aim();
        let step = SPEED * instruments.period;
        self.target[motor] += (aim - self.target[motor]).clamp(-step, step);
        if self.target[motor] != aim {
            return false;
        }
        let lag = (aim - travel[motor]).abs();
        sweep.dwell(instruments.period, sample.feedback.gauge_counts, &self.newton_per_count, lag)
    }

    /// Stores the signs of the gauges, from the change between the slack end and the tight end. If only one gauge
    /// responds, something holds the finger, and the gauge is on the tendon that the motor pulls. The gauge must then
    /// have the motor's number. Otherwise, parts are swapped.
    fn note_gauges(&mut self, sweep: &Sweep, side: f64) -> Result<(), Obstacle> {
        let change = sweep.change_between_ends() * side;
        let first = change.abs().imax();
        let others = (0..4).filter(|&gauge| gauge != first).map(|gauge| change[gauge].abs()).fold(0.0, f64::max);
        if first != self.motor && change[first].abs() > TIGHT && others < ALONE * change[first].abs() {
            return Err(Obstacle::Swapped { motor: self.motor as u8 + 1, gauge: first as u8 + 1 });
        }
        for gauge in 0..4 {
            if change[gauge].abs() < TIGHT {
                continue;
            }
            let sign = change[gauge].signum();
            if self.gauges[gauge] == -sign {
                return Err(Obstacle::InconsistentGauge { tendon: gauge as u8 + 1 });
            }
            self.gauges[gauge] = sign;
        }
        Ok(())
    }
}

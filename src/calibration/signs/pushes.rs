//! Short pushes that show whether each motor's count rises with its command.

use super::sweep::Sweep;
use super::{Phase, SignSearch};
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use nalgebra::Vector4;

/// A motor counts as turned when it has moved by more than this distance, cm at the tendon.
const TURNED: f64 = 0.005;
/// First push, as a fraction of t_min at the tendon.
const FIRST_PUSH: f64 = 0.4;
/// Each push is larger than the previous one by this factor, until the motor turns.
const GROWTH: f64 = 1.3;
/// Largest push, in multiples of t_min at the tendon.
const HARDEST_PUSH: f64 = 2.0;
/// Longest duration of a push, and duration of the pause after the motor has turned, s.
const PUSH_TIME: f64 = 0.1;
/// Rest before the first measurement, s.
const REST: f64 = 0.2;

impl SignSearch {
    /// Lets the finger come to rest before the first push. Like the other phases, returns the motor torques, N cm.
    pub(super) fn rest(&mut self, seconds: f64, instruments: &Instruments, travel: &Vector4<f64>) -> Vector4<f64> {
        let seconds = seconds + instruments.period;
        self.phase = if seconds > REST { first_push(instruments, travel) } else { Phase::Rest { seconds } };
        Vector4::zeros()
    }

    /// Pushes the motor, harder each time, until its count changes.
    pub(super) fn push_motor(
        &mut self,
        seconds: f64,
        push: f64,
        from: &Vector4<f64>,
        instruments: &Instruments,
        travel: &Vector4<f64>,
    ) -> Result<Vector4<f64>, Obstacle> {
        let motor = self.motor;
        let seconds = seconds + instruments.period;
        let moved = travel - from;
        let mut torques = Vector4::zeros();
        self.phase = if moved[motor].abs() > TURNED {
            self.agrees[motor] = moved[motor].signum();
            Phase::Pause { seconds: 0.0 }
        } else if moved.amax() > TURNED {
            let encoder = moved.iamax() as u8 + 1;
            return Err(Obstacle::SwappedMotor { motor: motor as u8 + 1, encoder });
        } else if seconds > PUSH_TIME {
            let push = push * GROWTH;
            if push > HARDEST_PUSH * instruments.minimum {
                return Err(Obstacle::MotorStuck { motor: motor as u8 + 1 });
            }
            Phase::Push { seconds: 0.0, push, from: *from }
        } else {
            torques[motor] = push * instruments.radius[motor];
            Phase::Push { seconds, push, from: *from }
        };
        Ok(torques)
    }

    /// Lets the pushed motor come to rest before the next motor is pushed, or before the first sweep.
    pub(super) fn pause(&mut self, seconds: f64, instruments: &Instruments, travel: &Vector4<f64>) -> Vector4<f64> {
        let seconds = seconds + instruments.period;
        self.phase = if seconds <= PUSH_TIME {
            Phase::Pause { seconds }
        } else if self.motor < 3 {
            self.motor += 1;
            first_push(instruments, travel)
        } else {
            self.motor = 0;
            self.target = *travel;
            Phase::Sweep(Sweep::first(travel[0]))
        };
        Vector4::zeros()
    }
}

fn first_push(instruments: &Instruments, travel: &Vector4<f64>) -> Phase {
    Phase::Push { seconds: 0.0, push: FIRST_PUSH * instruments.minimum, from: *travel }
}

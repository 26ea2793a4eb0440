//! Controls the positions of all motors: they tighten the tendons, pull one by one, and raise all tensions together.

use super::readings::Readings;
use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use nalgebra::Vector4;
use std::ops::ControlFlow::{self, Break, Continue};

/// Stiffness with which a motor is held, N/cm.
const HOLD: f64 = 150.0;
/// Damping of a held motor, N s/cm.
const DAMPING: f64 = 2.0;
/// Speed at which slack is wound in, cm/s.
const WINDING: f64 = 0.5;
/// Largest slack that is wound in, cm.
const MOST_SLACK: f64 = 0.5;
/// Time for the motors to come to rest, s.
const SETTLING: f64 = 0.05;
/// Time in which readings are averaged, s: some periods of the vibration of the links on their tendons.
const READING: f64 = 0.04;
/// Rise of the tensions, as a multiple of the pretension.
const RAISED: f64 = 2.0;
/// Time in which all tensions rise together, s.
const RAISING: f64 = 0.12;
/// Pull of a pulse, as a multiple of t_min. After a pulse the links vibrate until their friction stops them. The
/// stronger the pulse, the longer they vibrate.
const PULSE: f64 = 2.0;
/// Duration of a pulse, s.
pub(super) const LENGTH: f64 = 0.006;
/// The gauges are read between these two times after the beginning of a pulse, s: late enough for the motor to move,
/// but too early for the links to move.
const RESPONSE: (f64, f64) = (0.003, 0.009);
/// Time before a pulse, s, in which the vibrations of the links decay.
const QUIET: f64 = 0.12;
/// At the beginning of [`QUIET`], the motor winds in until it has moved by the first value, cm, but no longer than the
/// second value, s. Its friction then does not delay the pulse.
const LOOSENED: (f64, f64) = (0.001, 0.05);
/// All gauges are read again between these two times after the beginning of a pulse, s, when the links begin to move.
pub(super) const LATE: (f64, f64) = (0.005, 0.012);
/// Time from the cycle that commands a pulse to the motor's torque, in periods.
const DELAY: f64 = 1.5;

#[derive(Clone, Debug)]
pub(super) struct Holding {
    /// Place at which each motor is held, cm.
    target: Vector4<f64>,
    /// The place at the beginning of [`Phase::Tightening`] or [`Phase::Raising`].
    from: Vector4<f64>,
    phase: Phase,
    seconds: f64,
    base: Average,
    read: Average,
    late: Average,
    responses: Responses,
    /// Place, cm, of the motor of the present [`Phase::Pulse`] when this phase began.
    began: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Phase {
    Tightening,
    Pulse(usize),
    Settling,
    Raising,
    Raised,
}

/// How the gauges have responded.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Responses {
    /// For each motor, the rise of every gauge at the beginning of its pulse, N.
    pub pulses: [Vector4<f64>; 4],
    /// The same rises some milliseconds later, when the links begin to move.
    pub late: [Vector4<f64>; 4],
    /// Rise of every gauge while all motors wind in, divided by the expected rise.
    pub raised: Vector4<f64>,
}

impl Holding {
    pub fn new(travel: &Vector4<f64>) -> Self {
        Self {
            target: *travel,
            from: *travel,
            phase: Phase::Tightening,
            seconds: 0.0,
            base: Average::default(),
            read: Average::default(),
            late: Average::default(),
            responses: Responses::default(),
            began: None,
        }
    }

    /// Runs one cycle. Returns the pulls of the motors, N, or the responses at the end.
    pub fn step(
        &mut self,
        instruments: &Instruments,
        friction: &Vector4<f64>,
        readings: &Readings,
    ) -> Result<ControlFlow<Responses, Vector4<f64>>, Obstacle> {
        self.seconds += instruments.period;
        let mut pulse = Vector4::zeros();
        match self.phase {
            Phase::Tightening => self.tighten(instruments, friction, readings)?,
            Phase::Settling => {
                if self.seconds > SETTLING {
                    self.base.add(readings.tensions);
                }
                if self.seconds > SETTLING + READING {
                    self.from = self.target;
                    self.enter(Phase::Raising);
                }
            }
            Phase::Raising => {
                // A smooth rise makes the links vibrate little.
                let done = (self.seconds / RAISING).min(1.0);
                let part = (1.0 - (std::f64::consts::PI * done).cos()) / 2.0;
                let stretch = instruments.compliance.add_scalar(1.0 / HOLD);
                self.target = self.from + expected_rise(instruments).component_mul(&stretch) * part;
                if done == 1.0 {
                    self.enter(Phase::Raised);
                }
            }
            Phase::Raised => {
                if self.seconds > SETTLING {
                    self.read.add(readings.tensions);
                }
                if self.seconds > SETTLING + READING {
                    let risen = self.read.mean() - self.base.mean();
                    let raised = risen.component_div(&expected_rise(instruments));
                    return Ok(Break(Responses { raised, ..self.responses }));
                }
            }
            Phase::Pulse(motor) => pulse[motor] = self.pulse(motor, instruments, readings),
        }
        Ok(Continue(self.hold(instruments, readings) + pulse))
    }

    fn enter(&mut self, phase: Phase) {
        (self.phase, self.seconds) = (phase, 0.0);
        if !matches!(self.phase, Phase::Raising | Phase::Raised) {
            (self.base, self.read, self.late) = (Average::default(), Average::default(), Average::default());
            self.began = None;
        }
    }

    /// Lets one motor pull for some milliseconds, and reads the gauges. Returns its pull, N.
    fn pulse(&mut self, motor: usize, instruments: &Instruments, readings: &Readings) -> f64 {
        let place = readings.travel[motor];
        let began = *self.began.get_or_insert(place);
        if self.seconds < LOOSENED.1 && place - began < LOOSENED.0 {
            self.target[motor] += WINDING * instruments.period;
        }
        let since = self.seconds - QUIET;
        if since <= 0.0 && since > -READING {
            self.base.add(readings.tensions);
        }
        let pulled = since - DELAY * instruments.period;
        if pulled > RESPONSE.0 && pulled < RESPONSE.1 {
            self.read.add(readings.tensions);
        }
        if pulled > LATE.0 && pulled < LATE.1 {
            self.late.add(readings.tensions);
        }
        if pulled > LATE.1 {
            self.responses.pulses[motor] = self.read.mean() - self.base.mean();
            self.responses.late[motor] = self.late.mean() - self.base.mean();
            self.enter(if motor == 3 { Phase::Settling } else { Phase::Pulse(motor + 1) });
        }
        if since > 0.0 && since <= LENGTH { PULSE * instruments.minimum } else { 0.0 }
    }

    /// Winds every motor in until its pull reaches the sum of its pretension and its friction.
    fn tighten(
        &mut self,
        instruments: &Instruments,
        friction: &Vector4<f64>,
        readings: &Readings,
    ) -> Result<(), Obstacle> {
        let mut tight = true;
        for motor in 0..4 {
            let pull = (self.target[motor] - readings.travel[motor]) * HOLD;
            if pull < instruments.pretension[motor] + friction[motor] {
                self.target[motor] += WINDING * instruments.period;
                tight = false;
            }
            if self.target[motor] - self.from[motor] > MOST_SLACK {
                return Err(Obstacle::Slack { tendon: motor as u8 + 1, newton: readings.tensions[motor] });
            }
        }
        if tight {
            self.enter(Phase::Pulse(0));
        }
        Ok(())
    }

    /// The pulls that hold every motor at its target, N.
    fn hold(&self, instruments: &Instruments, readings: &Readings) -> Vector4<f64> {
        let strongest = (0.5 * instruments.maximum).min(instruments.strongest);
        let pulls = (self.target - readings.travel) * HOLD - readings.speed * DAMPING;
        pulls.map(|pull| pull.clamp(-instruments.minimum, strongest))
    }
}

/// The rise of the tensions, N: a multiple of the pretension. It keeps the largest tension below half of t_max, but is
/// at least half of the pretension.
pub(super) fn expected_rise(instruments: &Instruments) -> Vector4<f64> {
    let most = 0.5 * instruments.maximum / instruments.pretension.max() - 1.2;
    instruments.pretension * RAISED.min(most.max(0.5))
}

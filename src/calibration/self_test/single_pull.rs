//! One motor pulls alone, with a force that rises until an encoder moves. If no encoder has moved at the force
//! [`HARDEST`], the motor or its encoder is dead. If the motor's own encoder moves forward, the motor is stopped, and
//! the next motor follows. If the encoder of another motor moves first, or if the motor's own encoder moves backward,
//! [`Stage::Pulling`] begins: the motor pulls with the constant force [`PULL`]. This stage ends when a gauge responds,
//! when the time [`LONGEST`] is over, or when an encoder has moved by [`FARTHEST`] from its mean reading in
//! [`Stage::Resting`]. [`Stage::Pulling`] does not begin if the encoder of another motor moves backward first, and the
//! pulling motor's own gauge has already responded: the pulling motor's own encoder is dead then, and the test ends at
//! once. The unit t_min of some forces is `tendon.minimum`.

use super::readings::Readings;
use crate::calibration::average::Average;
use crate::calibration::instruments::Instruments;
use crate::calibration::obstacle::Obstacle;
use nalgebra::Vector4;

/// Time of rest before each pull, s. The readings are averaged in this time.
const REST: f64 = 0.025;
/// A motor is at rest if it moves by less than this distance in the time [`REST`], cm.
const AT_REST: f64 = 0.001;
/// Longest wait for the motors to come to rest, s. Tight tendons unwind motors that have just been switched off.
const LONGEST_WAIT: f64 = 0.3;
/// Rise of the pull, t_min/s.
const RISE: f64 = 25.0;
/// Largest pull, in t_min.
const HARDEST: f64 = 3.0;
/// An encoder counts as moved when its reading has changed by more than this distance, cm at the tendon.
const MOVED: f64 = 0.004;
/// Pull in [`Stage::Pulling`], and largest reverse pull in [`Stage::Braking`], in t_min.
const PULL: f64 = 1.2;
/// Longest time in [`Stage::Pulling`], s. It is short, because the motor may be unwinding its tendon.
const LONGEST: f64 = 0.12;
/// Travel of an encoder from its mean reading in [`Stage::Resting`], cm, at which [`Stage::Pulling`] ends. It is short
/// for the same reason as [`LONGEST`].
const FARTHEST: f64 = 0.12;
/// A gauge has responded if its tension has changed by more than this, in t_min.
const RESPONDED: f64 = 0.35;
/// Damping that stops a motor after its pull, N s/cm.
const DAMPING: f64 = 2.0;
/// Time for which the damping acts, s.
const BRAKING: f64 = 0.02;

/// The test of one motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct SinglePull {
    motor: usize,
    stage: Stage,
    /// Time in the stage, s.
    seconds: f64,
    waited: f64,
    tensions: Average,
    travel: Average,
}

#[derive(Clone, Copy, Debug)]
enum Stage {
    Resting,
    /// The pull rises.
    Rising,
    /// The motor pulls after `encoder` has moved in `direction`. Either the encoder or the direction is wrong.
    Pulling {
        encoder: usize,
        direction: f64,
    },
    Braking,
}

impl SinglePull {
    pub fn of(motor: usize) -> Self {
        let (tensions, travel) = (Average::default(), Average::default());
        Self { motor, stage: Stage::Resting, seconds: 0.0, waited: 0.0, tensions, travel }
    }

    /// Returns the number of the motor that pulls, from 0. It is 4 after the last one.
    pub fn motor(&self) -> usize {
        self.motor
    }

    /// Runs one cycle and returns the pulls of the motors, N.
    pub fn step(&mut self, instruments: &Instruments, readings: &Readings) -> Result<Vector4<f64>, Obstacle> {
        self.seconds += instruments.period;
        let minimum = instruments.minimum;
        let moved = readings.travel - self.travel.mean();
        let risen = readings.tensions - self.tensions.mean();
        let pull = match self.stage {
            Stage::Resting => {
                self.rest(instruments.period, readings, &moved);
                0.0
            }
            Stage::Rising => {
                // `enter` restarts the time, so the pull is computed before.
                let pull = RISE * self.seconds;
                let leading = moved.iamax();
                if moved[leading].abs() > MOVED {
                    // The motor's gauge shows the pull, and the pull has unwound another motor, but the motor's own
                    // encoder has not moved.
                    if leading != self.motor && moved[leading] < 0.0 && risen[self.motor] > RESPONDED * minimum {
                        return Err(Obstacle::DeadEncoder { encoder: self.motor as u8 + 1 });
                    }
                    if leading == self.motor && moved[leading] > 0.0 {
                        self.enter(Stage::Braking);
                        0.0
                    } else {
                        self.enter(Stage::Pulling { encoder: leading, direction: moved[leading].signum() });
                        pull
                    }
                } else if pull > HARDEST {
                    return Err(self.nothing_moved(&risen, minimum));
                } else {
                    pull
                }
            }
            Stage::Pulling { encoder, direction } => {
                self.judge_response(encoder, direction, &moved, &risen, minimum)?;
                PULL
            }
            Stage::Braking => {
                if self.seconds > BRAKING {
                    *self = Self::of(self.motor + 1);
                    return Ok(Vector4::zeros());
                }
                (-readings.speed[self.motor] * DAMPING / minimum).clamp(-PULL, 0.0)
            }
        };
        let motor = self.motor;
        Ok(Vector4::from_fn(|other, _| if other == motor { pull * minimum } else { 0.0 }))
    }

    fn enter(&mut self, stage: Stage) {
        (self.stage, self.seconds) = (stage, 0.0);
    }

    /// Averages the readings for the time [`REST`]. Restarts the average if a motor moves, but not after
    /// [`LONGEST_WAIT`].
    fn rest(&mut self, period: f64, readings: &Readings, moved: &Vector4<f64>) {
        self.waited += period;
        if self.seconds > 1.5 * period && moved.amax() > AT_REST && self.waited < LONGEST_WAIT {
            *self = Self { waited: self.waited, ..Self::of(self.motor) };
            return;
        }
        self.tensions.add(readings.tensions);
        self.travel.add(readings.travel);
        if self.seconds > REST {
            self.enter(Stage::Rising);
        }
    }

    /// Waits for the response of a gauge, and names what is wrong.
    fn judge_response(
        &self,
        encoder: usize,
        direction: f64,
        moved: &Vector4<f64>,
        risen: &Vector4<f64>,
        minimum: f64,
    ) -> Result<(), Obstacle> {
        let (motor, number, other) = (self.motor, self.motor as u8 + 1, encoder as u8 + 1);
        let leading = risen.iamax();
        let responded = risen[leading].abs() > RESPONDED * minimum;
        if !responded && self.seconds < LONGEST && moved.amax() < FARTHEST {
            return Ok(());
        }
        let (low, high) = (number.min(other), number.max(other));
        Err(if encoder != motor {
            match responded {
                true if leading == encoder => Obstacle::SwappedMotors { first: low, second: high },
                true if leading == motor => Obstacle::SwappedEncoders { first: low, second: high },
                _ => Obstacle::SwappedMotor { motor: number, encoder: other },
            }
        } else if direction < 0.0 && responded && leading == motor && risen[leading] > 0.0 {
            Obstacle::ReversedEncoder { encoder: number }
        } else {
            Obstacle::ReversedMotor { motor: number }
        })
    }

    fn nothing_moved(&self, risen: &Vector4<f64>, minimum: f64) -> Obstacle {
        let number = self.motor as u8 + 1;
        match risen.iamax() == self.motor && risen.amax() > RESPONDED * minimum {
            true => Obstacle::DeadEncoder { encoder: number },
            false => Obstacle::DeadMotor { motor: number },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    /// Returns the pull of motor 1 before and after the encoder with this index, 0 to 3, has moved.
    fn pulls_around_motion_of(encoder: usize) -> (f64, f64) {
        let instruments = Instruments::new(&ConfiguredFinger::default(), 1000.0).expect("usable");
        let zeros = Vector4::zeros();
        let mut readings = Readings { travel: zeros, speed: zeros, tensions: zeros };
        let mut single = SinglePull::of(0);
        let mut before = 0.0;
        for _ in 0..80 {
            before = single.step(&instruments, &readings).expect("nothing is wrong yet")[0];
        }
        readings.travel[encoder] = 2.0 * MOVED;
        (before, single.step(&instruments, &readings).expect("no gauge has responded")[0])
    }

    #[test]
    fn the_pull_continues_after_another_encoder_has_moved() {
        let (before, after) = pulls_around_motion_of(1);
        assert!(before > 0.0 && after >= before, "{before} N, then {after} N");
    }

    #[test]
    fn the_pull_ends_after_the_encoder_of_the_motor_has_moved() {
        let (before, after) = pulls_around_motion_of(0);
        assert!(before > 0.0 && after == 0.0, "{before} N, then {after} N");
    }
}

//! Runs one routine until its verdict.

use super::findings::Findings;
use super::identification::Identification;
use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::self_test::SelfTest;
use super::signs::SignSearch;
use super::step::{Progress, Sample};
use super::zeroing::Zeroing;
use crate::control::signals::Activity;
use crate::model::configuration::{ConfiguredController, ConfiguredFinger, Scheme, Unusable};
use nalgebra::Vector4;
use std::ops::ControlFlow::{Break, Continue};

/// Gains of the controller of Figure 10 of COINS TR 90-48 while a routine runs at [`GENTLE_RATE`], Hz, or more:
/// `controller.tension_gain`, and `controller.tension_integral`, 1/s.
const GENTLE: (f64, f64) = (0.5, 100.0);
const GENTLE_RATE: f64 = 750.0;

/// The routines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Finds the signs of motors, encoders and gauges. Every motor turns back and forth by a small amount, and pulls
    /// its tendon in short pulses.
    Signs,
    /// Checks the wiring and the scales of the gauges of a calibrated finger within two seconds. Every motor pulls its
    /// tendon a little.
    SelfTest,
    /// Zeros the gauges, and the encoders by the configured method.
    Zero,
    /// Identifies the gains of the gauges, the friction of motors, conduits, pulleys and joints, the inertia of the
    /// rotors, the moment arms, and the stiffness of the tendons. Every joint moves between its stops, and the finger
    /// presses against its lower stops.
    Identify,
}

/// The state of a routine after a cycle.
// The servo does not use the heap, so the large variants are not boxed.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The routine continues.
    InProgress(Progress),
    /// The routine is done. The tendons may be slack.
    Found(Findings),
    /// The routine gave up.
    Refused(Obstacle),
}

/// A routine in progress. At first it may leave the finger under the finger's own controller. From the first cycle that
/// returns an activity, the routine controls the finger.
#[derive(Clone, Debug)]
pub struct Calibration {
    instruments: Instruments,
    routine: Routine,
    seconds: f64,
    time_limit: f64,
    in_charge: bool,
}

// The servo does not use the heap, so the large variants are not boxed.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
enum Routine {
    Signs(SignSearch),
    SelfTest(SelfTest),
    Zero(Zeroing),
    Identify(Identification),
}

impl Calibration {
    /// Creates a routine for a finger with its current configuration.
    ///
    /// # Errors
    /// Returns an error if a routine cannot use the configuration.
    pub fn new(task: Task, finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        let routine = match task {
            Task::Signs => Routine::Signs(SignSearch::new(finger)),
            Task::SelfTest => Routine::SelfTest(SelfTest::new(finger)),
            Task::Zero => Routine::Zero(Zeroing::new(finger)),
            Task::Identify => Routine::Identify(Identification::new(finger)),
        };
        Ok(Self {
            instruments: Instruments::new(finger, rate)?,
            routine,
            seconds: 0.0,
            time_limit: finger.zeroing.time_limit_s,
            in_charge: false,
        })
    }

    /// Returns the configuration of the finger's controller while a routine runs at `rate`, Hz. The scheme is Figure 10
    /// of COINS TR 90-48, and configured gains of this scheme stay in force. If the gains on the tension error are not
    /// configured, a routine at 750 Hz or more uses lower gains than the default ones of this scheme. Routines move
    /// slowly, and the lower gains are stable with gauges and amplifiers that lag by 1 ms. State feedback is not used,
    /// because it relies on the stiffness, friction and zeros that a routine has yet to find. Figure 11 is not used,
    /// because it would adapt to uncalibrated gauges.
    pub fn controlled(finger: &ConfiguredFinger, rate: f64) -> ConfiguredFinger {
        let configured = &finger.controller;
        let controller = match configured.scheme(rate) {
            Scheme::Figure10 | Scheme::StateFeedback => configured.clone(),
            Scheme::Figure9 | Scheme::Figure11 => {
                ConfiguredController { gravity_compensation: configured.gravity_compensation, ..Default::default() }
            }
        };
        let gentle = |configured: Option<f64>, gain: f64| configured.or((rate >= GENTLE_RATE).then_some(gain));
        let controller = ConfiguredController {
            scheme: Some(Scheme::Figure10),
            tension_gain: gentle(controller.tension_gain, GENTLE.0),
            tension_integral: gentle(controller.tension_integral, GENTLE.1),
            ..controller
        };
        ConfiguredFinger { controller, ..finger.clone() }
    }

    /// Runs one cycle with a measurement. Returns what the finger must do, and the state of the routine. Without an
    /// activity the finger continues under its own controller. The caller must not call this function again after
    /// `Found` or `Refused`.
    pub fn cycle(&mut self, sample: &Sample) -> (Option<Activity>, Verdict) {
        let (activity, verdict) = self.step(sample);
        self.in_charge |= activity.is_some();
        (activity, verdict)
    }

    fn step(&mut self, sample: &Sample) -> (Option<Activity>, Verdict) {
        // After a refusal the motors are off, so that no motor pulls against the obstacle. A finger that the routine
        // does not control yet keeps its own controller.
        let motors_off = Activity::Turn(Vector4::zeros());
        let refused = |obstacle, in_charge: bool| (in_charge.then_some(motors_off), Verdict::Refused(obstacle));
        self.seconds += self.instruments.period;
        if self.seconds > self.time_limit {
            return refused(Obstacle::TimeLimit { seconds: self.time_limit }, self.in_charge);
        }
        let taking_over = |(activity, progress)| (Some(activity), progress);
        let stepped = match &mut self.routine {
            Routine::Signs(routine) => {
                routine.step(&self.instruments, sample).map(|flow| flow.map_continue(taking_over))
            }
            Routine::SelfTest(routine) => {
                routine.step(&self.instruments, sample).map(|flow| flow.map_continue(taking_over))
            }
            Routine::Zero(routine) => routine.step(&mut self.instruments, sample),
            Routine::Identify(routine) => {
                routine.step(&mut self.instruments, sample).map(|flow| flow.map_continue(taking_over))
            }
        };
        match stepped {
            Ok(Continue((activity, progress))) => (activity, Verdict::InProgress(progress)),
            Ok(Break(findings)) => (Some(motors_off), Verdict::Found(findings)),
            Err(obstacle) => refused(obstacle, self.in_charge),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// With state feedback, only calibrations use `tension_gain` and `tension_integral`. So `docs/sun2xp.toml`, the
    /// reference of all keys, must give the values that these keys have in a calibration. Otherwise a reader would
    /// believe that a calibration uses the default values of Figure 10.
    #[test]
    fn the_reference_gives_the_gains_of_a_calibration() {
        let controller = Calibration::controlled(&ConfiguredFinger::default(), GENTLE_RATE).controller;
        let gains = [("tension_gain", controller.tension_gain), ("tension_integral", controller.tension_integral)];
        for (key, gain) in gains {
            let (before, _) = include_str!("../../docs/sun2xp.toml").split_once(&format!("\n#{key} = ")).expect(key);
            let comment = before.rsplit("\n\n").next().unwrap_or_default().replace("\n# ", " ");
            let reported = format!("{} in a calibration from {GENTLE_RATE} Hz up", gain.expect("a gain"));
            assert!(comment.contains(&reported), "{reported:?} is not in: {comment}");
        }
    }
}

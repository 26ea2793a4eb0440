//! One routine from its beginning to its verdict.

use super::findings::Findings;
use super::identification::Identification;
use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::signs::SignSearch;
use super::step::{Progress, Sample};
use super::zeroing::Zeroing;
use crate::control::signals::Activity;
use crate::model::configuration::{ConfiguredController, ConfiguredFinger, Scheme, Unusable};
use nalgebra::Vector4;
use std::ops::ControlFlow::{Break, Continue};

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Which way motors, encoders and gauges count. Every motor turns a little, to and fro; nothing else moves fast.
    Signs,
    /// Zeros of gauges and encoders, the latter by the configured method.
    Zero,
    /// Gains of the gauges, friction of motors and joints, stiffness of tendons. The finger moves to its lower stops
    /// and presses against them.
    Identify,
}

/// What became of a routine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It is still at it.
    Going(Progress),
    /// Done. The tendons may be slack now.
    Found(Findings),
    /// It gave up.
    Refused(Obstacle),
}

/// A routine under way. In the beginning it may leave the finger to what controls it: it has taken over once a cycle
/// yields an activity.
#[derive(Clone, Debug)]
pub struct Calibration {
    instruments: Instruments,
    routine: Routine,
    seconds: f64,
    time_limit: f64,
    in_charge: bool,
}

// All of one size on purpose: no heap in the servo.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
enum Routine {
    Signs(SignSearch),
    Zero(Zeroing),
    Identify(Identification),
}

impl Calibration {
    /// A routine for a finger that is at present configured like this.
    ///
    /// # Errors
    /// A configuration that no routine can work with.
    pub fn new(task: Task, finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        let routine = match task {
            Task::Signs => Routine::Signs(SignSearch::new(finger)),
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

    /// The same finger as its controller must be made while a routine runs at `rate`, Hz: by Figure 10, whatever is
    /// configured. State feedback is built upon the stiffness, friction and zeros that are looked for, and Figure 11
    /// adapts to what the gauges show. Gains of Figure 10 that are configured stay.
    pub fn controlled(finger: &ConfiguredFinger, rate: f64) -> ConfiguredFinger {
        let configured = &finger.controller;
        let controller = match configured.scheme(rate) {
            Scheme::Figure10 | Scheme::StateFeedback => configured.clone(),
            Scheme::Figure9 | Scheme::Figure11 => {
                ConfiguredController { gravity_compensation: configured.gravity_compensation, ..Default::default() }
            }
        };
        ConfiguredFinger {
            controller: ConfiguredController { scheme: Some(Scheme::Figure10), ..controller },
            ..finger.clone()
        }
    }

    /// One cycle that has a measurement: what the finger shall do, and how it goes. Without an activity the finger goes
    /// on with what it did before the routine, under the controller that it had. Not to be called again after a
    /// verdict.
    pub fn cycle(&mut self, sample: &Sample) -> (Option<Activity>, Verdict) {
        let (activity, verdict) = self.step(sample);
        self.in_charge |= activity.is_some();
        (activity, verdict)
    }

    fn step(&mut self, sample: &Sample) -> (Option<Activity>, Verdict) {
        // What stood in the way is not pulled at any longer. A finger that the routine left to itself is not touched.
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
            Routine::Zero(routine) => routine.step(&mut self.instruments, sample),
            Routine::Identify(routine) => {
                routine.step(&mut self.instruments, sample).map(|flow| flow.map_continue(taking_over))
            }
        };
        match stepped {
            Ok(Continue((activity, progress))) => (activity, Verdict::Going(progress)),
            Ok(Break(findings)) => (Some(motors_off), Verdict::Found(findings)),
            Err(obstacle) => refused(obstacle, self.in_charge),
        }
    }
}

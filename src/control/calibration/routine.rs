//! One routine from its beginning to its verdict.

use super::findings::Findings;
use super::identification::Identification;
use super::instruments::Instruments;
use super::obstacle::Obstacle;
use super::signs::SignSearch;
use super::zeroing::Zeroing;
use crate::control::signals::{Activity, Feedback, Report};
use crate::model::configuration::{ConfiguredController, ConfiguredFinger, Scheme, Unusable};
use nalgebra::Vector4;
use std::ops::ControlFlow::{self, Break, Continue};

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Which way motors, encoders and gauges count. Every motor turns a little, to and fro; nothing else moves fast.
    Signs,
    /// Zeros of gauges and encoders, the latter by the configured method.
    Zero,
    /// Gains of the gauges, friction of motors and joints, stiffness of tendons. The finger moves to its lower stops and presses against them.
    Identify,
}

/// What a routine sees of one cycle.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// What the board measured.
    pub feedback: &'a Feedback,
    /// What the last cycle found and decided.
    pub report: &'a Report,
    /// Whether the board says that its encoder counts are still good.
    pub zero_valid: bool,
}

/// What a routine is just doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Tendons are brought under tension.
    TakingUpSlack,
    /// Gauges are read with the tendons let out.
    ZeroingGauges,
    /// Counts are read.
    ReadingEncoders,
    /// A joint is on its way to a stop.
    SeekingStops,
    /// Motors turn one by one.
    TryingMotors,
    /// Joints are moved to and fro at two levels of tension.
    ComparingGauges,
    /// Joints are moved to and fro.
    MovingJoints,
    /// The finger presses against its stops.
    Pressing,
    /// Back to where it began.
    Returning,
}

/// How far a routine is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What it is doing.
    pub step: Step,
    /// The part of the routine that is done, roughly, 0 to 1.
    pub part: f64,
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

/// A routine under way.
#[derive(Clone, Debug)]
pub struct Calibration {
    instruments: Instruments,
    routine: Routine,
    seconds: f64,
    time_limit: f64,
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
        })
    }

    /// The same finger as its controller must be made while a routine runs at `rate`, Hz: by Figure 10, whatever is configured. State
    /// feedback is built upon the stiffness, friction and zeros that are looked for, and Figure 11 adapts to what the gauges show.
    /// Gains of Figure 10 that are configured stay.
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

    /// One cycle that has a measurement: what the motors shall do, and how it goes. Not to be called again after a verdict.
    pub fn cycle(&mut self, sample: &Sample) -> (Activity, Verdict) {
        self.seconds += self.instruments.period;
        if self.seconds > self.time_limit {
            return refused(Obstacle::TimeLimit { seconds: self.time_limit });
        }
        let stepped = match &mut self.routine {
            Routine::Signs(routine) => routine.step(&self.instruments, sample),
            Routine::Zero(routine) => routine.step(&mut self.instruments, sample),
            Routine::Identify(routine) => routine.step(&mut self.instruments, sample),
        };
        match stepped {
            Ok(Continue((activity, progress))) => (activity, Verdict::Going(progress)),
            Ok(Break(findings)) => (Activity::Turn(Vector4::zeros()), Verdict::Found(findings)),
            Err(obstacle) => refused(obstacle),
        }
    }
}

/// Motors off: whatever stood in the way is not pulled at any longer.
fn refused(obstacle: Obstacle) -> (Activity, Verdict) {
    (Activity::Turn(Vector4::zeros()), Verdict::Refused(obstacle))
}

/// What a routine's step yields: something to do, or what was found.
pub(super) type Stepped = Result<ControlFlow<Findings, (Activity, Progress)>, Obstacle>;

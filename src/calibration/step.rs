//! One step of a routine: what it sees, what it does, how far it is.

use super::findings::Findings;
use super::obstacle::Obstacle;
use crate::control::signals::{Activity, Feedback, Report};
use std::ops::ControlFlow;

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
    /// Joints are pushed lightly to find out whether something holds them in their pose.
    TryingPose,
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

/// What a routine's step yields: something to do, or what was found.
pub(super) type Stepped = Result<ControlFlow<Findings, (Activity, Progress)>, Obstacle>;

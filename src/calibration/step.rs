//! One step of a routine: its input, its output and its progress.

use super::findings::Findings;
use super::obstacle::Obstacle;
use crate::control::signals::{Activity, Feedback, Report};
use std::fmt;
use std::ops::ControlFlow;

/// What a routine receives in one cycle.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// The measurements of the board.
    pub feedback: &'a Feedback,
    /// The results of the previous cycle.
    pub report: &'a Report,
    /// Whether the board reports that its encoder counts are still valid.
    pub zero_valid: bool,
}

/// The current activity of a routine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Step {
    /// The tendons are being tightened.
    TakingUpSlack,
    /// The tendons are let out, and then the gauges are read.
    ZeroingGauges,
    /// Joints are pushed lightly, to check that something holds them in their pose.
    TryingPose,
    /// Encoders are read.
    ReadingEncoders,
    /// A joint moves to a stop.
    SeekingStops,
    /// Motors turn one by one.
    TryingMotors,
    /// Joints move back and forth at two levels of tension.
    MovingJoints,
    /// The common tension oscillates while the joints move slowly.
    OscillatingTensions,
    /// The finger presses against its stops.
    Pressing,
    /// The finger returns to its starting pose.
    Returning,
}

impl fmt::Display for Step {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str(match self {
            Step::TakingUpSlack => "taking up slack",
            Step::ZeroingGauges => "reading the gauges with slack tendons",
            Step::TryingPose => "pushing lightly to check that the pose is held",
            Step::ReadingEncoders => "reading the encoders",
            Step::SeekingStops => "moving the joints against their stops",
            Step::TryingMotors => "turning the motors one by one",
            Step::MovingJoints => "moving the joints",
            Step::OscillatingTensions => "making the tensions oscillate",
            Step::Pressing => "pressing against the stops",
            Step::Returning => "returning to the initial pose",
        })
    }
}

/// The progress of a routine.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// The current activity.
    pub step: Step,
    /// The approximate part of the routine that is done, 0 to 1.
    pub part: f64,
}

/// The result of one step: an activity, or the findings.
pub(super) type Stepped = Result<ControlFlow<Findings, (Activity, Progress)>, Obstacle>;

//! The person who commissions a finger: what the tool asks this person to do, and how the person answers.

use super::outcome::Outcome;
use super::step::Step;
use crate::failure::Failure;
use std::error::Error;
use std::fmt::{self, Display, Formatter};
use sun2xp::model::configuration::ConfiguredFinger;

/// What a person does at the finger. Parts have the numbers 1 to 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Act {
    PressEmergencyStop,
    ReleaseEmergencyStop,
    /// Turns a motor by one turn, so that its tendon comes loose.
    TurnMotor(usize),
    /// Turns the motor back.
    TurnMotorBack(usize),
    /// Says whether every tendon came loose when its motor was turned.
    ConfirmDirection,
    /// Loosens every tendon.
    Loosen,
    /// Hangs this weight, N, on a tendon.
    Hang(usize, f64),
    /// Removes the weight.
    Unhang(usize),
    /// Takes up most of the slack, and holds the finger still in any pose.
    HoldStill,
    /// Holds the finger in the zeroing pose, degrees.
    HoldPose([f64; 3]),
    /// Lets the finger go and clears its surroundings.
    LetGo,
    /// Pushes the tip and keeps pushing.
    Push,
    /// Ends the push.
    EndPush,
}

/// The standard acceleration of gravity, m/s^2.
pub const GRAVITY: f64 = 9.806_65;

impl Act {
    /// What the person is asked to do.
    pub fn text(&self) -> String {
        match self {
            Self::PressEmergencyStop => "Press the emergency stop.".into(),
            Self::ReleaseEmergencyStop => "Release the emergency stop.".into(),
            Self::TurnMotor(motor) => format!(
                "Turn motor {motor} by hand by one full turn, in the direction that pays its tendon out. Keep it there."
            ),
            Self::TurnMotorBack(motor) => format!("Turn motor {motor} back by the same turn."),
            Self::ConfirmDirection => {
                "All four encoders count backwards. Did each tendon come loose when you turned its motor?".into()
            }
            Self::Loosen => {
                "Loosen all four tendons: turn each motor by hand until its tendon hangs loose. Hang nothing on \
                 them."
                    .into()
            }
            Self::Hang(tendon, newton) => format!(
                "Hang {:.3} kg on tendon {tendon}, between its gauge and the finger. Let the weight come to rest.",
                newton / GRAVITY
            ),
            Self::Unhang(tendon) => format!("Take the weight off tendon {tendon}."),
            Self::HoldStill => {
                "Turn each motor by hand until its tendon is only just loose. Then hold the finger still, with a jig \
                 or a steady hand."
                    .into()
            }
            Self::HoldPose(pose) => format!(
                "Bring the finger into this pose, and turn each motor by hand until its tendon is only just loose. \
                 Hold the finger there with a jig or a steady hand, until its zeros are found (about 10 s):\n{}",
                crate::calibrate::pose(*pose)
            ),
            Self::LetGo => {
                "Let go of the finger, and clear the whole space that it can reach: it will move by itself.".into()
            }
            Self::Push => "Push the tip gently by about 5 mm, and hold it there.".into(),
            Self::EndPush => "Let go of the tip.".into(),
        }
    }
}

/// How a person answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is done.
    Done,
    /// It cannot be done: the part does not move, or does not exist.
    Cannot,
}

/// How a commissioning ends because of the person, and not because of an error.
#[derive(Debug)]
pub enum NoAnswer {
    /// The person leaves.
    Left,
    /// Nobody answers.
    InputEnded,
    /// The person does not want to try again after this failure.
    GivenUp(String),
}

impl Display for NoAnswer {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Left => "ended at your request, before the measurements were complete",
            Self::InputEnded => {
                "standard input ended at a question: run the tool in a terminal, or with --yes if a machine does \
                 what the tool asks for"
            }
            Self::GivenUp(failure) => failure,
        })
    }
}

impl Error for NoAnswer {}

/// The person, or the terminal in front of the person.
pub trait Person {
    /// A step begins.
    fn begin(&mut self, step: Step, finger: &ConfiguredFinger) -> Result<(), Failure>;

    /// Asks the person to do something, and waits for the answer.
    fn ask(&mut self, act: Act) -> Result<Answer, Failure>;

    /// Shows a result at once.
    fn show(&mut self, line: &str);

    /// Shows the result of a step.
    fn conclude(&mut self, outcome: &Outcome);

    /// After something has failed: asks the person to remove the cause, and returns whether to try again.
    fn again(&mut self, question: &str) -> Result<bool, Failure>;
}

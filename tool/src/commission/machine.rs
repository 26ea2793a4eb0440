//! What a commissioning needs of a finger: readings with the motors off, the routines of calibration, and the finger as
//! a spring (the running controller). A finger at a port and a finger in memory implement [`Machine`].

use crate::failure::Failure;
use std::fmt::{self, Display, Formatter};
use sun2xp::calibration::{Findings, Obstacle, Task};
use sun2xp::model::configuration::ConfiguredFinger;

/// Mean counts of the sensors over some time, with the motors off.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading {
    pub encoders: [f64; 4],
    pub gauges: [f64; 4],
    /// Noise of each gauge, counts rms.
    pub noise: [f64; 4],
}

/// Mean state of a finger that is a spring.
#[derive(Clone, Copy, Debug, Default)]
pub struct AtRest {
    /// Position of the tip, cm.
    pub tip: [f64; 3],
    /// Force of the tip, N.
    pub force: [f64; 3],
    /// N.
    pub tensions: [f64; 4],
    /// The tensions that the controller wants, N.
    pub intended: [f64; 4],
    /// Torques of the motors, N cm.
    pub torques: [f64; 4],
}

/// What a board says about itself.
#[derive(Clone, Debug, Default)]
pub struct BoardSeen {
    /// The board's name: unique number and firmware.
    pub name: String,
    /// Why the board refuses to work, for example a pressed emergency stop.
    pub refusal: Option<String>,
    pub emergency_stop: bool,
    pub supply_fault: bool,
}

/// The largest stiffness at which a finger is stable.
#[derive(Clone, Debug)]
pub struct Bound {
    /// N/cm.
    pub stiffness: f64,
    /// What prevents a larger stiffness.
    pub limit: String,
}

/// Why a routine gave no findings.
#[derive(Debug)]
pub enum Refused {
    /// The routine found an obstacle.
    Obstacle(Obstacle),
    /// The finger or the system failed.
    Failure(Failure),
}

impl<E: Into<Failure>> From<E> for Refused {
    fn from(error: E) -> Self {
        Self::Failure(error.into())
    }
}

impl Display for Refused {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Obstacle(obstacle) => obstacle.fmt(formatter),
            Self::Failure(failure) => failure.fmt(formatter),
        }
    }
}

/// One finger that is being commissioned.
pub trait Machine {
    /// Shakes hands with the board. The motors are off afterwards.
    fn board(&mut self) -> Result<BoardSeen, Failure>;

    /// Uses this configuration from now on. Switches the motors off if it differs from the present configuration.
    fn configure(&mut self, finger: &ConfiguredFinger) -> Result<(), Failure>;

    /// Averages the sensors over this time, s, with the motors off.
    fn read(&mut self, seconds: f64) -> Result<Reading, Failure>;

    /// Carries out a routine. After [`Task::Zero`] and [`Task::Identify`] the finger is a spring.
    fn carry_out(&mut self, task: Task) -> Result<Findings, Refused>;

    /// Averages the state of the finger, which must be a spring.
    fn at_rest(&mut self) -> Result<AtRest, Failure>;

    /// Makes the finger a spring that holds its present pose, with the configured zeros.
    fn spring(&mut self) -> Result<(), Refused>;

    /// Takes the torque off the motors.
    fn off(&mut self);

    /// The largest stiffness at which the finger is stable.
    fn bound(&mut self) -> Result<Bound, Failure>;

    /// What keeps this computer from running the finger in time.
    fn computer(&mut self) -> Result<Vec<String>, Failure>;
}

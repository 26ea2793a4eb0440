//! Replay: runs the pure controller over a recording. It must compute the same commands, to the last bit.

mod continuous;
mod remedy;
mod soundness;

pub use continuous::{ContinuousReplay, Recomputed, Step, Unsound};
pub use remedy::without_remedy;

use crate::control::Controller;
use crate::finger::recording::ALTERED;
use crate::finger::{ControlRecord, Origin, Recording};
use crate::model::configuration::Unusable;
use nalgebra::Vector4;
use std::collections::HashMap;
use thiserror::Error;

/// The result of a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Cycles in which a controller ran.
    pub cycles: usize,
    /// Cycles whose result differs from the recorded one.
    pub different: usize,
    /// The first cycle whose result differs.
    pub first: Option<Difference>,
}

/// A cycle whose result differs from the recorded one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Index of the cycle in the recording, from 0.
    pub index: usize,
    /// The recorded cycle.
    pub recorded: ControlRecord,
    /// The replayed cycle: its command and report are recomputed.
    pub replayed: ControlRecord,
}

/// The reason why a recording cannot be replayed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotReplayable {
    /// A value in `Recording::origin` is invalid, for example in the hand's configuration.
    #[error("line 1: {key}: {reason}. {ALTERED}")]
    Origin {
        /// The key, with dots.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// No controller can be constructed from a configuration.
    #[error("line 1: controller {number}: {key}: {reason}. {ALTERED}")]
    Unusable {
        /// Number of the controller.
        number: u32,
        /// The key.
        key: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// A cycle names a controller that the recording does not describe.
    #[error("cycle {cycle} names controller {number}, which the recording does not describe. {ALTERED}")]
    UnknownController {
        /// Number of the cycle.
        cycle: u64,
        /// Number of the controller.
        number: u32,
    },
    /// A cycle contains a value that no servo can have recorded.
    #[error("cycle {cycle}, line {line}: {key}: {reason}. {ALTERED}")]
    Cycle {
        /// Number of the cycle.
        cycle: u64,
        /// Its line in the file, from 1.
        line: usize,
        /// The key, with dots.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A controller computes a command that is not a finite number.
    #[error("cycle {0}: the controller commands a torque that is not a finite number. {ALTERED}")]
    NotFinite(u64),
}

impl Recording {
    /// Runs the controller over every cycle.
    ///
    /// # Errors
    /// Returns an error if no hand opens with the configuration, if the recording contains a number that no servo can
    /// have recorded, if a controller is missing, or if a controller computes a torque that is not finite. The error
    /// names the first wrong number, and nothing is computed from this number.
    pub fn replay(&self) -> Result<Replayed, NotReplayable> {
        self.replay_with(|_| {})
    }

    /// Like [`Recording::replay`]. Calls `progress` with the index of each cycle before it is computed.
    ///
    /// # Errors
    /// Returns the errors of [`Recording::replay`].
    pub fn replay_with(&self, mut progress: impl FnMut(usize)) -> Result<Replayed, NotReplayable> {
        self.check()?;
        let mut controllers = Controllers { recording: self, made: HashMap::new() };
        let mut state = self.origin.state;
        let mut replayed = Replayed { cycles: 0, different: 0, first: None };
        for (index, record) in self.cycles.iter().enumerate() {
            progress(index);
            let Some(recorded) = record.control else { continue };
            controllers.make(record.cycle, recorded.controller)?;
            controllers.make(record.cycle, recorded.previous)?;
            let present = &controllers.made[&recorded.controller];
            let previous = (recorded.previous != recorded.controller).then(|| &controllers.made[&recorded.previous]);
            let (command, report) = recorded.input.run(present, previous, &mut state, record.feedback.as_ref());
            if !command.is_finite() {
                return Err(NotReplayable::NotFinite(record.cycle));
            }
            replayed.cycles += 1;
            let replay = ControlRecord { command, report, ..recorded };
            if !same(&replay, &recorded) {
                replayed.different += 1;
                replayed.first.get_or_insert(Difference { index, recorded, replayed: replay });
            }
        }
        Ok(replayed)
    }
}

/// The controllers of a recording. Each controller is constructed when a cycle names it for the first time.
struct Controllers<'a> {
    recording: &'a Recording,
    made: HashMap<u32, Controller>,
}

impl Controllers<'_> {
    fn make(&mut self, cycle: u64, number: u32) -> Result<(), NotReplayable> {
        if self.made.contains_key(&number) {
            return Ok(());
        }
        let Origin { controllers, hand, .. } = &self.recording.origin;
        let source = controllers.iter().find(|source| source.number == number);
        let source = source.ok_or(NotReplayable::UnknownController { cycle, number })?;
        let made = Controller::in_gravity(&source.finger, &source.gravity, hand.rate);
        let unusable =
            |Unusable { key, reason }| NotReplayable::Unusable { number, key, reason: without_remedy(&reason) };
        self.made.insert(number, made.map_err(unusable)?);
        Ok(())
    }
}

/// Returns whether two controllers computed the same result: torques to the last bit, and equal reports.
fn same(one: &ControlRecord, other: &ControlRecord) -> bool {
    bits(&one.command.motor_torques) == bits(&other.command.motor_torques) && one.report == other.report
}

fn bits(torques: &Vector4<f64>) -> [u64; 4] {
    std::array::from_fn(|motor| torques[motor].to_bits())
}

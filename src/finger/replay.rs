//! The pure controller over a recording: what it commanded once it must command again, to the last bit.

use crate::control::Controller;
use crate::finger::{ControlRecord, Recording};
use nalgebra::Vector4;
use thiserror::Error;

/// What came of a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Replayed {
    /// Cycles in which a controller ran.
    pub cycles: usize,
    /// Those that came out otherwise than they were recorded.
    pub different: usize,
    /// The first of them.
    pub first: Option<Difference>,
}

/// A cycle that came out otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Its place in the recording, from 0.
    pub index: usize,
    /// As recorded.
    pub recorded: ControlRecord,
    /// As it came out now: command and report.
    pub replayed: ControlRecord,
}

/// A recording that nothing can be computed from.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum NotReplayable {
    /// A cycle names a controller that is not described.
    #[error("cycle {cycle} names controller {number}, which the recording does not describe")]
    UnknownController {
        /// The cycle.
        cycle: u64,
        /// The controller.
        number: u32,
    },
    /// A configuration that makes no controller.
    #[error("controller {number}: {key} {reason}")]
    Unusable {
        /// The controller.
        number: u32,
        /// The key.
        key: &'static str,
        /// Why.
        reason: String,
    },
}

impl Recording {
    /// Runs the controller over every cycle.
    ///
    /// # Errors
    /// A recording whose controllers are not all there.
    pub fn replay(&self) -> Result<Replayed, NotReplayable> {
        let mut controllers = Vec::new();
        for source in &self.origin.controllers {
            let made = Controller::in_gravity(&source.finger, &source.gravity, self.origin.hand.rate);
            let unusable = |unusable: crate::model::configuration::Unusable| NotReplayable::Unusable {
                number: source.number,
                key: unusable.key,
                reason: unusable.reason,
            };
            controllers.push((source.number, made.map_err(unusable)?));
        }
        let controller = |cycle, number| {
            let found = controllers.iter().find(|(own, _)| *own == number);
            found.map(|(_, controller)| controller).ok_or(NotReplayable::UnknownController { cycle, number })
        };
        let mut state = self.origin.state;
        let mut replayed = Replayed { cycles: 0, different: 0, first: None };
        for (index, record) in self.cycles.iter().enumerate() {
            let Some(recorded) = record.control else { continue };
            let present = controller(record.cycle, recorded.controller)?;
            let previous = match recorded.previous == recorded.controller {
                true => None,
                false => Some(controller(record.cycle, recorded.previous)?),
            };
            let (command, report) = recorded.input.run(present, previous, &mut state, record.feedback.as_ref());
            replayed.cycles += 1;
            let same =
                bits(&command.motor_torques) == bits(&recorded.command.motor_torques) && report == recorded.report;
            if !same {
                replayed.different += 1;
                let replay = ControlRecord { command, report, ..recorded };
                replayed.first.get_or_insert(Difference { index, recorded, replayed: replay });
            }
        }
        Ok(replayed)
    }
}

fn bits(torques: &Vector4<f64>) -> [u64; 4] {
    std::array::from_fn(|motor| torques[motor].to_bits())
}

//! The black box record of one cycle.

use crate::control::{Feedback, MotorCommand, Report};
use crate::finger::{ControlInput, Stage};
use crate::model::configuration::ConfiguredFinger;
use crate::model::snapshot;
use crate::realtime::CycleTiming;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One cycle of one finger. `S` is the type of the stage: [`Stage`], or, in a file, the name of the stage.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct CycleRecord<S = Stage> {
    /// Number of the cycle since open; the first is 1.
    pub cycle: u64,
    /// Beginning of the cycle, ns of the monotonic clock.
    pub began: u64,
    /// Stage of the finger at the end of the cycle.
    pub stage: S,
    /// Durations of the cycle's stages (`CycleStage`, not the stages of the finger), ns.
    pub timing: CycleTiming,
    /// Measurements of the reply; none if no reply came in this cycle.
    pub feedback: Option<Feedback>,
    /// Status bits of the newest reply.
    pub status: u16,
    /// Input and output of the controller; none if it did not run in this cycle.
    pub control: Option<ControlRecord>,
}

/// The input and the output of the controller.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControlRecord {
    /// Number of the controller.
    pub controller: u32,
    /// Number of the controller that this controller replaced in this cycle; its own number if it replaced none.
    pub previous: u32,
    /// Input of the controller.
    pub input: ControlInput,
    /// The command that is sent to the motors in the next cycle.
    pub command: MotorCommand,
    /// The controller's report.
    pub report: Report,
}

/// A record of a black box, and the range of cycles that the black box holds.
#[derive(Clone, Copy, Debug)]
pub struct KeptRecord {
    /// The record.
    pub record: CycleRecord,
    /// Number of the first cycle in the black box.
    pub oldest: u64,
    /// Number of the last cycle in the black box.
    pub newest: u64,
}

/// The data from which a controller is constructed.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControllerSource {
    /// Number of the controller since open; the first is 0.
    pub number: u32,
    /// Gravity in the finger's frame, m/s^2.
    pub gravity: Vector3<f64>,
    /// The finger's configuration.
    #[serde(serialize_with = "snapshot::serialize")]
    pub finger: ConfiguredFinger,
}

impl CycleRecord {
    /// Returns the record with the name of its stage.
    pub(super) fn in_words(&self) -> CycleRecord<String> {
        let Self { cycle, began, stage, timing, feedback, status, control } = *self;
        CycleRecord { cycle, began, stage: stage.to_string(), timing, feedback, status, control }
    }
}

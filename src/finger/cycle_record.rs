//! What a black box keeps of one cycle.

use crate::control::{Feedback, MotorCommand, Report};
use crate::finger::{ControlInput, Stage};
use crate::model::configuration::ConfiguredFinger;
use crate::realtime::CycleTiming;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One cycle of one finger. `S` is its [`Stage`], in a file the words for it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct CycleRecord<S = Stage> {
    /// Counted from open, the first is 1.
    pub cycle: u64,
    /// When it began, ns of the monotonic clock.
    pub began: u64,
    /// Where the finger was between open and close when it ended.
    pub stage: S,
    /// Where its time went, ns.
    pub timing: CycleTiming,
    /// What the reply measured; none: it was lost.
    pub feedback: Option<Feedback>,
    /// Status bits of the newest reply.
    pub status: u16,
    /// What the controller did; none where the finger faulted before it could.
    pub control: Option<ControlRecord>,
}

/// What the controller was given, and what it made of it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControlRecord {
    /// Number of the controller.
    pub controller: u32,
    /// Number of the controller from which it took over in this cycle; else its own.
    pub previous: u32,
    /// What it was told.
    pub input: ControlInput,
    /// What the motors were told in the next cycle.
    pub command: MotorCommand,
    /// What it found and decided.
    pub report: Report,
}

/// One of the records that are kept.
#[derive(Clone, Copy, Debug)]
pub struct KeptRecord {
    /// It.
    pub record: CycleRecord,
    /// The first cycle that is kept.
    pub oldest: u64,
    /// The last one.
    pub newest: u64,
}

/// What a controller was made from.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct ControllerSource {
    /// Counted from open, the first is 0.
    pub number: u32,
    /// In the finger's frame, m/s^2.
    pub gravity: Vector3<f64>,
    /// Everything else.
    pub finger: ConfiguredFinger,
}

impl CycleRecord {
    /// The stage in words.
    pub(super) fn in_words(&self) -> CycleRecord<String> {
        let Self { cycle, began, stage, timing, feedback, status, control } = *self;
        CycleRecord { cycle, began, stage: stage.to_string(), timing, feedback, status, control }
    }
}

//! Recordings as a sequence of rows, whatever their format.

mod black_box;

use crate::failure::Failure;
use crate::print::Progress;
use std::path::Path;
use sun2xp::control::Feedback;
use sun2xp::telemetry::Sample;

/// What a recording contains, in the order of time for each finger.
#[derive(Clone, Debug)]
pub enum Item {
    /// A finger appears for the first time.
    Finger(Finger),
    Cycle(Box<Row>),
    Mark(Mark),
}

/// A finger of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finger {
    pub number: i32,
    /// Hz.
    pub rate: f64,
}

/// One cycle of a finger.
#[derive(Clone, Debug)]
pub struct Row {
    pub sample: Sample,
    /// The stage, with the text of a fault.
    pub stage: String,
    /// The counts of the reply. `None` if it was lost.
    pub feedback: Option<Feedback>,
    /// The status bits of the newest reply.
    pub status: u16,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Time of the monotonic clock, ns.
    pub time: u64,
    /// `None` for an event of the whole hand.
    pub finger: Option<i32>,
    pub cycle: Option<u64>,
    pub kind: MarkKind,
    /// What happened, in words.
    pub text: String,
}

/// The kind of a mark, in increasing seriousness.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MarkKind {
    /// The finger is in another stage.
    Stage,
    /// An event that planners receive.
    Event,
    /// Cycles that the recording does not have.
    Gap,
    Warning,
    Fault,
}

impl MarkKind {
    pub fn name(self) -> &'static str {
        match self {
            MarkKind::Stage => "stage",
            MarkKind::Event => "event",
            MarkKind::Gap => "gap",
            MarkKind::Warning => "warning",
            MarkKind::Fault => "fault",
        }
    }
}

/// Receives the items of a recording.
pub type Visit<'a> = &'a mut dyn FnMut(Item) -> Result<(), Failure>;

/// Reads a recording, and passes its items on. `progress` shows the part that is read.
///
/// # Errors
/// Returns an error if the file is not a recording, or if `visit` does.
pub fn read(file: &Path, _progress: &Progress, visit: Visit) -> Result<(), Failure> {
    black_box::read(file, visit)
}

/// Finds changes of the stage and gaps between the cycles of one finger.
#[derive(Debug, Default)]
pub struct Changes {
    last: Option<(u64, String)>,
}

impl Changes {
    /// Returns the marks before this cycle.
    pub fn before(&mut self, row: &Row) -> Vec<Mark> {
        let Row { sample: Sample { finger, cycle, began, .. }, stage, .. } = row;
        let mark = |kind, text| Mark { time: *began, finger: Some(finger.get()), cycle: Some(*cycle), kind, text };
        let mut marks = Vec::new();
        if let Some((last, _)) = &self.last
            && *cycle > last + 1
        {
            let missing = cycle - last - 1;
            marks.push(mark(MarkKind::Gap, format!("{missing} cycles are not recorded")));
        }
        if self.last.as_ref().is_none_or(|(_, last)| last != stage) {
            let kind = if stage.starts_with("faulted") { MarkKind::Fault } else { MarkKind::Stage };
            marks.push(mark(kind, stage.clone()));
        }
        self.last = Some((*cycle, stage.clone()));
        marks
    }
}

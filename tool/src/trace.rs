//! Recordings and black boxes as a sequence of rows and marks.

#[cfg(test)]
mod tests;

use crate::failure::{Failure, complain, wrong_usage};
use crate::print::Progress;
use crate::recording::{self, Entry, Recording};
use std::borrow::Cow;
use std::ffi::OsStr;
use std::path::Path;
use sun2xp::control::Feedback;
use sun2xp::finger::events::{Event, EventKind};
use sun2xp::finger::{Fault, FaultKind, Stage};
use sun2xp::model::configuration::FINGERS;
use sun2xp::model::{Counted, Part, ShownPath};
use sun2xp::simulated::ObjectState;
use sun2xp::telemetry::{Description, Message, Sample, View};

/// Progress is counted in thousandths of the file.
const THOUSANDTHS: u64 = 1000;

/// An item of a recording. The cycles of a finger are in chronological order. An event may follow later cycles of its
/// finger.
#[derive(Clone, Debug)]
pub enum Item {
    /// A finger of the recorded hand. The fingers precede all other items.
    Finger(Finger),
    Cycle(Box<Row>),
    Mark(Mark),
    /// The object of a simulated hand, at a time of the monotonic clock, ns.
    Object(u64, ObjectState),
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
    /// Number of the finger; `None` if no finger is concerned.
    pub finger: Option<i32>,
    pub cycle: Option<u64>,
    pub kind: MarkKind,
    /// What happened, in words.
    pub text: String,
}

/// The kind of a mark, in increasing order of severity.
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

/// Reads a recording or a black box, and passes its items on. `what` names the work for the progress.
///
/// # Errors
/// Returns an error if the file is not a recording, if an entry cannot be read, or if `visit` returns an error.
pub fn read(file: &Path, what: &str, visit: Visit) -> Result<(), Failure> {
    let progress = Progress::new(what, THOUSANDTHS);
    let reach = |part: f64| progress.reach((part * THOUSANDTHS as f64) as u64);
    let (_, complete) = read_with(file, &reach, visit)?;
    drop(progress);
    if !complete {
        complain(&format!("{} has no end: its recorder was killed, or still runs", ShownPath(file)));
    }
    Ok(())
}

/// Returns the name of a recording or black box without its extension. What is made from the file is named after it.
pub fn stem(file: &Path) -> Result<Cow<'_, str>, Failure> {
    let named = || wrong_usage(format!("{} has no file name: name a recording or a black box", ShownPath(file)));
    file.file_stem().map(OsStr::to_string_lossy).ok_or_else(named)
}

/// Returns the time of the first cycle, ns of the monotonic clock. Returns none if the file has no cycle, or if an
/// entry that cannot be read precedes the first cycle. Marks may precede the first cycle.
///
/// # Errors
/// Returns an error if the file is not a recording.
pub fn first_cycle(file: &Path) -> Result<Option<u64>, Failure> {
    let mut entries = Recording::open(file)?.map_while(Result::ok);
    Ok(entries.find_map(|entry| match entry.item {
        recording::Item::Message(Message::Cycle { record, .. }) => Some(record.began),
        _ => None,
    }))
}

/// Reads a recording or a black box, and passes its items on. Returns the description of the hand, and whether the file
/// is complete. Calls `reach` with the part of the file that has been read, 0 to 1.
///
/// # Errors
/// Returns the errors of [`read`].
pub fn read_with(file: &Path, reach: &dyn Fn(f64), visit: Visit) -> Result<(Description, bool), Failure> {
    let mut recording = Recording::open(file)?;
    let description = recording.description().clone();
    for finger in &description.fingers {
        visit(Item::Finger(Finger { number: finger.get(), rate: description.configuration.hand.rate }))?;
    }
    let mut view = View::new(&description.configuration);
    let mut changes: [Changes; FINGERS] = Default::default();
    while let Some(entry) = recording.next() {
        let Entry { time, item } = entry?;
        reach(recording.progress());
        let time = time.wrapping_sub(description.clock_offset.cast_unsigned());
        let message = match item {
            recording::Item::Message(Message::Object(object)) => {
                visit(Item::Object(time, object))?;
                continue;
            }
            recording::Item::Message(message) => message,
            recording::Item::Lost { finger, cycles } => {
                let text = format!("{} not recorded", Counted(cycles, "cycle is", "cycles are"));
                let finger = Some(finger.get());
                visit(Item::Mark(Mark { time, finger, cycle: None, kind: MarkKind::Gap, text }))?;
                continue;
            }
        };
        if let Message::Event(event) = &message {
            changes[event.finger.index()].event(event).map_or(Ok(()), |mark| visit(Item::Mark(mark)))?;
        }
        let Some(sample) = view.take(&message) else { continue };
        let Message::Cycle { record, .. } = message else { continue };
        let change = changes[sample.finger.index()].before(&sample);
        change.map_or(Ok(()), |mark| visit(Item::Mark(mark)))?;
        visit(Item::Cycle(Box::new(Row { sample, feedback: record.feedback, status: record.status })))?;
    }
    Ok((description, recording.is_complete()))
}

/// Detects the changes of a finger's stage.
#[derive(Debug, Default)]
struct Changes {
    stage: Option<Stage>,
    /// The cycle in which the finger has faulted.
    faulted: u64,
}

impl Changes {
    /// Returns a mark if the stage differs from the stage in the previous cycle.
    fn before(&mut self, sample: &Sample) -> Option<Mark> {
        let before = self.stage.replace(sample.stage);
        if before == Some(sample.stage) {
            return None;
        }
        let fault = sample.fault().is_some();
        if fault {
            self.faulted = sample.cycle;
        }
        Some(Mark {
            time: sample.began,
            finger: Some(sample.finger.get()),
            cycle: Some(sample.cycle),
            kind: if fault { MarkKind::Fault } else { MarkKind::Stage },
            text: sample.stage.to_string(),
        })
    }

    /// Returns the mark for an event. Returns none for a fault whose cycle is recorded, because the change of the stage
    /// has marked it already.
    fn event(&self, event: &Event) -> Option<Mark> {
        let kind = match event.kind {
            EventKind::Fault if self.faulted != 0 && event.cycle.abs_diff(self.faulted) <= 1 => return None,
            EventKind::Fault => MarkKind::Fault,
            EventKind::Warning => MarkKind::Warning,
            _ => MarkKind::Event,
        };
        let (finger, cycle, text) = (Some(event.finger.get()), Some(event.cycle), words(event));
        Some(Mark { time: event.time, finger, cycle, kind, text })
    }
}

/// Returns an event as text: its name, its part, and its values with their meanings.
fn words(event: &Event) -> String {
    let Event { kind, part, values, .. } = event;
    if let (EventKind::Fault | EventKind::Warning, Some(fault)) = (kind, FaultKind::from_number(values[0] as i32)) {
        let mut fault = Fault::of(fault, values[1]);
        fault.part = *part;
        return fault.to_string();
    }
    let description = kind.description();
    let mut text = description.name.to_owned();
    if *part != Part::Finger {
        text += &format!(", {part}");
    }
    let mut values = values.iter();
    let meanings = description.values.iter().map(|meaning| {
        let numbers = values.by_ref().take(meaning.places()).map(|value| format!("{value:.3}")).collect::<Vec<_>>();
        format!("{}: {}", meaning.words(), numbers.join(", "))
    });
    let meanings = meanings.collect::<Vec<_>>().join("; ");
    if meanings.is_empty() { text } else { format!("{text} ({meanings})") }
}

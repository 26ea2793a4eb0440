//! The state of a hand as the views show it, from the messages of the hand. Nothing here draws or waits.

use super::finger_state::FingerState;
use super::words::event_text;
use serde::Serialize;
use std::collections::VecDeque;
use sun2xp::events::{Event, EventKind};
use sun2xp::finger::CycleRecord;
use sun2xp::model::configuration::{Configuration, FINGERS};
use sun2xp::telemetry::{Description, Message, View};
use sun2xp::{FingerNumber, Part};

/// Number of events that are kept.
const EVENTS: usize = 500;

/// An event is compared with this number of the newest events, to detect whether it repeats one of them.
const SUCCESSION: usize = 12;

/// Longest time between an event and its repetition, ns.
const SUCCESSION_TIME: u64 = 1_000_000_000;

/// What is known of a hand.
#[derive(Clone, Debug, Serialize)]
pub struct HandState {
    /// Name of the hand.
    pub name: String,
    /// Number of its process.
    pub process: u32,
    /// Version of the library in that process.
    pub library: String,
    /// Time at which the hand was opened, s since 1970, on the system's clock as it was set when this program attached.
    pub opened: u64,
    /// Configured rate, Hz.
    pub rate: f64,
    /// Whether any finger has a real port.
    pub real: bool,
    /// The open fingers.
    pub fingers: Vec<FingerState>,
    /// Events, in the order of their first occurrence, the newest first. A repetition changes the entry of its event,
    /// but not the place of the entry.
    pub events: VecDeque<EventState>,
}

/// Keeps the state of a hand up to date.
pub struct Tracker {
    /// The state.
    pub state: HandState,
    view: View,
    configuration: Configuration,
    /// Time since 1970 minus the time of the monotonic clock, ns.
    clock_offset: i64,
    /// For each finger, the newest cycle in which the controller ran, if it is not yet in the state.
    newest: [Option<CycleRecord>; FINGERS],
}

/// An event.
#[derive(Clone, Debug, Serialize)]
pub struct EventState {
    /// Number of the finger.
    pub finger: i32,
    /// Number of the cycle.
    pub cycle: u64,
    /// Time, ns since 1970.
    pub time: u64,
    /// Time, ns of the monotonic clock.
    #[serde(skip)]
    pub monotonic: u64,
    /// What happened, in words.
    pub text: String,
    /// Number of events of the same finger, kind and part that came in short succession and share this entry. Time and
    /// text are those of the last one.
    pub count: u32,
    #[serde(skip)]
    kind: (EventKind, Part),
    /// Whether the event is a fault.
    pub fault: bool,
    /// Whether the event is a warning.
    pub warning: bool,
}

impl HandState {
    fn new(description: &Description) -> Self {
        let configuration = &description.configuration;
        let real = |finger: &FingerNumber| !configuration.fingers[finger.index()].simulated();
        Self {
            name: description.name.clone(),
            process: description.process,
            library: description.library.clone(),
            opened: description.started,
            rate: configuration.hand.rate,
            real: description.fingers.iter().any(real),
            fingers: description.fingers.iter().map(|&finger| FingerState::new(finger, configuration)).collect(),
            events: VecDeque::new(),
        }
    }

    /// Returns the state of a finger, 1 to 3.
    pub fn finger(&self, number: i32) -> Option<&FingerState> {
        self.fingers.iter().find(|state| state.finger == number)
    }

    /// Returns whether a finger is faulted.
    pub fn faulted(&self) -> bool {
        self.fingers.iter().any(|finger| finger.fault.is_some())
    }

    fn finger_mut(&mut self, finger: FingerNumber) -> Option<&mut FingerState> {
        self.fingers.iter_mut().find(|state| state.finger == finger.get())
    }
}

impl Tracker {
    /// Returns the tracker of a hand before its first message.
    pub fn new(description: &Description) -> Self {
        Self {
            state: HandState::new(description),
            view: View::new(&description.configuration),
            configuration: description.configuration.clone(),
            clock_offset: description.clock_offset,
            newest: [None; FINGERS],
        }
    }

    /// Takes messages into account. `lost` is the number of cycles of each finger that are missing before or between
    /// them.
    pub fn apply(&mut self, messages: &[Message], lost: [u64; FINGERS]) {
        for finger in FingerNumber::ALL {
            if let Some(state) = self.state.finger_mut(finger) {
                state.lost_samples += lost[finger.index()];
            }
        }
        messages.iter().for_each(|message| self.take(message));
        // Only the newest cycle of a batch is shown, so only this one is converted.
        for (finger, newest) in FingerNumber::ALL.into_iter().zip(&mut self.newest) {
            if let (Some(record), Some(state)) = (newest.take(), self.state.finger_mut(finger)) {
                state.show(self.view.sample(finger, &record));
            }
        }
    }

    fn take(&mut self, message: &Message) {
        match message {
            Message::Controller { finger, source, hand } => {
                self.view.note_controller(*finger, source);
                self.configuration.fingers[finger.index()] = source.finger.clone();
                self.configuration.hand = (**hand).clone();
                if let Some(state) = self.state.finger_mut(*finger) {
                    state.configure(&self.configuration);
                }
            }
            Message::Cycle { finger, record } => {
                if let Some(state) = self.state.finger_mut(*finger) {
                    state.apply(record);
                }
                self.note_newest(*finger, record);
            }
            Message::Status(status) => {
                if let Some(state) = self.state.finger_mut(status.finger) {
                    state.note_status(status);
                    if let Some(record) = status.last.filter(|record| state.sample.is_none() && record.cycle > 0) {
                        self.note_newest(status.finger, &record);
                    }
                }
            }
            Message::Event(event) => self.note_event(event),
            Message::Keyframe { .. } | Message::Object(_) => {}
        }
    }

    fn note_newest(&mut self, finger: FingerNumber, record: &CycleRecord) {
        let newest = &mut self.newest[finger.index()];
        if record.control.is_some() && newest.is_none_or(|newest| newest.cycle < record.cycle) {
            *newest = Some(*record);
        }
    }

    fn note_event(&mut self, event: &Event) {
        let events = &mut self.state.events;
        let kind = (event.kind, event.part);
        let same = |known: &&mut EventState| known.finger == event.finger.get() && known.kind == kind;
        // A planner that sends a set point in every period causes hundreds of events, which would hide all others.
        if let Some(known) = events.iter_mut().take(SUCCESSION).find(same)
            && event.time.saturating_sub(known.monotonic) < SUCCESSION_TIME
        {
            known.note(event, self.clock_offset);
            known.count += 1;
            return;
        }
        let mut state = EventState {
            finger: event.finger.get(),
            cycle: 0,
            time: 0,
            monotonic: 0,
            text: String::new(),
            count: 1,
            kind,
            fault: event.kind == EventKind::Fault,
            warning: event.kind == EventKind::Warning,
        };
        state.note(event, self.clock_offset);
        events.push_front(state);
        events.truncate(EVENTS);
    }
}

impl EventState {
    fn note(&mut self, event: &Event, clock_offset: i64) {
        (self.cycle, self.monotonic) = (event.cycle, event.time);
        self.time = event.time.saturating_add_signed(clock_offset);
        self.text = event_text(event);
    }
}

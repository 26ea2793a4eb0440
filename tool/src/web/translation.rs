//! Translation of a hand's messages to those of the page: fewer samples, and texts for people.

use super::feed::publish;
use super::hub::{Hub, Kind};
use super::message::{
    Batch, Bounds, COLUMNS, EventMessage, FaultMessage, FingerMessage, HandMessage, LinkMessage, Quantiles, Row, Rows,
    StateMessage, StatusMessage, ToPage,
};
use crate::model::geometry;
use crate::monitor::words::event_text;
use sun2xp::events::{Event, EventKind};
use sun2xp::finger::CycleRecord;
use sun2xp::model::configuration::FINGERS;
use sun2xp::object::ObjectState;
use sun2xp::realtime::{CycleStage, now};
use sun2xp::telemetry::{Description, Message, Sample, Status, View};
use sun2xp::{Distribution, FingerNumber};

/// Time between two samples of a finger for the page, ns: 60 a second.
const SAMPLE: u64 = 1_000_000_000 / 60;

/// Shortest time between two messages for a stiffness that changes with the pose, ns.
const STIFFNESS: u64 = 100_000_000;

/// Smallest change of the stiffness that the page gets, relative to its largest entry.
const STIFFNESS_CHANGE: f64 = 0.01;

/// Translates the messages of one hand.
pub struct Translation<'a> {
    hub: &'a Hub,
    view: View,
    /// Beginning of the page's clock, ns of the monotonic clock.
    beginning: u64,
    clock_offset: i64,
    fingers: [Finger; FINGERS],
    object: Option<ObjectState>,
    batches: u64,
    cycles: u64,
    events: u64,
}

#[derive(Default)]
struct Finger {
    rows: Vec<Row>,
    /// Number of the last interval of [`SAMPLE`] that has a row.
    interval: u64,
    /// Largest delay of a wake-up since the last row, us.
    wake_up: f64,
    state: Option<StateMessage>,
    /// Time of the last state, ns.
    stated: u64,
}

impl<'a> Translation<'a> {
    /// Announces a hand to the page.
    pub fn new(description: &Description, control: bool, hub: &'a Hub) -> Self {
        let beginning = now();
        let message = hand(description, beginning, control);
        publish(hub, Kind::Hand, &ToPage::Hand(Box::new(message)));
        Self {
            hub,
            view: View::new(&description.configuration),
            beginning,
            clock_offset: description.clock_offset,
            fingers: Default::default(),
            object: None,
            batches: 0,
            cycles: 0,
            events: 0,
        }
    }

    /// Publishes messages. `lost` is the number of cycles that were lost so far.
    pub fn take(&mut self, messages: &[Message], lost: u64) {
        let before = self.cycles;
        for message in messages {
            match message {
                Message::Controller { finger, source, .. } => self.view.note_controller(*finger, source),
                Message::Cycle { finger, record } => self.cycle(*finger, record),
                Message::Event(event) => self.event(event),
                Message::Object(object) => self.object = Some(*object),
                Message::Status(status) => self.status(status),
                Message::Keyframe { .. } => {}
            }
        }
        self.publish_batch(lost, self.cycles - before);
    }

    fn publish_batch(&mut self, lost: u64, cycles: u64) {
        if self.fingers.iter().all(|finger| finger.rows.is_empty()) {
            return;
        }
        self.batches += 1;
        let fingers = FingerNumber::ALL.into_iter().zip(&self.fingers).filter(|(_, finger)| !finger.rows.is_empty());
        let batch = Batch {
            number: self.batches,
            lost,
            cycles: [cycles, self.cycles],
            fingers: fingers.map(|(number, finger)| Rows { finger: number.get(), rows: &finger.rows }).collect(),
            object: self.object.as_ref(),
        };
        publish(self.hub, Kind::Batch, &ToPage::Batch(batch));
        self.fingers.iter_mut().for_each(|finger| finger.rows.clear());
    }

    fn cycle(&mut self, number: FingerNumber, record: &CycleRecord) {
        self.cycles += 1;
        let finger = &mut self.fingers[number.index()];
        let wake_up = record.timing.duration(CycleStage::WakeUp).map_or(0.0, |time| f64::from(time) * 1e-3);
        finger.wake_up = finger.wake_up.max(wake_up);
        let interval = record.began / SAMPLE;
        let changed = finger.state.as_ref().is_some_and(|state| (state.fault.is_some()) != is_fault(record));
        if interval == finger.interval && !changed {
            return;
        }
        finger.interval = interval;
        self.show(number, record);
    }

    /// Adds the row of a cycle, and publishes the state of the finger if it has changed.
    fn show(&mut self, number: FingerNumber, record: &CycleRecord) {
        let sample = self.view.sample(number, record);
        let finger = &mut self.fingers[number.index()];
        let wake_up = std::mem::take(&mut finger.wake_up);
        finger.rows.push(row(&sample, seconds(record.began, self.beginning), wake_up));
        let state = state(&sample);
        let due = record.began.saturating_sub(finger.stated) >= STIFFNESS;
        let news = finger.state.as_ref().is_none_or(|last| differs(last, &state, due));
        if news {
            finger.stated = record.began;
            finger.state = Some(state.clone());
            publish(self.hub, Kind::State(number.get()), &ToPage::State(state));
        }
    }

    fn status(&mut self, status: &Status) {
        // A finger that had stopped before this reader was attached has no new cycles, so its last cycle is shown.
        if let Some(record) = status.last.as_ref().filter(|_| self.fingers[status.finger.index()].state.is_none()) {
            self.show(status.finger, record);
        }
        let message = StatusMessage {
            finger: status.finger.get(),
            wake_up: quantiles(&status.wake_up),
            cycle: quantiles(&status.whole),
            lost_replies: status.losses.lost_replies,
            skipped_periods: status.losses.skipped_periods,
            recoveries: status.recoveries,
            warnings: status.warning.iter().map(FaultMessage::new).collect(),
        };
        publish(self.hub, Kind::Status(status.finger.get()), &ToPage::Status(message));
    }

    fn event(&mut self, event: &Event) {
        self.events += 1;
        let message = EventMessage {
            number: self.events,
            finger: event.finger.get(),
            cycle: event.cycle,
            time: seconds(event.time, self.beginning),
            wall: event.time.saturating_add_signed(self.clock_offset) as f64 * 1e-9,
            severity: match event.kind {
                EventKind::Fault => "fault",
                EventKind::Warning => "warning",
                _ => "event",
            },
            name: event_text(event),
            text: event.kind.description().text,
        };
        publish(self.hub, Kind::Events, &ToPage::Events { events: [message] });
    }
}

fn hand<'a>(description: &'a Description, beginning: u64, control: bool) -> HandMessage<'a> {
    let configuration = &description.configuration;
    let finger = |number: &FingerNumber| {
        let finger = &configuration.fingers[number.index()];
        let (low, high) = finger.joint_limits();
        FingerMessage {
            number: number.get(),
            simulated: finger.simulated(),
            tension: Bounds { low: finger.tendon.minimum, high: finger.tendon.maximum },
            links: (0..3).map(|joint| LinkMessage { limits: [low[joint], high[joint]] }).collect(),
        }
    };
    HandMessage {
        identity: format!("{}-{}-{beginning}", description.process, description.started),
        name: &description.name,
        process: description.process,
        library: &description.library,
        started: description.started,
        rate: configuration.hand.rate,
        control,
        columns: COLUMNS,
        fingers: description.fingers.iter().map(finger).collect(),
        geometry: geometry(configuration),
    }
}

fn row(sample: &Sample, time: f64, wake_up: f64) -> Row {
    let mut row = [f64::NAN; COLUMNS.len()];
    let desired = sample.joint_set_point.unwrap_or([f64::NAN; 3]);
    let values = [time, sample.cycle as f64]
        .into_iter()
        .chain(sample.joints)
        .chain(desired)
        .chain(sample.tensions)
        .chain(sample.desired_tensions)
        .chain(sample.tip_force)
        .chain(sample.tip)
        .chain([sample.torque_scale, sample.stiffness_scale, wake_up]);
    for (place, value) in row.iter_mut().zip(values) {
        // Four digits after the point are more than a picture can show. They take half as many bytes as all digits.
        *place = (value * 1e4).round() * 1e-4;
    }
    row
}

fn state(sample: &Sample) -> StateMessage {
    let soft = sample.stiffness.as_flattened().iter().all(|&entry| entry == 0.0);
    StateMessage {
        finger: sample.finger.get(),
        stage: sample.stage_name(),
        fault: sample.fault().as_ref().map(FaultMessage::new),
        kx: sample.kx,
        stiffness: (!soft).then_some(sample.stiffness),
    }
}

/// Returns whether the page must get a new state. `due` is true if the last state is so old that a changed stiffness
/// may be sent.
fn differs(last: &StateMessage, now: &StateMessage, due: bool) -> bool {
    let without = |state: &StateMessage| StateMessage { stiffness: None, ..state.clone() };
    if without(last) != without(now) || last.stiffness.is_some() != now.stiffness.is_some() {
        return true;
    }
    let (Some(before), Some(after)) = (&last.stiffness, &now.stiffness) else { return false };
    let pairs = before.as_flattened().iter().zip(after.as_flattened());
    let largest = pairs.clone().map(|(before, _)| before.abs()).fold(0.0, f64::max);
    due && pairs.map(|(before, after)| (after - before).abs()).fold(0.0, f64::max) > STIFFNESS_CHANGE * largest
}

fn is_fault(record: &CycleRecord) -> bool {
    matches!(record.stage, sun2xp::Stage::Faulted(_))
}

fn quantiles(distribution: &Distribution) -> Quantiles {
    let Distribution { median, p99, p999, maximum, .. } = *distribution;
    Quantiles { median, p99, p999, most: maximum }
}

/// Returns the time from `beginning` to `time`, s. It is negative if `time` is earlier.
fn seconds(time: u64, beginning: u64) -> f64 {
    (time as i64).wrapping_sub(beginning as i64) as f64 * 1e-9
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;
    use sun2xp::Stage;
    use sun2xp::model::configuration::Configuration;

    /// The clock of the machine may be set between the measurement of `clock_offset` and the start of the translation.
    #[test]
    fn the_time_of_the_page_begins_at_zero_whatever_the_clock_of_the_machine_shows() {
        let description = Description {
            name: "hand".into(),
            process: 1,
            library: "test".into(),
            started: 1,
            clock_offset: 1_000_000_000,
            fingers: vec![FingerNumber::ONE],
            configuration: Configuration::default(),
        };
        let hub = Hub::new();
        let mut translation = Translation::new(&description, false, &hub);
        let (_, mut updates) = hub.subscribe();
        let record = CycleRecord {
            cycle: 1,
            began: now(),
            stage: Stage::Limp,
            timing: Default::default(),
            feedback: None,
            status: 0,
            control: None,
        };
        translation.take(&[Message::Cycle { finger: FingerNumber::ONE, record }], 0);
        let mut texts = std::iter::from_fn(|| updates.try_recv().ok()).filter(|update| update.kind == Kind::Batch);
        let batch: Value = serde_json::from_str(texts.next().expect("a batch").text.as_str()).expect("JSON");
        let time = batch["fingers"][0]["rows"][0][0].as_f64().expect("a time");
        // The bound is large, because the machine that runs the tests may be busy.
        assert!((0.0..60.0).contains(&time), "{time}");
    }
}

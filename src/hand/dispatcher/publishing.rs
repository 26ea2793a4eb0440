//! Publication of what the collecting thread collects, while a reader is attached.

use crate::finger::events::Event;
use crate::finger::{KEYFRAMES, Outlet};
use crate::hand::dispatcher::collected::Collected;
use crate::hand::dispatcher::member::Member;
use crate::hand::events::{EventSource, MergedEvents, Next};
use crate::hand::notice::print_notice;
use crate::model::configuration::{Configuration, ConfiguredHand};
use crate::realtime::{CycleStage, Mutex, is_memory_free, now, with_remedy};
use crate::simulated::ObjectView;
use crate::telemetry::{Outgoing, Publisher, Serving, Status};
use std::io;
use std::sync::Arc;

/// Interval between two publications of a finger's status, ns.
const STATUS_INTERVAL: u64 = 1_000_000_000;

/// Age of the oldest events that a first reader gets, ns. A first reader is one that attaches while there is no other
/// reader. A reader that asks to attach waits for the next publication, and must not miss what happens meanwhile.
const EARLIER_EVENTS: u64 = 250_000_000;

/// Memory for what a first reader needs besides the outlets, bytes.
const MEMORY_OF_READER: usize = 1 << 20;

/// Largest number of events in a batch: more than the logs of three fingers hold, 4096 each.
const MOST_EVENTS: usize = 16_384;

/// Publishes the data of a hand's fingers.
pub struct Publishing {
    publisher: Publisher,
    hand: ConfiguredHand,
    events: MergedEvents,
    object: Option<ObjectView>,
    members: Arc<Vec<Member>>,
    /// For each finger, an empty outlet. A publication exchanges this outlet for the one in which the finger's black
    /// box has collected records, and empties that outlet.
    outlets: Vec<Outlet>,
    /// For each finger, the number of the next controller to publish.
    controllers: Vec<u32>,
    next_status: u64,
    reading: bool,
}

impl Publishing {
    /// Makes the hand known to readers. Returns none if telemetry is not enabled. If the system refuses the socket,
    /// prints a notice and returns none, because a hand works without readers.
    pub(super) fn start(
        configuration: &Configuration,
        members: Arc<Vec<Member>>,
        events: &EventSource,
        object: Option<ObjectView>,
    ) -> Option<Self> {
        if !configuration.telemetry.enabled {
            return None;
        }
        let fingers = members.iter().map(|member| member.number).collect();
        match Publisher::open(configuration.clone(), fingers) {
            Ok(publisher) => Some(Self {
                publisher,
                hand: configuration.hand.clone(),
                events: MergedEvents::new(events),
                object,
                outlets: Vec::new(),
                controllers: vec![0; members.len()],
                members,
                next_status: 0,
                reading: false,
            }),
            Err(error) => {
                print_notice(&format!(
                    "no process can attach to this hand, because its socket cannot be made: {} (the hand opens \
                     nevertheless; with `telemetry.enabled = false` it makes no socket)",
                    with_remedy(&error)
                ));
                None
            }
        }
    }

    /// Publishes what has been collected since the last call.
    pub(super) fn publish(&mut self, fingers: &[Mutex<Collected>]) {
        let (rate, outlets) = (self.hand.rate, &mut self.outlets);
        match self.publisher.serve(|| prepare(rate, fingers, outlets)) {
            Serving::Nobody => return self.stop(fingers),
            Serving::Readers { new } => {
                if new {
                    self.controllers.fill(0);
                    self.next_status = 0;
                }
                if !self.reading {
                    self.events.skip_until(now().saturating_sub(EARLIER_EVENTS));
                    self.reading = true;
                }
            }
        }
        for (place, finger) in fingers.iter().enumerate() {
            self.publish_finger(place, finger);
        }
        for _ in 0..MOST_EVENTS {
            let Next::Event(event) = self.events.next(now()) else { break };
            self.publish_event(&event);
        }
        if let Some(object) = &self.object {
            self.publisher.publish(&Outgoing::Object(&object.state()));
        }
        if now() >= self.next_status {
            self.next_status = now() + STATUS_INTERVAL;
            self.publish_status(fingers);
        }
        self.publisher.end_batch();
    }

    fn publish_event(&mut self, event: &Event) {
        self.publisher.publish(&Outgoing::Event(event));
    }

    fn publish_finger(&mut self, place: usize, collected: &Mutex<Collected>) {
        let finger = self.members[place].number;
        {
            let black_box = &mut collected.lock().black_box;
            for source in black_box.controllers_from(self.controllers[place]) {
                self.publisher.publish(&Outgoing::Controller { finger, source, hand: &self.hand });
            }
            self.controllers[place] = black_box.next_number();
            black_box.controllers_published();
            black_box.exchange_outlet(&mut self.outlets[place]);
        }
        // The lock is released, because encoding takes longer than a planner's call should wait.
        self.publisher.publish_cycles(finger, &mut self.outlets[place]);
    }

    fn publish_status(&mut self, fingers: &[Mutex<Collected>]) {
        for (member, collected) in self.members.iter().zip(fingers) {
            let report = member.mailbox.report();
            let collected = collected.lock();
            let status = Status {
                finger: member.number,
                time: now(),
                stage: report.stage,
                losses: report.losses,
                wake_up: collected.histograms.distribution(CycleStage::WakeUp),
                whole: collected.histograms.distribution(CycleStage::Whole),
                warning: report.warnings.newest(),
                warnings: report.warnings.given(),
                recoveries: report.recoveries,
                last: collected.black_box.record(None).map(|kept| kept.record),
            };
            drop(collected);
            self.publisher.publish(&Outgoing::Status(&status));
        }
    }

    /// Stops copying records, because there is no reader any more.
    fn stop(&mut self, fingers: &[Mutex<Collected>]) {
        if self.reading || !self.outlets.is_empty() {
            fingers.iter().for_each(|collected| collected.lock().black_box.set_outlet(None));
            self.outlets = Vec::new();
            self.reading = false;
        }
    }
}

/// Makes the outlets of the fingers. The process of the hand must not run out of memory because of a reader.
fn prepare(rate: f64, fingers: &[Mutex<Collected>], outlets: &mut Vec<Outlet>) -> io::Result<()> {
    if !is_memory_free(MEMORY_OF_READER) {
        return Err(io::ErrorKind::OutOfMemory.into());
    }
    let outlet = || Outlet::new(rate, KEYFRAMES).map_err(|_| io::Error::from(io::ErrorKind::OutOfMemory));
    let new: Vec<(Outlet, Outlet)> = fingers.iter().map(|_| Ok((outlet()?, outlet()?))).collect::<io::Result<_>>()?;
    outlets.clear();
    for (collected, (one, other)) in fingers.iter().zip(new) {
        collected.lock().black_box.set_outlet(Some(one));
        outlets.push(other);
    }
    Ok(())
}

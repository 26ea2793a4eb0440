//! The last two seconds of a finger, kept at all times: the servo leaves one record a cycle in a ring, whoever collects
//! the reports keeps the newest.
//!
//! A replay needs the state of the controller where the records begin. The servo leaves a copy of it every few cycles,
//! and the records that are kept begin at such a keyframe. Rejected: the state in every record, which takes three times
//! the memory; a second controller that follows two seconds behind, which computes everything twice.

use crate::control::State;
use crate::finger::recording::{Origin, Recording};
use crate::finger::{ControllerSource, CycleRecord, KeptRecord, Stage};
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use crate::realtime::{Consumer, LockedMemory, Producer, ring};
use nalgebra::Vector3;
use std::collections::{BTreeSet, VecDeque};

/// How much is kept, s.
const KEPT: f64 = 2.0;

/// How long nobody may collect before records are lost, s.
const UNCOLLECTED: f64 = 0.5;

/// Keyframes in a second.
const KEYFRAMES: f64 = 8.0;

/// The state before a cycle.
struct Keyframe {
    cycle: u64,
    state: State,
}

/// The servo's end. Nothing here waits or allocates.
pub struct Recorder {
    records: Producer<CycleRecord>,
    keyframes: Producer<Keyframe>,
    /// Cycles from one keyframe to the next.
    apart: u64,
}

/// The collector's end: the last two seconds.
pub struct BlackBox {
    arriving: Consumer<CycleRecord>,
    keyframes_arriving: Consumer<Keyframe>,
    records: VecDeque<CycleRecord>,
    keyframes: VecDeque<Keyframe>,
    /// Cycles.
    length: u64,
    finger: i32,
    hand: ConfiguredHand,
    controllers: Vec<ControllerSource>,
    /// Number of a controller that waits for its calibration to take over, and until then is named by no record.
    awaited: Option<u32>,
    /// A fault has come in that [`BlackBox::faulted`] has not told yet.
    faulted: bool,
}

impl BlackBox {
    /// An empty one for the finger with this index, 0 to 2, whose first controller is made from `configuration`; and
    /// the servo's end of it.
    pub fn new(configuration: &Configuration, index: usize) -> (Recorder, Self) {
        let (hand, finger) = (&configuration.hand, configuration.fingers[index].clone());
        let cycles = |seconds: f64| (seconds * hand.rate).ceil() as usize;
        let apart = cycles(1.0 / KEYFRAMES);
        let (records, arriving) = ring(cycles(UNCOLLECTED));
        let (keyframes, keyframes_arriving) = ring(cycles(UNCOLLECTED).div_ceil(apart) + 1);
        let recorder = Recorder { records, keyframes, apart: apart as u64 };
        let black_box = Self {
            arriving,
            keyframes_arriving,
            // With room for all that they ever hold: whoever collects allocates nothing.
            records: VecDeque::with_capacity(cycles(KEPT + UNCOLLECTED + 2.0 / KEYFRAMES)),
            keyframes: VecDeque::with_capacity(cycles(KEPT + UNCOLLECTED).div_ceil(apart) + 4),
            length: cycles(KEPT) as u64,
            finger: index as i32 + 1, // 1 to 3
            hand: hand.clone(),
            controllers: vec![ControllerSource { number: 0, gravity: configuration.gravity(index), finger }],
            awaited: None,
            faulted: false,
        };
        (recorder, black_box)
    }

    /// The number of the next controller.
    pub fn next_number(&self) -> u32 {
        self.controllers.last().map_or(0, |last| last.number + 1)
    }

    /// Keeps what the next controller is made from, to be called before a record of the servo's that names it is
    /// collected. `taken`: the number of the one that the servo had taken
    /// ([`FingerReport::controller`](crate::finger::FingerReport::controller)) before the records were collected. What
    /// is older, and named by no record, is forgotten: it was overtaken before it was used.
    pub fn announce(&mut self, finger: ConfiguredFinger, gravity: Vector3<f64>, taken: u32) {
        let controls = self.records.iter().filter_map(|record| record.control.as_ref());
        let named: BTreeSet<u32> = controls.flat_map(|control| [control.controller, control.previous]).collect();
        let number = self.next_number();
        let awaited = self.awaited;
        let kept = |number: u32| number >= taken || named.contains(&number) || awaited == Some(number);
        self.controllers.retain(|controller| kept(controller.number));
        self.controllers.push(ControllerSource { number, gravity, finger });
    }

    /// The same for a controller that a calibration computes with once it takes over. Others may be announced before
    /// that.
    pub fn announce_calibration(&mut self, finger: ConfiguredFinger, gravity: Vector3<f64>, taken: u32) {
        self.awaited = None;
        self.announce(finger, gravity, taken);
        self.awaited = self.controllers.last().map(|last| last.number);
    }

    /// Takes in what the servo has left, and forgets what is too old.
    pub fn collect(&mut self) {
        while let Some(record) = self.arriving.pop() {
            self.faulted |= matches!(record.stage, Stage::Faulted(_));
            // A gap: nobody collected for too long, or the finger was faulted. What was before cannot be replayed
            // across it.
            if self.records.back().is_some_and(|last| last.cycle + 1 != record.cycle) {
                self.records.clear();
            }
            if self.awaited.is_some() && self.awaited == record.control.as_ref().map(|control| control.controller) {
                self.awaited = None;
            }
            self.records.push_back(record);
        }
        // After the records: a keyframe is left before the record of its cycle.
        while let Some(keyframe) = self.keyframes_arriving.pop() {
            self.keyframes.push_back(keyframe);
        }
        self.forget();
    }

    fn forget(&mut self) {
        let (Some(first), Some(newest)) = (self.records.front(), self.records.back()) else { return };
        let (first, newest) = (first.cycle, newest.cycle);
        // One that is old enough stays.
        while self.keyframes.get(1).is_some_and(|next| next.cycle + self.length <= newest + 1)
            || self.keyframes.front().is_some_and(|oldest| oldest.cycle < first)
        {
            self.keyframes.pop_front();
        }
        let from = self.keyframes.front().map_or(newest + 1, |oldest| oldest.cycle);
        let too_old = self.records.partition_point(|record| record.cycle < from);
        self.records.drain(..too_old);
        let controls = self.records.iter().filter_map(|record| record.control.as_ref());
        let needed = controls.map(|control| control.controller.min(control.previous)).min();
        if let Some(needed) = needed {
            let awaited = self.awaited;
            self.controllers.retain(|controller| controller.number >= needed || awaited == Some(controller.number));
        }
    }

    /// Whether a fault has come in since the last such call.
    pub fn faulted(&mut self) -> bool {
        std::mem::take(&mut self.faulted)
    }

    /// The record of a cycle, or the newest; none where it is not kept.
    pub fn record(&self, cycle: Option<u64>) -> Option<KeptRecord> {
        let (oldest, newest) = (self.records.front()?.cycle, self.records.back()?.cycle);
        // They are without a gap.
        let index = cycle.unwrap_or(newest).checked_sub(oldest)?;
        let record = *self.records.get(usize::try_from(index).ok()?)?;
        Some(KeptRecord { record, oldest, newest })
    }

    /// A copy of what is kept; none before the first cycle.
    pub fn recording(&self) -> Option<Recording> {
        let state = self.keyframes.front()?.state;
        let origin =
            Origin { finger: self.finger, hand: self.hand.clone(), controllers: self.controllers.clone(), state };
        Some(Recording::new(origin, self.records.iter().map(CycleRecord::in_words).collect()))
    }
}

impl Recorder {
    /// Leaves the state before a cycle, if its turn has come or the records `begin` with it.
    pub fn keyframe(&mut self, cycle: u64, state: &State, begin: bool) {
        if begin || cycle.is_multiple_of(self.apart) {
            // Where nobody collects it is lost, like the records.
            let _ = self.keyframes.push(Keyframe { cycle, state: *state });
        }
    }

    /// What its end of the rings touches.
    pub fn memory(&self) -> LockedMemory {
        let mut memory = LockedMemory::default();
        self.records.add_to(&mut memory);
        self.keyframes.add_to(&mut memory);
        memory
    }

    /// Leaves a record.
    pub fn record(&mut self, record: CycleRecord) {
        let _ = self.records.push(record);
    }
}

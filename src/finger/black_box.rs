//! The continuous recording of a finger. It holds the last two seconds. The servo writes one record per cycle into a
//! ring. The thread that collects from the servos keeps the newest records.
//!
//! A replay needs the state of the controller before the first record. The servo therefore writes a copy of the state,
//! a keyframe, eight times a second, and the kept records begin at a keyframe. Two alternatives were rejected: the
//! state in every record takes four times the memory, and a second controller that follows two seconds behind computes
//! everything twice.

use crate::control::State;
use crate::finger::outlet::{Keyframe, Outlet};
use crate::finger::recording::{Origin, Recording};
use crate::finger::{ControllerSource, CycleRecord, KeptRecord, Stage};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use crate::realtime::{Consumer, LockedMemory, Producer, ring};
use nalgebra::Vector3;
use std::collections::{BTreeSet, VecDeque};

/// Length of the recording, s.
const KEPT: f64 = 2.0;

/// Capacity of the rings, s. If nothing is collected for longer than this, records are lost.
const UNCOLLECTED: f64 = 0.5;

/// Keyframes per second.
pub const KEYFRAMES: f64 = 8.0;

/// The servo's end. It never waits or allocates.
pub struct Recorder {
    records: Producer<CycleRecord>,
    keyframes: Producer<Keyframe>,
    /// Cycles from one keyframe to the next.
    apart: u64,
}

/// The collector's end, which holds the last two seconds.
pub struct BlackBox {
    arriving: Consumer<CycleRecord>,
    keyframes_arriving: Consumer<Keyframe>,
    records: VecDeque<CycleRecord>,
    keyframes: VecDeque<Keyframe>,
    /// Length of the recording, cycles.
    length: u64,
    finger: i32,
    hand: ConfiguredHand,
    controllers: Vec<ControllerSource>,
    /// Number of the controller that the servo will use when a calibration begins. The source of this controller is
    /// kept although no record names the controller yet.
    awaited: Option<u32>,
    /// Number of the newest controller that the servo was known to have at the last announcement. After a calibration
    /// the servo resumes this controller or a newer one. If the calibration was longer than the kept records, no record
    /// names the controller any more, but its source is needed.
    held: u32,
    /// Whether a fault arrived that [`BlackBox::faulted`] has not reported yet.
    faulted: bool,
    /// Whether the records after a fault wait until [`BlackBox::faulted`] has reported the fault.
    waits_at_faults: bool,
    /// Copies of what arrives, while telemetry has a reader.
    outlet: Option<Outlet>,
    /// Controllers from this number on are not published yet. They are kept while there is an outlet.
    unpublished: u32,
}

impl BlackBox {
    /// Returns both ends of an empty black box for the finger with this number. `configuration` describes the first
    /// controller of the finger.
    pub fn new(configuration: &Configuration, number: FingerNumber) -> (Recorder, Self) {
        let (hand, finger) = (&configuration.hand, configuration.fingers[number.index()].clone());
        let cycles = |seconds: f64| (seconds * hand.rate).ceil() as usize;
        let apart = cycles(1.0 / KEYFRAMES);
        let (records, arriving) = ring(cycles(UNCOLLECTED));
        let (keyframes, keyframes_arriving) = ring(cycles(UNCOLLECTED).div_ceil(apart) + 1);
        let recorder = Recorder { records, keyframes, apart: apart as u64 };
        let black_box = Self {
            arriving,
            keyframes_arriving,
            // These capacities are not exceeded if records are collected at least every half second. The collector then
            // does not allocate.
            records: VecDeque::with_capacity(cycles(KEPT + UNCOLLECTED + 2.0 / KEYFRAMES)),
            keyframes: VecDeque::with_capacity(cycles(KEPT + UNCOLLECTED).div_ceil(apart) + 4),
            length: cycles(KEPT) as u64,
            finger: number.get(),
            hand: hand.clone(),
            controllers: vec![ControllerSource { number: 0, gravity: configuration.gravity(number), finger }],
            awaited: None,
            held: 0,
            faulted: false,
            waits_at_faults: false,
            outlet: None,
            unpublished: 0,
        };
        (recorder, black_box)
    }

    /// The number that the next announced controller gets.
    pub fn next_number(&self) -> u32 {
        self.controllers.last().map_or(0, |last| last.number + 1)
    }

    /// Stores the source of the next controller. The caller must do this before it collects a record that names the
    /// controller. `taken` is [`FingerReport::controller`](crate::finger::FingerReport::controller), read before the
    /// last [`BlackBox::collect`]. Controllers older than `taken` that no record names are removed: either the servo
    /// never used them, or the records of their cycles are no longer kept. The controller that is announced for a
    /// calibration is not removed, nor are those that telemetry still has to publish.
    pub fn announce(&mut self, finger: ConfiguredFinger, gravity: Vector3<f64>, taken: u32) {
        let controls = self.records.iter().filter_map(|record| record.control.as_ref());
        let named: BTreeSet<u32> = controls.flat_map(|control| [control.controller, control.previous]).collect();
        let number = self.next_number();
        let awaited = self.awaited;
        self.held = taken;
        let unpublished = self.first_unpublished();
        let kept = |number: u32| number >= taken.min(unpublished) || named.contains(&number) || awaited == Some(number);
        // The records that wait behind a fault may name older controllers too.
        if !self.waits() {
            self.controllers.retain(|controller| kept(controller.number));
        }
        self.controllers.push(ControllerSource { number, gravity, finger });
    }

    /// Like [`BlackBox::announce`], for the controller that the servo will use when a calibration begins. Other
    /// controllers may be announced before the calibration begins.
    pub fn announce_calibration(&mut self, finger: ConfiguredFinger, gravity: Vector3<f64>, taken: u32) {
        self.awaited = None;
        self.announce(finger, gravity, taken);
        self.awaited = self.controllers.last().map(|last| last.number);
    }

    /// Takes the servo's records and keyframes, and removes those that are too old.
    pub fn collect(&mut self) {
        self.take();
        self.forget();
    }

    /// Takes the servo's records and keyframes. [`BlackBox::collect`] must be called at least every half second.
    /// Otherwise the kept records exceed their capacity, and the collector allocates memory.
    fn take(&mut self) {
        while !self.waits()
            && let Some(record) = self.arriving.pop()
        {
            self.faulted |= matches!(record.stage, Stage::Faulted(_));
            self.outlet.iter_mut().for_each(|outlet| outlet.add_record(&record));
            // A gap occurs if nothing was collected for too long, or if the finger was faulted. A replay cannot cross a
            // gap.
            if self.records.back().is_some_and(|last| last.cycle + 1 != record.cycle) {
                self.records.clear();
            }
            if self.awaited.is_some() && self.awaited == record.control.as_ref().map(|control| control.controller) {
                self.awaited = None;
            }
            self.records.push_back(record);
        }
        // Keyframes are read after the records, because the servo writes a keyframe before the record of its cycle.
        while let Some(keyframe) = self.keyframes_arriving.pop() {
            self.outlet.iter_mut().for_each(|outlet| outlet.add_keyframe(&keyframe));
            self.keyframes.push_back(keyframe);
        }
    }

    /// Takes the servo's records, and appends those of the cycles after `cycle` to `records`. It does not go through
    /// all kept records, so it is fast enough to be called in every period.
    pub fn take_after(&mut self, cycle: u64, records: &mut Vec<CycleRecord>) {
        self.take();
        let after = self.records.partition_point(|record| record.cycle <= cycle);
        records.extend(self.records.range(after..));
    }

    fn forget(&mut self) {
        let (Some(first), Some(newest)) = (self.records.front(), self.records.back()) else { return };
        let (first, newest) = (first.cycle, newest.cycle);
        // The first keyframe is kept as long as the next one is less than two seconds old.
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
        if let Some(needed) = needed.map(|needed| needed.min(self.first_unpublished()).min(self.held)) {
            let awaited = self.awaited;
            self.controllers.retain(|controller| controller.number >= needed || awaited == Some(controller.number));
        }
    }

    fn first_unpublished(&self) -> u32 {
        if self.outlet.is_some() { self.unpublished } else { u32::MAX }
    }

    /// Sets the outlet to which everything that arrives is copied, or removes it.
    pub fn set_outlet(&mut self, outlet: Option<Outlet>) {
        self.outlet = outlet;
    }

    /// Exchanges the contents of the outlet, if there is one, for those of `other`, which must be empty.
    pub fn exchange_outlet(&mut self, other: &mut Outlet) {
        self.outlet.iter_mut().for_each(|outlet| std::mem::swap(outlet, other));
    }

    /// Returns the sources of the controllers that the records name or will name, from the number `from` on.
    pub fn controllers_from(&self, from: u32) -> impl Iterator<Item = &ControllerSource> {
        self.controllers.iter().filter(move |controller| controller.number >= from)
    }

    /// Notes that all controllers up to now are published.
    pub fn controllers_published(&mut self) {
        self.unpublished = self.next_number();
    }

    /// Whether a fault has arrived since the last call.
    pub fn faulted(&mut self) -> bool {
        std::mem::take(&mut self.faulted)
    }

    /// From now on, the records after a fault wait until [`BlackBox::faulted`] has reported the fault. Until then
    /// [`BlackBox::recording`] ends with the fault, even if the finger has recovered meanwhile.
    pub fn wait_at_faults(&mut self) {
        self.waits_at_faults = true;
    }

    /// Whether records wait behind a fault that is not reported yet.
    fn waits(&self) -> bool {
        self.waits_at_faults && self.faulted
    }

    /// Returns the record of `cycle`, or the newest record if `cycle` is `None`. Returns `None` if there is no such
    /// record.
    pub fn record(&self, cycle: Option<u64>) -> Option<KeptRecord> {
        let (oldest, newest) = (self.records.front()?.cycle, self.records.back()?.cycle);
        // The kept records have no gaps.
        let index = cycle.unwrap_or(newest).checked_sub(oldest)?;
        let record = *self.records.get(usize::try_from(index).ok()?)?;
        Some(KeptRecord { record, oldest, newest })
    }

    /// A copy of the recording; none before the first keyframe.
    pub fn recording(&self) -> Option<Recording> {
        let state = self.keyframes.front()?.state;
        let origin =
            Origin { finger: self.finger, hand: self.hand.clone(), controllers: self.controllers.clone(), state };
        Some(Recording::new(origin, self.records.iter().map(CycleRecord::in_words).collect()))
    }
}

impl Recorder {
    /// Writes a keyframe if one is due, or if `begin` is true. `begin` means that the records begin with this cycle.
    pub fn keyframe(&mut self, cycle: u64, state: &State, begin: bool) {
        if begin || cycle.is_multiple_of(self.apart) {
            // If nothing is collected for too long, the keyframe is lost, like the records.
            let _ = self.keyframes.push(Keyframe { cycle, state: *state });
        }
    }

    /// The memory of the servo's end.
    pub fn memory(&self) -> LockedMemory {
        let mut memory = LockedMemory::default();
        self.records.add_to(&mut memory);
        self.keyframes.add_to(&mut memory);
        memory
    }

    /// Writes a record.
    pub fn record(&mut self, record: CycleRecord) {
        let _ = self.records.push(record);
    }
}

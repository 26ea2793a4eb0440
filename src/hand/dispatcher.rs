//! The Dispatcher: passes each command to its finger and collects the reports. A command does not wake a thread, and
//! does not wait for one.

mod collected;
mod collecting;
mod member;
mod publishing;

pub(super) use member::Member;

use crate::finger::{self, Adjustable, BlackBox, CycleRecord, FingerReport, GroupGate, KeptRecord, Losses, Recording};
use crate::hand::HandError;
use crate::hand::dispatcher::collected::Collected;
use crate::hand::dispatcher::collecting::collect;
use crate::hand::dispatcher::publishing::Publishing;
use crate::hand::events::EventSource;
use crate::hand::opening::Reached;
use crate::model::configuration::{Configuration, ConfiguredFinger};
use crate::model::{FingerNumber, Fingers};
use crate::realtime::{CycleStage, Distribution, Histograms, Mutex, Priority, RwLock, spawn};
use crate::simulated::ObjectView;
use crossbeam_channel::{Sender, bounded};
use nalgebra::Vector3;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, MutexGuard};
use std::thread::JoinHandle;

/// Passes commands to the fingers, and collects their timings and black boxes.
pub(super) struct Dispatcher {
    members: Arc<Vec<Member>>,
    /// The fingers that the hand has. Not all of them need to be open.
    fingers: Fingers,
    /// Makes the set points of a group take effect in the same period.
    pub gate: GroupGate,
    collected: Arc<Vec<Mutex<Collected>>>,
    collector: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Dispatcher {
    /// `opened` are all opened fingers, in the order of their numbers. `gate` is the gate of their servos. `fingers`
    /// are the fingers that the hand has.
    pub fn new(opened: Vec<Reached>, fingers: Fingers, gate: GroupGate) -> Self {
        let (mut members, mut collected) = (Vec::new(), Vec::new());
        for finger in opened {
            members.push(Member {
                number: finger.number,
                admission: RwLock::new(finger.admission),
                mailbox: finger.mailbox,
                touch: finger.touch,
                reflexes: finger.reflexes,
                calibrated: Arc::default(),
            });
            collected.push(Mutex::new(Collected {
                arriving: finger.timings,
                histograms: Histograms::new(),
                losses_before: Losses::default(),
                black_box: finger.black_box,
            }));
        }
        Self { members: Arc::new(members), fingers, gate, collected: Arc::new(collected), collector: None }
    }

    /// Starts the thread that collects timings and black boxes, so that no data are lost if the planner makes no calls
    /// for a while. The thread also causes the black box of a faulted finger to be written into `folder`, and publishes
    /// what it collects to readers of telemetry.
    pub fn start_collecting(
        &mut self,
        folder: Option<PathBuf>,
        configuration: &Configuration,
        events: &EventSource,
        object: Option<ObjectView>,
    ) -> io::Result<()> {
        let (stop, stopped) = bounded(0);
        let fingers = self.collected.clone();
        let publishing = Publishing::start(configuration, self.members.clone(), events, object);
        let body = move |_| collect(&fingers, folder.as_deref(), publishing, &stopped);
        let thread = spawn("sun2xp reports", Priority::default(), body)?;
        self.collector = Some((stop, thread));
        Ok(())
    }

    /// Forgets the collecting thread. A forked child calls this, because it does not have the thread.
    pub fn forget_collector(&mut self) {
        std::mem::forget(self.collector.take());
    }

    /// Angles of joints 0, 1, 2 of a finger that is not faulted, rad.
    pub fn position(&self, finger: FingerNumber) -> Result<[f64; 3], HandError> {
        self.member(finger)?.mailbox.with_report(|report| match report.stage {
            finger::Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            _ => Ok(report.cycle.joints.into()),
        })
    }

    /// The newest report of a finger that is not faulted.
    pub fn report(&self, finger: FingerNumber) -> Result<FingerReport, HandError> {
        let report = self.last_report(finger)?;
        match report.stage {
            finger::Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            _ => Ok(report),
        }
    }

    /// The newest report of a finger, faulted or not.
    pub fn last_report(&self, finger: FingerNumber) -> Result<FingerReport, HandError> {
        Ok(self.member(finger)?.mailbox.report())
    }

    /// The distribution of the durations of one stage of the cycle.
    pub fn timing(&self, finger: FingerNumber, stage: CycleStage) -> Result<Distribution, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.histograms.distribution(stage))
    }

    /// Counts of cycles and errors.
    pub fn losses(&self, finger: FingerNumber) -> Result<Losses, HandError> {
        let place = self.place(finger)?;
        // The report and `losses_before` are read under one lock, so that no reset by another thread comes between
        // them.
        //
        // For each cycle, a servo publishes first the report and then the timing. A caller that reads the timings
        // before the losses therefore never gets a timing whose cycle is not counted. There is one exception: after
        // `reset_timing`, the timing of one cycle that is no longer counted may still arrive (see there).
        let collected = self.collected(finger)?;
        Ok(self.members[place].mailbox.report().losses.since(&collected.losses_before))
    }

    /// Resets timings and losses.
    pub fn reset_timing(&self, finger: FingerNumber) -> Result<(), HandError> {
        let place = self.place(finger)?;
        let mut collected = self.collected(finger)?;
        // The cycles up to the newest report are no longer counted, so their timings must be discarded. Therefore the
        // report is read before the timings. If the servo has published this report but not yet the timing of the same
        // cycle, that one timing is not discarded.
        collected.losses_before = self.members[place].mailbox.report().losses;
        collected.collect();
        collected.histograms.reset();
        Ok(())
    }

    /// The recording of the last two seconds; none before the first cycle.
    pub fn recording(&self, finger: FingerNumber) -> Result<Option<Recording>, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.black_box.recording())
    }

    /// The record of `cycle`, or of the newest cycle if `cycle` is none. Returns none if the black box does not contain
    /// the record.
    pub fn record(&self, finger: FingerNumber, cycle: Option<u64>) -> Result<Option<KeptRecord>, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.black_box.record(cycle))
    }

    /// Appends the records of the cycles after `cycle` to `records`.
    pub fn records_after(
        &self,
        finger: FingerNumber,
        cycle: u64,
        records: &mut Vec<CycleRecord>,
    ) -> Result<(), HandError> {
        self.collected(finger)?.black_box.take_after(cycle, records);
        Ok(())
    }

    /// Gives `adjustable` its number, and calls `give`, which passes it to the finger. If `give` succeeds, the black
    /// box stores the configuration from which `adjustable` was made. If `give` fails, the black box stores nothing.
    pub fn hand_over<T>(
        &self,
        finger: FingerNumber,
        configuration: &Configuration,
        adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
    ) -> Result<T, HandError> {
        self.announce(finger, configuration, adjustable, give, BlackBox::announce)
    }

    /// Like [`Dispatcher::hand_over`], for the controller that the servo will use when a calibration begins.
    pub fn hand_over_calibration<T>(
        &self,
        finger: FingerNumber,
        configuration: &Configuration,
        adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
    ) -> Result<T, HandError> {
        self.announce(finger, configuration, adjustable, give, BlackBox::announce_calibration)
    }

    fn announce<T>(
        &self,
        finger: FingerNumber,
        configuration: &Configuration,
        mut adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
        announce: impl FnOnce(&mut BlackBox, ConfiguredFinger, Vector3<f64>, u32),
    ) -> Result<T, HandError> {
        let place = self.place(finger)?;
        // The lock is held throughout. Otherwise a record that names the controller could be collected before the black
        // box has the controller's configuration.
        let mut collected = self.collected(finger)?;
        let taken = self.members[place].mailbox.report().controller;
        collected.collect();
        adjustable.number = collected.black_box.next_number();
        let given = give(adjustable)?;
        let (finger, gravity) = (configuration.fingers[finger.index()].clone(), configuration.gravity(finger));
        announce(&mut collected.black_box, finger, gravity, taken);
        Ok(given)
    }

    fn collected(&self, finger: FingerNumber) -> Result<MutexGuard<'_, Collected>, HandError> {
        Ok(self.collected[self.place(finger)?].lock())
    }

    /// All members, in the order of their numbers.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The member with this number.
    pub fn member(&self, finger: FingerNumber) -> Result<&Member, HandError> {
        self.place(finger).map(|place| &self.members[place])
    }

    fn place(&self, finger: FingerNumber) -> Result<usize, HandError> {
        let place = self.members.iter().position(|member| member.number == finger);
        place.ok_or(match self.fingers.contains(finger) {
            true => HandError::NotOpened(finger),
            false => HandError::NotInHand { finger, fingers: self.fingers },
        })
    }
}

impl Drop for Dispatcher {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.collector.take() {
            drop(stop);
            // The join fails only if the thread panicked, and then there is nothing else to do.
            let _ = thread.join();
        }
    }
}

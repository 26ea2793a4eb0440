//! The Dispatcher: hands each command to its finger and collects the reports. A command wakes no thread and waits for
//! none.

mod collected;
mod collecting;

use crate::finger::{self, Adjustable, BlackBox, FingerReport, KeptRecord, Losses, Mailbox, Recording};
use crate::hand::admission::Admission;
use crate::hand::dispatcher::collected::Collected;
use crate::hand::dispatcher::collecting::collect;
use crate::hand::opening::Reached;
use crate::hand::{Fingers, HandError};
use crate::model::configuration::{Configuration, ConfiguredFinger};
use crate::realtime::{CycleStage, Distribution, Histograms, Priority, spawn};
use crossbeam_channel::{Sender, bounded};
use nalgebra::Vector3;
use parking_lot::{Mutex, MutexGuard, RwLock};
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::thread::JoinHandle;

/// One finger as the planners see it.
pub(super) struct Member {
    /// 1 to 3.
    pub number: i32,
    pub admission: RwLock<Admission>,
    pub mailbox: Mailbox,
    /// Whether somebody calibrates the finger.
    pub calibrated: Arc<AtomicBool>,
}

/// Routes to the fingers, collects from them.
pub(super) struct Dispatcher {
    members: Vec<Member>,
    collected: Arc<Vec<Mutex<Collected>>>,
    collector: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Dispatcher {
    /// `fingers` in the order of their numbers: all that were opened.
    pub fn new(fingers: Vec<Reached>) -> Self {
        let (mut members, mut collected) = (Vec::new(), Vec::new());
        for finger in fingers {
            members.push(Member {
                number: finger.index as i32 + 1, // 1 to 3
                admission: RwLock::new(finger.admission),
                mailbox: finger.mailbox,
                calibrated: Arc::default(),
            });
            collected.push(Mutex::new(Collected {
                arriving: finger.timings,
                histograms: Histograms::new(),
                losses_before: Losses::default(),
                black_box: finger.black_box,
            }));
        }
        Self { members, collected: Arc::new(collected), collector: None }
    }

    /// Starts the thread that collects timings and black boxes, so that none is lost while nobody asks, and that has
    /// the black box of a finger that faults written into `folder`.
    pub fn start_collecting(&mut self, folder: Option<PathBuf>) -> io::Result<()> {
        let (stop, stopped) = bounded(0);
        let fingers = self.collected.clone();
        let body = move |_| collect(&fingers, folder.as_deref(), &stopped);
        let thread = spawn("sun2xp reports", Priority::default(), body)?;
        self.collector = Some((stop, thread));
        Ok(())
    }

    /// In a forked child, which has no such thread.
    pub fn forget_collector(&mut self) {
        std::mem::forget(self.collector.take());
    }

    /// Joints 0, 1, 2 of a finger that is not faulted, rad.
    pub fn position(&self, finger: i32) -> Result<[f64; 3], HandError> {
        self.member(finger)?.mailbox.look(|report| match report.stage {
            finger::Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            _ => Ok(report.cycle.joints.into()),
        })
    }

    /// The newest report of a finger that is not faulted.
    pub fn report(&self, finger: i32) -> Result<FingerReport, HandError> {
        let report = self.last_report(finger)?;
        match report.stage {
            finger::Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            _ => Ok(report),
        }
    }

    /// The newest report of a finger, faulted or not.
    pub fn last_report(&self, finger: i32) -> Result<FingerReport, HandError> {
        Ok(self.member(finger)?.mailbox.report())
    }

    /// What was counted of a stage.
    pub fn timing(&self, finger: i32, stage: CycleStage) -> Result<Distribution, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.histograms.distribution(stage))
    }

    /// What went wrong.
    pub fn losses(&self, finger: i32) -> Result<Losses, HandError> {
        let index = self.index(finger)?;
        // The report is read under the lock: a reset of another thread's is then before both or after both. A servo
        // reports a cycle before it tells its times: whoever reads these first counts none that is no cycle yet.
        let collected = self.collected(finger)?;
        Ok(self.members[index].mailbox.report().losses.since(&collected.losses_before))
    }

    /// Begins to count timings and losses anew.
    pub fn reset_timing(&self, finger: i32) -> Result<(), HandError> {
        let index = self.index(finger)?;
        let mut collected = self.collected(finger)?;
        // Before the times, for the same reason: those of a cycle that is not counted are collected here, but for one
        // that is just being told.
        collected.losses_before = self.members[index].mailbox.report().losses;
        collected.collect();
        collected.histograms.reset();
        Ok(())
    }

    /// The last two seconds; none before the first cycle.
    pub fn recording(&self, finger: i32) -> Result<Option<Recording>, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.black_box.recording())
    }

    /// One of the last two seconds' records.
    pub fn record(&self, finger: i32, cycle: Option<u64>) -> Result<Option<KeptRecord>, HandError> {
        let mut collected = self.collected(finger)?;
        collected.collect();
        Ok(collected.black_box.record(cycle))
    }

    /// Lets `give` hand a finger what was made from this configuration, under the number that it gets here. The black
    /// box keeps the configuration if that is done, and nothing of it where it is refused.
    pub fn hand_over<T>(
        &self,
        finger: i32,
        configuration: &Configuration,
        adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
    ) -> Result<T, HandError> {
        self.announce(finger, configuration, adjustable, give, BlackBox::announce)
    }

    /// The same for what a calibration computes with once it takes over.
    pub fn hand_over_calibration<T>(
        &self,
        finger: i32,
        configuration: &Configuration,
        adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
    ) -> Result<T, HandError> {
        self.announce(finger, configuration, adjustable, give, BlackBox::announce_calibration)
    }

    fn announce<T>(
        &self,
        finger: i32,
        configuration: &Configuration,
        mut adjustable: Adjustable,
        give: impl FnOnce(Adjustable) -> Result<T, HandError>,
        announce: impl FnOnce(&mut BlackBox, ConfiguredFinger, Vector3<f64>, u32),
    ) -> Result<T, HandError> {
        let index = self.index(finger)?;
        // Locked throughout: no record that names the controller is collected before the black box knows it.
        let mut collected = self.collected(finger)?;
        let taken = self.members[index].mailbox.report().controller;
        collected.collect();
        adjustable.number = collected.black_box.next_number();
        let given = give(adjustable)?;
        let (finger, gravity) = (configuration.fingers[index].clone(), configuration.gravity(index));
        announce(&mut collected.black_box, finger, gravity, taken);
        Ok(given)
    }

    fn collected(&self, finger: i32) -> Result<MutexGuard<'_, Collected>, HandError> {
        Ok(self.collected[self.index(finger)?].lock())
    }

    /// Every member, in the order of their numbers.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The member with a number.
    pub fn member(&self, finger: i32) -> Result<&Member, HandError> {
        self.index(finger).map(|index| &self.members[index])
    }

    fn index(&self, finger: i32) -> Result<usize, HandError> {
        let index = self.members.iter().position(|member| member.number == finger);
        index.ok_or_else(|| match Fingers::only(finger) {
            Ok(_) => HandError::NotOpened(finger),
            Err(there_is_none) => there_is_none,
        })
    }
}

impl Drop for Dispatcher {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.collector.take() {
            drop(stop);
            // It panics only if the histograms do, and then there is nothing to collect.
            let _ = thread.join();
        }
    }
}

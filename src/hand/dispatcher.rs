//! The Dispatcher: hands each command to its finger and collects the reports. A command wakes no thread and waits for none.

use crate::control::spatial;
use crate::finger::{FingerReport, Mailbox, Stage};
use crate::hand::HandError;
use crate::hand::admission::Admission;
use crate::realtime::{CycleTiming, Histograms, Priority, spawn};
use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use parking_lot::Mutex;
use rtrb::Consumer;
use std::io;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

/// How often timings are collected. The ring of a servo holds many times what comes in between.
const COLLECTING: Duration = Duration::from_millis(50);

/// One finger as the planners see it.
pub(super) struct Member {
    pub admission: Admission,
    pub mailbox: Mailbox,
    /// Which of the servo threads runs the finger, as an index into the timings.
    pub servo: usize,
}

/// Routes to the fingers, collects from them.
pub(super) struct Dispatcher {
    members: Vec<Member>,
    timings: Arc<Vec<Mutex<Collected>>>,
    collector: Option<(Sender<()>, JoinHandle<()>)>,
}

/// The timings of one servo thread.
struct Collected {
    arriving: Consumer<CycleTiming>,
    histograms: Histograms,
}

impl Collected {
    fn collect(&mut self) {
        while let Ok(timing) = self.arriving.pop() {
            self.histograms.record(&timing);
        }
    }
}

impl Dispatcher {
    /// `members` in the order of their numbers; `timings` by servo thread.
    pub fn new(members: Vec<Member>, timings: Vec<Consumer<CycleTiming>>) -> Self {
        let collected = |arriving| Mutex::new(Collected { arriving, histograms: Histograms::new() });
        Self { members, timings: Arc::new(timings.into_iter().map(collected).collect()), collector: None }
    }

    /// Starts the thread that collects timings, so that none is lost while nobody asks.
    pub fn start_collecting(&mut self) -> io::Result<()> {
        let (stop, stopped) = bounded(0);
        let timings = self.timings.clone();
        let thread = spawn("sun2xp reports", Priority::default(), move |_| collect(&timings, &stopped))?;
        self.collector = Some((stop, thread));
        Ok(())
    }

    /// theta_d, rad.
    pub fn send_position(&self, finger: i32, joints: [f64; 3]) -> Result<(), HandError> {
        let member = self.member(finger)?;
        let admitted = member.admission.joints(joints)?;
        let law = member.admission.law;
        let sent = member.mailbox.send(|set_point| (set_point.joints, set_point.law) = (admitted, law));
        sent.map_err(|fault| HandError::Faulted { finger, fault })
    }

    /// Kx, N/cm, row by row.
    pub fn send_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), HandError> {
        let member = self.member(finger)?;
        let admitted = member.admission.stiffness(rows)?;
        let sent = member.mailbox.send(|set_point| set_point.stiffness = spatial(&admitted));
        sent.map_err(|fault| HandError::Faulted { finger, fault })
    }

    /// The newest report of a finger that is not faulted.
    pub fn report(&self, finger: i32) -> Result<FingerReport, HandError> {
        let report = self.last_report(finger)?;
        match report.stage {
            Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            _ => Ok(report),
        }
    }

    /// The newest report of a finger, faulted or not.
    pub fn last_report(&self, finger: i32) -> Result<FingerReport, HandError> {
        Ok(self.member(finger)?.mailbox.report())
    }

    /// The timings of the thread that runs a finger.
    pub fn timings(&self, finger: i32) -> Result<Histograms, HandError> {
        let mut collected = self.timings[self.member(finger)?.servo].lock();
        collected.collect();
        Ok(collected.histograms.clone())
    }

    /// Every member, in the order of their numbers.
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// The member with a number.
    pub fn member(&self, finger: i32) -> Result<&Member, HandError> {
        let index = usize::try_from(finger).ok().and_then(|number| number.checked_sub(1));
        index.and_then(|index| self.members.get(index)).ok_or(HandError::NoSuchFinger(finger))
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

fn collect(timings: &[Mutex<Collected>], stopped: &Receiver<()>) {
    while stopped.recv_timeout(COLLECTING) == Err(RecvTimeoutError::Timeout) {
        timings.iter().for_each(|collected| collected.lock().collect());
    }
}

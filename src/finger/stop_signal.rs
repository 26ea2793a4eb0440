//! What stops a finger that nothing is wrong with: an emergency stop, or another finger that faults.

use crate::finger::FaultKind;
use crate::realtime::{LockedMemory, Pages, SharedPages};
use std::sync::atomic::{AtomicU32, Ordering};

/// Emergency stops called for in this process so far. Counted, so that a finger that recovers from one hears the next.
static CALLS: AtomicU32 = AtomicU32::new(0);

/// Emergency stop: every finger of every open hand of this process faults at the beginning of its next cycle. It stays
/// so until it recovers, or its hand is opened anew.
///
/// Adds to an atomic number and does nothing else: it serves in any thread and in a signal handler.
pub fn stop_all() {
    CALLS.fetch_add(1, Ordering::SeqCst);
}

/// How many emergency stops there were: a finger that begins now answers for later ones.
pub fn stop_calls() -> u32 {
    CALLS.load(Ordering::SeqCst)
}

/// One finger's ear.
#[derive(Clone)]
pub struct StopSignal {
    calls_heard: u32,
    /// Faults of all fingers that stop together; none: each stops alone.
    together: Option<SharedPages<AtomicU32>>,
    faults_heard: u32,
}

impl StopSignal {
    /// `together`: the fingers with clones of it stop together. `calls_heard`: of [`stop_calls`], from before anything
    /// moved.
    pub fn new(together: bool, calls_heard: u32) -> Self {
        Self { calls_heard, together: together.then(|| Pages::new(AtomicU32::new(0)).into()), faults_heard: 0 }
    }

    /// Adds the pages of what the fingers share.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        self.together.iter().for_each(|together| memory.add_shared(together));
    }

    /// Why the finger shall stop.
    pub(super) fn heard(&self) -> Option<FaultKind> {
        if stop_calls() != self.calls_heard {
            return Some(FaultKind::EmergencyStopCall);
        }
        let faults = self.together.as_ref()?.load(Ordering::Acquire);
        (faults != self.faults_heard).then_some(FaultKind::Companion)
    }

    /// The finger has faulted. What it has heard itself the others hear too.
    pub(super) fn raise(&self, kind: FaultKind) {
        if let Some(faults) = &self.together
            && !matches!(kind, FaultKind::EmergencyStopCall | FaultKind::Companion)
        {
            faults.fetch_add(1, Ordering::Release);
        }
    }

    /// The finger recovers: what was called before counts no more.
    pub(super) fn forget(&mut self, calls_heard: u32) {
        self.calls_heard = calls_heard;
        self.faults_heard = self.together.as_ref().map_or(0, |faults| faults.load(Ordering::Acquire));
    }
}

//! Signals that stop a healthy finger: an emergency stop call, or a fault of another finger.

use crate::finger::FaultKind;
use crate::realtime::atomics::{AtomicU32, Ordering, static_counter};
use crate::realtime::{LockedMemory, Pages, SharedPages};

static_counter! {
    /// Number of emergency stop calls in this process. It is a counter and not a flag, so that a finger that has
    /// recovered from one call stops at the next.
    CALLS
}

/// Emergency stop: every finger of every open hand in this process faults at the beginning of its next cycle. A finger
/// stays faulted until it recovers or its hand is opened again.
///
/// The function only increments an atomic number, so it may be called in any thread and in a signal handler.
pub fn stop_all() {
    CALLS.fetch_add(1, Ordering::SeqCst);
}

/// Number of emergency stop calls so far. A finger whose [`StopSignal`] begins with this number stops at the next call.
pub fn stop_calls() -> u32 {
    CALLS.load(Ordering::SeqCst)
}

/// How many requests to stop and how many faults there had been before a recovery began. The recovery clears these
/// requests and faults, but no later ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StopCounts {
    /// Number of emergency stop calls ([`stop_calls`]).
    pub calls: u32,
    /// Number of requests to stop the finger ([`Mailbox::stops`](crate::finger::Mailbox::stops)).
    pub of_finger: u32,
    /// Number of faults of the fingers that stop together ([`StopSignal::faults`]).
    pub faults: u32,
}

/// One finger's view of the stop signals.
#[derive(Clone)]
pub struct StopSignal {
    calls_seen: u32,
    /// Counter of the faults of all fingers that stop together; none if each finger stops alone.
    together: Option<SharedPages<AtomicU32>>,
    faults_seen: u32,
}

impl StopSignal {
    /// If `together` is true, all fingers with clones of this signal stop together. `calls_seen` is the result of
    /// [`stop_calls`] before any motor moved.
    pub fn new(together: bool, calls_seen: u32) -> Self {
        Self { calls_seen, together: together.then(|| Pages::new(AtomicU32::new(0)).into()), faults_seen: 0 }
    }

    /// The requests to stop that were made before any motor moved.
    pub(super) fn answered(&self) -> StopCounts {
        StopCounts { calls: self.calls_seen, ..StopCounts::default() }
    }

    /// Adds the pages that the fingers share to `memory`.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        self.together.iter().for_each(|together| memory.add_shared(together));
    }

    /// Why the finger must stop; none if it need not.
    pub(super) fn pending(&self) -> Option<FaultKind> {
        if stop_calls() != self.calls_seen {
            return Some(FaultKind::EmergencyStopCall);
        }
        let faults = self.together.as_ref()?.load(Ordering::Acquire);
        (faults != self.faults_seen).then_some(FaultKind::Companion)
    }

    /// Signals a fault of this finger to the others. A fault that a stop signal has caused is not passed on, because
    /// the other fingers receive the same stop signal.
    pub(super) fn raise(&self, kind: FaultKind) {
        if let Some(faults) = &self.together
            && !matches!(kind, FaultKind::EmergencyStopCall | FaultKind::Companion)
        {
            faults.fetch_add(1, Ordering::Release);
        }
    }

    /// Returns the number of faults so far of the fingers that stop together; 0 if each finger stops alone.
    pub fn faults(&self) -> u32 {
        self.together.as_ref().map_or(0, |faults| faults.load(Ordering::Acquire))
    }

    /// Clears the signals when the finger recovers: the calls and faults up to these counts do not stop it again. A
    /// fault of another finger after the recovery began still stops this finger.
    pub(super) fn forget(&mut self, stops: &StopCounts) {
        (self.calls_seen, self.faults_seen) = (stops.calls, stops.faults);
    }
}

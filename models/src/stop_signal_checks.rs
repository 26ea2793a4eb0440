//! Checks of `src/finger/stop_signal.rs`.

use super::FaultKind;
use super::stop_signal::{StopCounts, StopSignal, stop_all, stop_calls};
use crate::spawn;

/// Returns the numbers of stop calls and faults so far. A recovery that begins now clears these, and no later ones.
fn answered(signal: &StopSignal) -> StopCounts {
    StopCounts { calls: stop_calls(), of_finger: 0, faults: signal.faults() }
}

/// A recovery ignores the stop calls before its request, and no later one. Returns the pending fault just after the
/// recovery, and the pending fault after the later stop call.
pub fn a_stop_call_during_a_recovery_is_not_lost() -> (Option<FaultKind>, Option<FaultKind>) {
    let mut signal = StopSignal::new(false, stop_calls());
    stop_all();
    assert_eq!(signal.pending(), Some(FaultKind::EmergencyStopCall));
    let requested = answered(&signal);
    let caller = spawn(stop_all);
    signal.forget(&requested);
    let at_once = signal.pending();
    caller.join().expect("no panic");
    assert_eq!(signal.pending(), Some(FaultKind::EmergencyStopCall), "the later call is lost");
    (at_once, signal.pending())
}

/// A fault of one finger stops its companions, the fingers that stop together with it. The fault is passed on once: a
/// companion does not pass it back.
pub fn a_fault_stops_the_companion_once() {
    let first = StopSignal::new(true, stop_calls());
    let mut second = first.clone();
    let faulting = spawn(move || {
        first.raise(FaultKind::SlackTendon);
        first
    });
    // The second finger faults when it notices the signal. A fault of the kind `Companion` is not passed on.
    if let Some(kind) = second.pending() {
        assert_eq!(kind, FaultKind::Companion);
        second.raise(kind);
    }
    let first = faulting.join().expect("no panic");
    assert_eq!(second.pending(), Some(FaultKind::Companion), "the fault is lost");
    second.forget(&answered(&second));
    assert_eq!(second.pending(), None);
    let mut first = first;
    first.forget(&answered(&first));
    assert_eq!(first.pending(), None, "the companion's signal has returned");
}

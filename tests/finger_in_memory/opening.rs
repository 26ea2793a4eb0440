//! Fingers whose time to come under tension is limited: after the limit, a fault names the reason.

use crate::rig::{Bench, MILLISECOND};
use sun2xp::board::Transport;
use sun2xp::finger::{Fault, FaultKind, Stage};
use sun2xp::model::configuration::Configuration;

/// `hand.open_timeout_ms` of these tests.
const TIMEOUT_MS: u32 = 1500;

fn impatient(configuration: &mut Configuration) {
    configuration.hand.open_timeout_ms = TIMEOUT_MS;
}

/// Runs cycles until the finger is no longer opening. After each cycle, other work on the machine takes `pause`, ms.
/// Returns the fault, and the time from the beginning to the fault, ms.
fn fault_on_a_machine_with(bench: &mut Bench, pause: u64) -> (Fault, f64) {
    let begun = bench.world.now();
    while bench.stage() == Stage::Opening {
        bench.cycles(1);
        bench.with_cable(|cable| {
            let later = cable.now() + pause * MILLISECOND;
            cable.advance_to(later);
        });
    }
    let lasted = (bench.world.now() - begun) as f64 / MILLISECOND as f64;
    (bench.fault().expect("it does not open"), lasted)
}

#[test]
fn an_overloaded_machine_is_reported_at_the_time_out() {
    let mut bench = Bench::believing(impatient, |_| {});
    let (fault, lasted) = fault_on_a_machine_with(&mut bench, 15);
    assert!((1490.0..1550.0).contains(&lasted), "{lasted} ms: {fault}");
    assert_eq!(fault.kind, FaultKind::OpeningTimedOut, "{fault}");
    assert!((1500.0..1550.0).contains(&fault.value), "{fault}");
    for part in ["hand.open_timeout_ms", "under tension", "too few of its cycles", "machine"] {
        assert!(fault.to_string().contains(part), "{part:?} is not in: {fault}");
    }
}

#[test]
fn a_slack_tendon_is_reported_at_the_time_out() {
    // The motor unwinds its tendon instead of winding it. The machine is idle in the first run and busy in the second.
    for pause in [0, 3] {
        let mut bench = Bench::believing(impatient, |belief| belief.fingers[0].motor.sign = [1, 1, 1, -1]);
        let (fault, lasted) = fault_on_a_machine_with(&mut bench, pause);
        assert!((1490.0..1550.0).contains(&lasted), "{lasted} ms: {fault}");
        let expected = if pause == 0 { FaultKind::SlackTendon } else { FaultKind::OpeningTimedOut };
        assert_eq!(fault.kind, expected, "{fault}");
        assert!(fault.to_string().contains("hand.open_timeout_ms"), "{fault}");
    }
}

/// The time that `hand.open_timeout_ms` limits starts again with each recovery. A wait before the recovery does not
/// count.
#[test]
fn a_finger_that_recovers_has_as_much_time_again() {
    let mut bench = Bench::with(impatient);
    bench.fail_port(sun2xp::board::PortError::Vanished);
    bench.faults(FaultKind::PortVanished);
    bench.cycles(10);
    bench.with_cable(|cable| {
        let later = cable.now() + 10_000 * MILLISECOND;
        cable.advance_to(later);
    });
    bench.repair();
    bench.opens();
}

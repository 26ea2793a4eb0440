//! Gravity as an input of the servo: it takes effect in the next cycle, every record contains it, and a replay computes
//! the same commands across changes of gravity, a fault and a recovery.

use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use sun2xp::finger::{ControlRecord, FaultKind, Recording};

/// Gravity of a hand that turns once a second, m/s^2, after `cycle` periods.
fn turned(cycle: u64) -> Vector3<f64> {
    let angle = TAU * cycle as f64 * 1e-3;
    Vector3::new(1.0, 9.7 * angle.cos(), 9.7 * angle.sin())
}

/// Turns the finger for some cycles. The planner sends gravity and a set point every two periods.
fn turn(bench: &mut Bench, cycles: u64) {
    for cycle in 0..cycles / 2 {
        let gravity = turned(2 * cycle);
        bench.with_finger(|finger| finger.plant().set_gravity(gravity));
        bench.mailbox.set_gravity(gravity.into()).expect("not faulted");
        let pose = TARGET + Vector3::new(1e-5 * cycle as f64, 0.0, 0.0);
        bench.mailbox.send(|set_point| set_point.joints = pose).expect("not faulted");
        bench.cycles(2);
        assert_eq!(bench.report().set_point.joints, pose, "the set point of cycle {cycle} is lost");
        if cycle % 100 == 0 {
            bench.black_box.collect();
        }
    }
    bench.black_box.collect();
}

fn controls(recording: &Recording) -> impl Iterator<Item = ControlRecord> {
    recording.cycles.iter().filter_map(|record| record.control)
}

#[test]
fn gravity_that_changes_every_second_cycle_is_replayed_bit_for_bit() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    turn(&mut bench, 3000);
    let recording = bench.black_box.recording().expect("a recording");
    let replayed = recording.replay().expect("replayable");
    assert!(replayed.cycles >= 2000 && replayed.different == 0, "{replayed:?}");
    // No controller was replaced, and every change is in the records.
    assert_eq!(recording.origin.controllers.len(), 1);
    let values: Vec<_> = controls(&recording).map(|control| control.input.gravity.expect("gravity")).collect();
    let changes = values.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes >= values.len() / 2 - 1, "{changes} of {}", values.len());
    // A replay without the recorded gravity computes something else.
    let mut without = recording.clone();
    without.cycles.iter_mut().filter_map(|record| record.control.as_mut()).for_each(|it| it.input.gravity = None);
    assert!(without.replay().expect("replayable").different > 1000);
    // The finger has carried its weight.
    let error = (bench.report().cycle.joints - bench.report().set_point.joints).amax();
    assert!(error < 0.02, "{error} rad");
}

#[test]
fn a_faulted_finger_takes_gravity_when_it_recovers() {
    let mut bench = Bench::new();
    turn(&mut bench, 500);
    bench.mailbox.stop();
    bench.until("faulted", |bench| bench.fault().is_some());
    let down = Vector3::new(0.0, 0.0, -9.81);
    bench.with_finger(|finger| finger.plant().set_gravity(down));
    let fault = bench.mailbox.set_gravity(down.into()).expect_err("faulted");
    assert_eq!(fault.kind, FaultKind::FingerStopCall);
    bench.repair();
    bench.opens();
    bench.cycles(100);
    bench.black_box.collect();
    let recording = bench.black_box.recording().expect("a recording");
    assert!(controls(&recording).all(|control| control.input.gravity == Some(down)));
    assert_eq!(recording.replay().expect("replayable").different, 0);
}

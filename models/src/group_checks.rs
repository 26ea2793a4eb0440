//! Checks of `src/finger/group_gate.rs` and `src/finger/mailbox/groups.rs` with one planner and up to two servos.

use super::group_gate::GroupGate;
use super::mailbox::mailbox;
use super::mailbox_checks::running;
use super::{Adjustable, Replaced, Validity};
use crate::control::SetPoint;
use crate::realtime::atomics::{AtomicU64, Ordering};
use crate::spawn;
use loom::sync::Arc;

/// If two servos see a group, the group takes effect in both in the same period, whatever the times at which they see
/// it.
pub fn a_group_takes_effect_in_one_period() {
    let gate = GroupGate::new();
    // The number of the present period. Each reading increases it, as if a period had passed since the last reading.
    let clock = Arc::new(AtomicU64::new(1));
    let group = gate.number();
    let (other, others_clock) = (gate.clone(), clock.clone());
    let servo = spawn(move || other.period(group, || others_clock.fetch_add(1, Ordering::SeqCst)));
    gate.post(group);
    let own = gate.period(group, || clock.fetch_add(1, Ordering::SeqCst)).expect("it is posted");
    // If the other servo has not seen the group, it looks at the gate again in a later cycle.
    let others = servo.join().expect("no panic");
    let others = others.or_else(|| gate.period(group, || panic!("decided already"))).expect("it is posted");
    assert_eq!(own, others);
}

/// A servo that sees a posted group gets the set point that the group contains for its finger.
pub fn a_posted_group_has_its_set_points() {
    let report = running();
    let (planner, mut servo, mut memory) = mailbox(report, &Adjustable { number: 0 }, &[0.0; 3]);
    let gate = GroupGate::new();
    servo.set_gate(gate.clone(), &mut memory);
    let thread = spawn(move || {
        let change = |set_point: &mut SetPoint| {
            set_point.damping = 7.0;
            Ok::<_, ()>(())
        };
        let prepared = planner
            .prepare((Replaced::Other, Validity::default()), change)
            .expect("the finger is healthy")
            .expect("not refused");
        gate.send([Some(prepared), None, None]);
        (planner, gate)
    });
    let mut new = None;
    for period in 1..=2 {
        new = new.or(servo.new_group(period, || period));
    }
    let _planner = thread.join().expect("no panic");
    let new = new.or(servo.new_group(4, || 4)).or(servo.new_group(5, || 5));
    assert_eq!(new.map(|sent| sent.set_point.damping), Some(7.0));
}

//! Checks of `src/finger/mailbox.rs` with one planner and one servo.

use super::mailbox::{ServoEnd, mailbox};
use super::{Adjustable, FingerReport, Order, Stage};
use crate::control::SetPoint;
use crate::spawn;
use loom::thread;

/// Returns the report of a finger that is a spring for the first time.
pub fn running() -> FingerReport {
    let set_point = SetPoint::hard_finger(Default::default(), Default::default());
    FingerReport { stage: Stage::Running, springs: 1, ..FingerReport::opening(set_point) }
}

/// The servo's part of a cycle: takes an order and the data, as `take_commands` in `src/finger/servo/control.rs` does.
fn cycle(servo: &mut ServoEnd, report: &mut FingerReport) -> Option<Order> {
    let order = servo.new_order();
    if let Some(new) = servo.new_adjustable() {
        report.controller = new.number;
    }
    report.orders += u32::from(order.is_some());
    servo.publish(*report);
    order
}

/// A servo that has the order to restart also has the data to restart with. Every order that was accepted is taken.
pub fn an_order_comes_after_its_data() {
    let mut report = running();
    let (planner, mut servo, _) = mailbox(report, &Adjustable { number: 0 }, &[0.0; 3]);
    let thread = spawn(move || {
        let mut accepted = 0;
        for number in 1..=2 {
            let given = planner.restart(Adjustable { number }, false).expect("the finger is healthy");
            accepted += u32::from(given.is_some());
        }
        (planner, accepted)
    });
    for _ in 0..2 {
        if let Some(Order::Restart { .. }) = cycle(&mut servo, &mut report) {
            assert!(report.controller >= report.orders, "an order without its data");
        }
    }
    let (_planner, accepted) = thread.join().expect("no panic");
    cycle(&mut servo, &mut report);
    assert_eq!(report.orders, accepted, "an order is lost");
}

/// Each time a finger becomes a spring, a new spring phase begins (`FingerReport::springs`). A set point for an earlier
/// phase is not used. The servo makes an exception if the earlier phase ended because its set point expired. In this
/// model no set point expires. A set point that a planner sends after it has seen the new phase is used.
pub fn a_set_point_is_for_one_spring() {
    let mut report = running();
    let (planner, mut servo, _) = mailbox(report, &Adjustable { number: 0 }, &[0.0; 3]);
    let thread = spawn(move || {
        planner.send(|set_point| set_point.damping += 1.0).expect("the finger is healthy");
        planner
    });
    // A new spring phase begins. The planner's change must start from the set point of this phase.
    report.springs = 2;
    report.set_point.damping = 100.0;
    servo.publish(report);
    let new = new_set_point(&mut servo, report.springs);
    let planner = thread.join().expect("no panic");
    let new = new.or(new_set_point(&mut servo, report.springs));
    assert!(new.is_none_or(|new| new.damping == 101.0), "a set point of an earlier spring: {new:?}");
    planner.send(|set_point| set_point.damping += 1.0).expect("the finger is healthy");
    let newer = new_set_point(&mut servo, report.springs).expect("the set point arrives");
    assert_eq!(newer.damping, new.map_or(101.0, |new| new.damping + 1.0));
}

/// A request to close arrives, and so does the report of the end.
pub fn a_request_to_close_is_answered() {
    let mut report = running();
    let (planner, mut servo, _) = mailbox(report, &Adjustable { number: 0 }, &[0.0; 3]);
    let thread = spawn(move || {
        while !servo.closing() {
            thread::yield_now();
        }
        report.stage = Stage::Closed;
        servo.publish(report);
        servo
    });
    planner.close();
    let _servo = thread.join().expect("no panic");
    assert_eq!(planner.ended(), Some(true));
}

/// Returns the set point that has arrived for the spring with this number (`FingerReport::springs`).
fn new_set_point(servo: &mut ServoEnd, spring: u32) -> Option<SetPoint> {
    servo.new_set_point().filter(|sent| sent.spring == spring).map(|sent| sent.set_point)
}

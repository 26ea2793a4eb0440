//! Tactile events: from the elements of a simulated fingertip to the events of the finger.

use crate::rig::{Bench, MILLISECOND};
use nalgebra::Vector3;
use sun2xp::board::Transport;
use sun2xp::finger::FaultKind;
use sun2xp::finger::events::{Event, EventKind};
use sun2xp::model::configuration::{Configuration, TouchElement};
use sun2xp::simulated::{Defect, LineFault};

/// Two elements: one faces forward along the last link, the other sideways along the axis of joint 2.
fn two_elements(configuration: &mut Configuration) {
    let element = |normal| TouchElement { position: [0.0; 3], normal, newton_per_count: 0.001, zero: 200 };
    configuration.fingers[0].touch.elements = vec![element([0.0, 0.0, 1.0]), element([1.0, 0.0, 0.0])];
}

fn push(bench: &Bench, force: [f64; 3]) {
    bench.with_finger(|finger| {
        let turn = finger.plant().links().tip_rotation(&finger.plant().joints());
        finger.plant().set_external_force(turn * Vector3::from(force));
    });
}

fn touches(bench: &mut Bench) -> Vec<Event> {
    let touch = [
        EventKind::TouchMade,
        EventKind::TouchLost,
        EventKind::TouchSlip,
        EventKind::TouchPressure,
        EventKind::TouchInvalid,
    ];
    std::iter::from_fn(|| bench.events.take()).filter(|event| touch.contains(&event.kind)).collect()
}

#[test]
fn a_touch_is_an_event_of_the_next_cycle() {
    let mut bench = Bench::with(two_elements);
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    touches(&mut bench);
    let before = bench.report().losses.cycles;
    push(&bench, [0.0, 0.0, -0.3]);
    bench.cycles(2);
    let events = touches(&mut bench);
    let [event] = events[..] else { panic!("{events:?}") };
    assert_eq!((event.kind, event.values[0]), (EventKind::TouchMade, 0.0));
    assert!((event.values[1] - 0.3).abs() < 0.01, "{event:?}");
    assert!(event.cycle - before <= 2, "{event:?} after cycle {before}");
    let reading = bench.touch.reading(0).expect("an element");
    assert!(reading.valid && reading.pressed && (reading.force - 0.3).abs() < 0.01, "{reading:?}");
    // Nothing has pressed the other element, so its reading is not known.
    assert!(!bench.touch.reading(1).expect("an element").valid);
    push(&bench, [0.0; 3]);
    bench.cycles(2);
    let events = touches(&mut bench);
    assert_eq!(events.iter().map(|event| event.kind).collect::<Vec<_>>(), [EventKind::TouchLost]);
    assert_eq!(bench.touch.reading(2), None);
}

#[test]
fn a_tare_makes_the_present_counts_the_zeros() {
    let mut bench = Bench::with(two_elements);
    push(&bench, [0.0, 0.0, -0.3]);
    bench.cycles(3);
    let count = bench.touch.reading(0).expect("an element").count;
    bench.touch.tare();
    assert_eq!(bench.touch.zeros(), [count, 200]);
    assert_eq!(bench.touch.reading(0).expect("an element").force, 0.0);
}

#[test]
fn an_element_that_cannot_be_read_has_no_valid_reading() {
    let mut bench = Bench::with(two_elements);
    push(&bench, [-0.5, 0.0, 0.0]);
    bench.cycles(3);
    touches(&mut bench);
    assert!(bench.touch.reading(1).expect("an element").valid);
    assert!(bench.with_finger(|finger| finger.inject(&Defect::DeadElement(1))));
    assert!(!bench.with_finger(|finger| finger.inject(&Defect::DeadElement(2))));
    bench.cycles(2);
    let events = touches(&mut bench);
    let [event] = events[..] else { panic!("{events:?}") };
    assert_eq!((event.kind, event.values), (EventKind::TouchInvalid, [1.0, 0.0, 0.0, 0.0]));
    assert_eq!(bench.touch.reading(1), Some(Default::default()));
}

/// Frames are lost in both directions. Every event arrives once and in order, and the finger does not fault.
#[test]
fn no_touch_is_lost_on_a_bad_line() {
    let mut bench = Bench::with(two_elements);
    bench.cycles(100);
    touches(&mut bench);
    let until = u64::MAX;
    bench.with_cable(|cable| {
        cable.inject(LineFault::Drop, 0.05, until, 1);
        cable.inject_to_board(LineFault::Drop, 0.05, until, 2);
        cable.inject(LineFault::Duplicate, 0.05, until, 3);
        cable.inject(LineFault::Delay(MILLISECOND + 50_000), 0.05, until, 4);
    });
    for _ in 0..200 {
        push(&bench, [0.0, 0.0, -0.3]);
        bench.cycles(10);
        push(&bench, [0.0; 3]);
        bench.cycles(10);
    }
    assert_eq!(bench.fault(), None);
    let kinds: Vec<EventKind> = touches(&mut bench).iter().map(|event| event.kind).collect();
    let pairs = kinds.chunks(2).filter(|pair| **pair == [EventKind::TouchMade, EventKind::TouchLost]).count();
    assert_eq!((kinds.len(), pairs), (400, 200));
    assert_eq!((bench.touch.lost(), bench.touch.unknown()), (0, 0));
}

/// A board has 16 places for events. What does not fit is lost, and counted.
#[test]
fn a_burst_of_touches_is_counted() {
    let mut bench = Bench::with(two_elements);
    bench.cycles(100);
    touches(&mut bench);
    // The servo does not run while the finger is touched 30 times, which are 60 events.
    for touch in 0..60 {
        push(&bench, [0.0, 0.0, if touch % 2 == 0 { -0.3 } else { 0.0 }]);
        bench.with_cable(|cable| cable.advance_to(cable.now() + 100_000));
    }
    bench.cycles(100);
    assert_eq!(touches(&mut bench).len() as u64 + bench.touch.lost(), 60);
    assert!(bench.touch.lost() >= 44);
    assert_eq!(bench.fault(), None);
}

/// A board with more elements than configured.
#[test]
fn an_element_that_is_not_configured_is_counted() {
    let mut bench = Bench::believing(two_elements, |belief| belief.fingers[0].touch.elements.truncate(1));
    bench.opens();
    push(&bench, [-0.5, 0.0, 0.0]);
    bench.cycles(3);
    assert!(touches(&mut bench).is_empty());
    assert_eq!(bench.touch.unknown(), 1);
}

/// The servo of a finger without configured elements does not ask the board for touch events.
#[test]
fn a_finger_without_elements_sends_no_requests() {
    let mut bench = Bench::believing(two_elements, |belief| belief.fingers[0].touch.elements.clear());
    bench.opens();
    push(&bench, [-0.5, 0.0, 0.0]);
    bench.cycles(3);
    assert!(touches(&mut bench).is_empty());
    assert_eq!((bench.touch.unknown(), bench.touch.count()), (0, 0));
}

/// Ends the contact of a pressed element, and resets the board before the board has reported the end of the contact.
/// Then presses element 0 while the finger is faulted.
fn resets(bench: &mut Bench) {
    push(bench, [0.0; 3]);
    bench.with_finger(|finger| finger.reset());
    bench.faults(FaultKind::BoardReset);
    push(bench, [0.0, 0.0, -0.3]);
    bench.repair();
    bench.opens();
}

/// A board that was reset numbers its events from 1 again, and has lost none.
#[test]
fn a_reset_of_the_board_loses_no_touch() {
    let mut bench = Bench::with(two_elements);
    bench.cycles(100);
    touches(&mut bench);
    push(&bench, [0.0, 0.0, -0.3]);
    bench.cycles(3);
    assert_eq!(touches(&mut bench).len(), 1);
    // The event of the contact after the reset has the same number as that of the contact before the reset.
    resets(&mut bench);
    let kinds: Vec<EventKind> = touches(&mut bench).iter().map(|event| event.kind).collect();
    assert_eq!(kinds, [EventKind::TouchMade]);
}

#[test]
fn events_that_were_lost_before_a_reset_of_the_board_count_once() {
    let mut bench = Bench::with(two_elements);
    bench.cycles(100);
    for touch in 0..61 {
        push(&bench, [0.0, 0.0, if touch % 2 == 0 { -0.3 } else { 0.0 }]);
        bench.with_cable(|cable| cable.advance_to(cable.now() + 100_000));
    }
    bench.cycles(100);
    let lost = bench.touch.lost();
    assert!(lost >= 44, "{lost}");
    resets(&mut bench);
    assert_eq!(bench.touch.lost(), lost);
}

/// A board that was reset assumes that no element is pressed, so it never reports the end of a contact from before the
/// reset.
#[test]
fn a_reset_of_the_board_makes_its_readings_invalid() {
    let mut bench = Bench::with(two_elements);
    push(&bench, [-0.5, 0.0, 0.0]);
    bench.cycles(3);
    assert!(bench.touch.reading(1).expect("an element").pressed);
    resets(&mut bench);
    assert_eq!(bench.touch.reading(1), Some(Default::default()));
}

/// A board that loses its power is silent. It has no readings when it is on again.
#[test]
fn a_fault_of_the_line_makes_the_readings_invalid() {
    let mut bench = Bench::with(two_elements);
    push(&bench, [-0.5, 0.0, 0.0]);
    bench.cycles(3);
    assert!(bench.touch.reading(1).expect("an element").pressed);
    bench.with_cable(|cable| cable.inject(LineFault::Drop, 1.0, u64::MAX, 1));
    bench.faults(FaultKind::LostReplies);
    assert!(bench.touch.reading(1).expect("an element").pressed, "a faulted finger keeps its readings");
    push(&bench, [0.0; 3]);
    bench.with_finger(|finger| finger.reset());
    bench.with_cable(|cable| cable.clear());
    bench.repair();
    bench.opens();
    assert_eq!((bench.touch.reading(1), bench.touch.lost()), (Some(Default::default()), 0));
}

/// A board may lose its power while its finger is faulted for another reason.
#[test]
fn a_reset_of_the_board_of_a_faulted_finger_makes_its_readings_invalid() {
    let mut bench = Bench::with(two_elements);
    push(&bench, [0.0, 0.0, -0.3]);
    bench.cycles(3);
    let stop = |bench: &mut Bench| {
        bench.mailbox.stop();
        bench.faults(FaultKind::FingerStopCall);
    };
    stop(&mut bench);
    bench.repair();
    bench.opens();
    assert!(bench.touch.reading(0).expect("an element").pressed, "the board was not reset");
    stop(&mut bench);
    push(&bench, [0.0; 3]);
    bench.with_finger(|finger| finger.reset());
    bench.repair_after(1);
    bench.opens();
    assert_eq!((bench.touch.reading(0), bench.touch.lost()), (Some(Default::default()), 0));
    // The number of resets is still 1, so the next recovery finds no further reset.
    push(&bench, [0.0, 0.0, -0.3]);
    bench.cycles(3);
    stop(&mut bench);
    bench.repair_after(1);
    bench.opens();
    assert!(bench.touch.reading(0).expect("an element").pressed);
}

//! The events of a finger, with the cycle and the time of each.

use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use sun2xp::finger::events::{Event, EventKind};
use sun2xp::finger::{FaultKind, FingerReport};
use sun2xp::model::{FingerNumber, Part};
use sun2xp::simulated::Defect;

/// Runs the given number of periods. Returns each event with the report of the cycle in which it appeared, and checks
/// that its stamp is that of this cycle.
fn events(bench: &mut Bench, periods: usize) -> Vec<(Event, FingerReport)> {
    let mut found = Vec::new();
    for _ in 0..periods {
        bench.cycles(1);
        let report = bench.report();
        while let Some(event) = bench.events.take() {
            assert_eq!((event.cycle, event.time), (report.losses.cycles, report.last), "{event:?}");
            assert_eq!(event.finger, FingerNumber::ONE);
            found.push((event, report));
        }
    }
    assert_eq!(bench.events.lost(), 0);
    found
}

fn kinds(found: &[(Event, FingerReport)]) -> Vec<EventKind> {
    found.iter().map(|(event, _)| event.kind).collect()
}

#[test]
fn a_move_arrives_and_settles_once_in_the_cycle_of_the_event() {
    let mut bench = Bench::new();
    assert_eq!(kinds(&events(&mut bench, 300)), [], "opening is no arrival");
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    let found = events(&mut bench, 1500);
    assert_eq!(kinds(&found), [EventKind::Arrived, EventKind::Settled]);
    let (arrived, report) = found[0];
    let off = |joints: Vector3<f64>| (joints - TARGET).amax().to_degrees();
    assert!((1.0..=2.0).contains(&off(report.cycle.joints)), "{} degrees", off(report.cycle.joints));
    assert_eq!(arrived.values[..3], *report.cycle.joints.as_slice());
    assert!(report.arrival.arrived && !report.arrival.settled);
    let (settled, report) = found[1];
    assert!(settled.cycle >= arrived.cycle + 50 && report.arrival.settled, "{settled:?} after {arrived:?}");
    // The same set point again is no change.
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    assert_eq!(kinds(&events(&mut bench, 300)), []);
}

#[test]
fn a_joint_at_its_limit_and_a_tension_beyond_its_bound_are_events() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].events.tension_above = Some(11.0));
    let (_, high) = sun2xp::Configuration::default().fingers[0].joint_limits();
    bench.mailbox.send(|set_point| set_point.joints = Vector3::new(0.0, high[1], 1.0)).expect("not faulted");
    let found = events(&mut bench, 1500);
    let at_limit: Vec<_> = found.iter().filter(|(event, _)| event.kind == EventKind::JointAtLimit).collect();
    let [(event, _)] = at_limit[..] else { panic!("{:?}", kinds(&found)) };
    assert_eq!((event.part, event.values[1]), (Part::Joint(1), high[1]));
    // A force on the tip raises tensions.
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 3.0, 0.0)));
    let found = events(&mut bench, 500);
    let (event, report) =
        *found.iter().find(|(event, _)| event.kind == EventKind::TensionBound).expect("a tension above 11 N");
    let Part::Tendon(number) = event.part else { panic!("{event:?}") };
    assert_eq!(event.values[0], report.cycle.tensions[usize::from(number) - 1]);
    assert!(event.values[0] > 11.0 && event.values[1] == 11.0, "{event:?}");
}

#[test]
fn a_contact_a_force_beyond_its_bound_and_the_end_of_the_contact_are_events() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].events.force_above = Some(0.5));
    // The contact estimate learns the error of the model first.
    assert_eq!(kinds(&events(&mut bench, 2500)), []);
    let push = |bench: &Bench, force: f64| {
        bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, force, 0.0)));
    };
    push(&bench, 1.0);
    let found = events(&mut bench, 300);
    assert_eq!(kinds(&found), [EventKind::Contact, EventKind::ForceBound]);
    let (bound, report) = found[1];
    // The event gives the force of the tip on its surroundings, as `Fingertip::contact` does.
    assert_eq!(bound.values[..3], *(-report.cycle.contact.force).as_slice());
    assert!(bound.values[1] < -0.4 && bound.values[3] == 0.5, "{bound:?}");
    push(&bench, 0.0);
    assert_eq!(kinds(&events(&mut bench, 300)), [EventKind::ContactLost]);
}

#[test]
fn a_fault_is_an_event_with_its_number() {
    let mut bench = Bench::new();
    let found = events(&mut bench, 100);
    assert_eq!(kinds(&found), []);
    bench.with_finger(|finger| finger.inject(&Defect::EmergencyStop));
    let found = events(&mut bench, 100);
    assert_eq!(kinds(&found), [EventKind::Fault]);
    let (event, report) = found[0];
    let fault = bench.fault().expect("faulted");
    assert_eq!(fault.kind, FaultKind::EmergencyStopInput);
    assert_eq!(event.values[..2], [f64::from(fault.kind.number()), fault.value]);
    assert_eq!(report.stage, bench.stage(), "the event belongs to the cycle of the fault");
    bench.with_finger(|finger| finger.repair());
    bench.repair();
    bench.opens();
    assert_eq!(kinds(&events(&mut bench, 100)), []);
}

#[test]
fn every_warning_that_is_given_is_one_event() {
    let mut bench = Bench::new();
    // The spring cannot hold this force, so a joint is pushed to its stop.
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 0.0, -4.0)));
    bench.mailbox.send(|set_point| set_point.stiffness *= 0.3).expect("not faulted");
    let found = events(&mut bench, 2000);
    let warnings: Vec<_> = found.iter().filter(|(event, _)| event.kind == EventKind::Warning).collect();
    assert!(!warnings.is_empty(), "{:?}", kinds(&found));
    assert_eq!(warnings.len() as u64, bench.report().warnings.given(), "{:?}", kinds(&found));
    for (event, _) in warnings {
        assert!(FaultKind::from_number(event.values[0] as i32).is_some(), "{event:?}");
    }
}

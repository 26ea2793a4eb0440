//! Reflexes in the servo: how fast the command changes, which set point is in force after a reaction, and when no rule
//! fires.

use crate::finger_on_a_cable::{ServedFinger, World};
use crate::motion::{joints, send};
use crate::rig::{Bench, Line};
use nalgebra::{Matrix3, Vector3};
use sun2xp::board::Transport;
use sun2xp::control::spatial;
use sun2xp::finger::events::{EventKind, EventReader};
use sun2xp::finger::{Bulletin, Condition, FaultKind, Reaction, Reflex, Stage};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, TouchElement};
use sun2xp::realtime::{Clock, Schedule};

fn rule(condition: Condition, reaction: Reaction) -> Reflex {
    Reflex { condition, reaction, priority: 0, refractory: 0.0, inhibition: 0.0 }
}

fn an_element(configuration: &mut Configuration) {
    let element = TouchElement { position: [0.0; 3], normal: [0.0, 0.0, 1.0], newton_per_count: 0.001, zero: 200 };
    configuration.fingers[0].touch.elements = vec![element];
}

fn push(bench: &Bench, force: [f64; 3]) {
    bench.with_finger(|finger| {
        let turn = finger.plant().links().tip_rotation(&finger.plant().joints());
        finger.plant().set_external_force(turn * Vector3::from(force));
    });
}

/// The rules that have fired.
fn fired(bench: &mut Bench) -> Vec<u32> {
    let events = std::iter::from_fn(|| bench.events.take());
    events.filter(|event| event.kind == EventKind::ReflexFired).map(|event| event.values[0] as u32).collect()
}

/// A board samples when a Command arrives, and the Command that answers this sample is sent in the next period. So the
/// touch in one period changes the Command of the next one.
#[test]
fn a_touch_changes_the_next_command() {
    let mut bench = Bench::with(an_element);
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    let soft = Matrix3::identity() * 0.5;
    let number = bench.reflexes.install(rule(Condition::Event(EventKind::TouchMade), Reaction::Soften(soft)));
    bench.cycles(5);
    assert!(fired(&mut bench).is_empty());
    push(&bench, [0.0, 0.0, -0.3]);
    // The simulation presses the element before the second of these periods. That period fetches the event.
    bench.cycles(2);
    assert_eq!(fired(&mut bench), [number.expect("a place")]);
    assert_eq!(bench.report().set_point.stiffness, spatial(&soft));
    // The force stays, so the reflex does not fire again.
    bench.cycles(20);
    assert!(fired(&mut bench).is_empty());
}

#[test]
fn a_guarded_move_ends_at_the_contact() {
    let mut bench = Bench::new();
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    bench.reflexes.install(rule(Condition::ForceAbove(0.4), Reaction::Hold)).expect("a place");
    bench.mailbox.send(|set_point| set_point.joints = Vector3::new(0.1, 0.9, 1.4)).expect("not faulted");
    bench.cycles(40);
    let moving = bench.report().set_point.joints;
    push(&bench, [0.0, 0.0, -1.0]);
    bench.until("held", |bench| bench.report().set_point.joints != moving);
    assert_eq!(fired(&mut bench).len(), 1);
    let (held, springs) = (bench.report().set_point.joints, bench.report().springs);
    push(&bench, [0.0; 3]);
    bench.cycles(1000);
    assert!((bench.report().cycle.joints - held).amax() < 0.01);
    // A later change of the stiffness keeps the pose that is held.
    bench.mailbox.send(|set_point| set_point.stiffness = spatial(&Matrix3::identity())).expect("not faulted");
    bench.cycles(5);
    assert_eq!((bench.report().set_point.joints, bench.report().springs), (held, springs));
}

#[test]
fn an_inhibited_planner_is_not_followed_for_a_time() {
    let mut bench = Bench::new();
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    let back = Vector3::new(0.0, 0.4, 0.9);
    let reflex = rule(Condition::JointAbove { joint: 2, angle: 1.1 }, Reaction::Retract(back));
    bench.reflexes.install(Reflex { inhibition: 0.1, ..reflex }).expect("a place");
    let ahead = Vector3::new(0.1, 0.6, 1.3);
    let mut sent = 0;
    // The planner sends the same pose in every period, as planners do.
    while fired(&mut bench).is_empty() {
        bench.mailbox.send(|set_point| set_point.joints = ahead).expect("not faulted");
        bench.cycles(1);
        sent += 1;
        assert!(sent < 2000, "the reflex has not fired");
    }
    for _ in 0..99 {
        bench.mailbox.send(|set_point| set_point.joints = ahead).expect("not faulted");
        bench.cycles(1);
        assert_eq!(bench.report().set_point.joints, back);
    }
    bench.cycles(3);
    // A later change of the damping keeps the pose to which the reflex has retracted the finger.
    bench.mailbox.send(|set_point| set_point.damping = 1.1).expect("not faulted");
    bench.cycles(2);
    assert_eq!((bench.report().set_point.joints, bench.report().set_point.damping), (back, 1.1));
}

#[test]
fn a_grip_without_effect_ends_a_path() {
    let mut bench = Bench::new();
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    let grip = Reaction::Grip { direction: Vector3::x(), by: 1.0, most: 5.0 };
    let reflex = rule(Condition::JointAbove { joint: 1, angle: 0.6 }, grip);
    bench.reflexes.install(Reflex { inhibition: 0.1, ..reflex }).expect("a place");
    // This force pushes the tip in the direction of the grip, so the spring presses in the opposite direction. The grip
    // therefore has no effect.
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(1.0, 0.0, 0.0)));
    send(&bench, &[joints(2.0, [0.1, 0.9, 1.0])]);
    let springs = bench.report().springs;
    bench.until("a reaction", |bench| bench.report().springs > springs);
    let held = bench.report().set_point;
    assert_eq!((fired(&mut bench).len(), held.motion), (1, None));
    assert!((0.5..0.8).contains(&held.joints[1]), "on its way: {}", held.joints);
    bench.cycles(200);
    assert_eq!(bench.report().set_point, held);
    // A change of the damping after the inhibition keeps the pose that is held.
    bench.mailbox.send(|set_point| set_point.damping = 1.1).expect("not faulted");
    bench.cycles(5);
    assert_eq!((bench.report().set_point.joints, bench.report().set_point.damping), (held.joints, 1.1));
}

/// The second rule reacts one cycle after the first. Its shorter inhibition does not end that of the first.
#[test]
fn a_later_reaction_does_not_shorten_an_inhibition() {
    let mut bench = Bench::new();
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    let above = Condition::JointAbove { joint: 2, angle: 0.8 };
    let back = Vector3::new(0.0, 0.4, 0.9);
    let retract = Reflex { priority: 1, inhibition: 0.5, ..rule(above, Reaction::Retract(back)) };
    let soften = Reflex { inhibition: 0.05, ..rule(above, Reaction::Soften(Matrix3::identity() * 0.5)) };
    let numbers = [retract, soften].map(|reflex| bench.reflexes.install(reflex).expect("a place"));
    bench.cycles(3);
    assert_eq!(fired(&mut bench), numbers);
    for _ in 0..450 {
        bench.mailbox.send(|set_point| set_point.joints = Vector3::new(0.1, 0.6, 1.3)).expect("not faulted");
        bench.cycles(1);
        assert_eq!(bench.report().set_point.joints, back);
    }
}

#[test]
fn a_reflex_stops_the_finger_of_a_silent_planner() {
    let mut bench = Bench::new();
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    bench.reflexes.install(rule(Condition::PlannerSilent(0.05), Reaction::Stop)).expect("a place");
    for _ in 0..100 {
        bench.mailbox.send(|set_point| set_point.damping = 1.0).expect("not faulted");
        bench.cycles(10);
        assert_eq!(bench.stage(), Stage::Running);
    }
    bench.cycles(60);
    assert_eq!(bench.fault().expect("stopped").kind, FaultKind::ReflexStop);
}

#[test]
fn a_rule_sleeps_while_the_finger_is_no_spring() {
    let mut bench = Bench::new();
    bench.reflexes.install(rule(Condition::LinkLost(0.002), Reaction::Hold)).expect("a place");
    bench.reflexes.install(rule(Condition::Event(EventKind::Fault), Reaction::Hold)).expect("a place");
    bench.with_cable(|cable| cable.inject(sun2xp::simulated::LineFault::Drop, 1.0, u64::MAX, 1));
    bench.cycles(4);
    assert_eq!(fired(&mut bench).len(), 1);
    bench.until("faulted", |bench| bench.fault().is_some());
    bench.cycles(10);
    assert!(fired(&mut bench).is_empty());
}

/// Skipped periods are not lost replies.
#[test]
fn only_a_lost_reply_is_a_lost_link() {
    let mut bench = Bench::new();
    let one = bench.reflexes.install(rule(Condition::LinkLost(0.001), Reaction::Hold));
    let always = bench.reflexes.install(rule(Condition::LinkLost(0.0), Reaction::Hold));
    let three = bench.reflexes.install(rule(Condition::LinkLost(0.003), Reaction::Hold));
    bench.cycles(50);
    let before = bench.report().losses;
    bench.with_cable(|cable| cable.advance_to(cable.now() + 5_300_000));
    bench.cycles(50);
    let losses = bench.report().losses;
    assert!(losses.skipped_periods > before.skipped_periods + 2, "{losses:?}");
    assert_eq!((losses.lost_replies, fired(&mut bench)), (before.lost_replies, Vec::new()));
    bench.with_cable(|cable| cable.inject(sun2xp::simulated::LineFault::Drop, 1.0, u64::MAX, 1));
    // One rule reacts in each cycle.
    bench.cycles(2);
    assert_eq!(fired(&mut bench), [one, always].map(|number| number.expect("a place")));
    bench.cycles(1);
    assert_eq!(fired(&mut bench), [three.expect("a place")]);
}

/// Contacts occur at any time between two Commands. The event belongs to the next sample, and the Command after this
/// sample contains the reaction. So no contact waits longer than two periods.
#[test]
fn no_contact_waits_longer_than_two_periods() {
    let mut bench = Bench::with(an_element);
    bench.goes(Vector3::new(0.1, 0.5, 1.0));
    let reflex = rule(Condition::Event(EventKind::TouchMade), Reaction::Hold);
    bench.reflexes.install(reflex).expect("a place");
    for contact in 0..1000_u64 {
        push(&bench, [0.0; 3]);
        bench.cycles(3);
        assert!(fired(&mut bench).is_empty());
        bench.with_cable(|cable| cable.advance_to(cable.now() + contact * 997 % 900_000));
        push(&bench, [0.0, 0.0, -0.3]);
        let springs = bench.report().springs;
        // The physics advances in steps of 0.1 ms, so a contact just before a sample may miss it.
        bench.cycles(1);
        let at_once = fired(&mut bench).len();
        bench.cycles(1 - at_once);
        assert_eq!((at_once + fired(&mut bench).len(), bench.report().springs), (1, springs + 1), "contact {contact}");
    }
}

/// Each of two fingers has its own servo, as if each servo ran in its own thread. Finger 1 reacts to the touch of
/// finger 2 at most one period after finger 2 notices the touch, whichever finger runs first in a period.
#[test]
fn a_finger_reacts_to_the_touch_of_another_one_period_later() {
    let mut configuration = Configuration::default();
    configuration.fingers[0].port = "in memory".into();
    an_element(&mut configuration);
    let bulletin = Bulletin::new();
    let mut fingers = [FingerNumber::ONE, FingerNumber::TWO].map(|number| {
        let world = World::new(&configuration, Line::default());
        let period = 1_000_000;
        let schedule = Schedule::new(Clock::now(&world) + period, period);
        let mut rules = None;
        let served = ServedFinger::in_thread(&world, &configuration, &configuration, schedule, |finger| {
            let (finger, installed) = finger.with_reflexes(number, &bulletin);
            rules = Some(installed);
            finger
        });
        (world, served, rules.expect("installed"))
    });
    let condition = Condition::OtherFinger { finger: FingerNumber::TWO, event: EventKind::TouchMade };
    fingers[0].2.install(rule(condition, Reaction::Hold)).expect("a place");
    let mut touched = fingers[1].1.events.reader();
    let mut reacted = fingers[0].1.events.reader();
    for _ in 0..3000 {
        fingers.iter_mut().for_each(|(_, served, _)| served.servo.cycle());
    }
    for contact in 0..200 {
        let first = contact % 2;
        let push = |force: f64| {
            let mut place = fingers[1].0.place();
            let finger = place.cable.board().finger(1).expect("the board's finger");
            let turn = finger.plant().links().tip_rotation(&finger.plant().joints());
            finger.plant().set_external_force(turn * Vector3::new(0.0, 0.0, force));
        };
        push(-0.3);
        let mut cycles = [None; 2];
        for cycle in 0..5 {
            for place in [first, 1 - first] {
                fingers[place].1.servo.cycle();
            }
            let of_kind = |reader: &mut EventReader, kind| {
                std::iter::from_fn(|| reader.take()).any(|event| event.kind == kind).then_some(cycle)
            };
            cycles[0] = cycles[0].or(of_kind(&mut touched, EventKind::TouchMade));
            cycles[1] = cycles[1].or(of_kind(&mut reacted, EventKind::ReflexFired));
        }
        let [Some(touch), Some(reaction)] = cycles else { panic!("contact {contact}: {cycles:?}") };
        assert!(touch <= 1 && reaction <= touch + 1, "contact {contact}: {cycles:?}");
        let mut place = fingers[1].0.place();
        place.cable.board().finger(1).expect("the board's finger").plant().set_external_force(Vector3::zeros());
        drop(place);
        for _ in 0..5 {
            fingers.iter_mut().for_each(|(_, served, _)| served.servo.cycle());
        }
        while touched.take().is_some() || reacted.take().is_some() {}
    }
}

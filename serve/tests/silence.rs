//! The dead man's handle: clients that are killed, stopped or silent. The tests count times in servo cycles of 1 ms,
//! because a simulated finger slows down on a busy machine.

mod common;

use common::child::{WANTED, run_if_child, start};
use common::client::{part, request};
use common::{Client, Rig, wait_for};
use std::process::Child;
use std::time::Duration;
use sun2xp::events::EventKind;
use sun2xp::finger::FingerReport;
use sun2xp::nalgebra::Vector3;
use sun2xp::realtime::now;
use sun2xp::{FaultKind, Stage};
use sun2xp_remote_protocol::{Action, Code, Event, Place};

/// Longest time from the moment at which a client falls silent until its fingers are caught, cycles. A caught finger
/// holds its pose softly.
const CAUGHT: u64 = 120;

/// Longest time from the moment at which a client falls silent until its fingers are in their end state, cycles.
const ENDED: u64 = 1100;

fn report(rig: &Rig) -> FingerReport {
    rig.hand().report(1).expect("a report")
}

/// Other tests start this test alone in a child process, which then is a client. Without the environment variable that
/// they set, this test does nothing.
#[test]
fn client() {
    run_if_child();
}

fn signal(child: &Child, signal: i32) {
    let process = i32::try_from(child.id()).expect("a process number");
    // SAFETY: the process is a child that has not been waited for.
    #[allow(unsafe_code)]
    let sent = unsafe { libc::kill(process, signal) };
    assert_eq!(sent, 0);
}

/// Commands finger 1 from a child process, makes this process silent with `fall_silent`, and checks what the finger
/// does.
fn falls_silent(fall_silent: impl FnOnce(&mut Child)) {
    let rig = Rig::new("");
    let mut child = start("client", &rig.endpoint);
    wait_for("command", || (rig.set_point() == WANTED).then_some(()));
    fall_silent(&mut child);
    // The cycle is read after the signal, because this thread may have to wait before it sends the signal.
    let silent_from = report(&rig).losses.cycles;
    let caught = wait_for("catch", || Some(report(&rig)).filter(|report| report.expired));
    assert_eq!(caught.set_point.stiffness[(0, 0)], 1.0, "the soft stiffness");
    let (mut records, finger) = (Vec::new(), 1);
    let ended = wait_for("end state", || {
        records.clear();
        rig.hand().records_after(finger, silent_from, &mut records).expect("finger 1");
        records.iter().find(|record| matches!(record.stage, Stage::Faulted(_))).map(|record| record.cycle)
    });
    let soft = |record: &&sun2xp::finger::CycleRecord| {
        record.control.is_some_and(|control| match control.input.activity {
            sun2xp::control::Activity::Follow(set_point) => set_point.stiffness[(0, 0)] == 1.0,
            _ => false,
        })
    };
    let caught = records.iter().find(soft).expect("the cycle of the catch").cycle;
    println!("caught after {} cycles, ended after {}", caught - silent_from, ended - silent_from);
    assert!(caught - silent_from <= CAUGHT, "{}", caught - silent_from);
    assert!(ended - silent_from <= ENDED, "{}", ended - silent_from);
    let Stage::Faulted(fault) = report(&rig).stage else { panic!("not faulted") };
    assert!(matches!(fault.kind, FaultKind::SetPointExpired | FaultKind::FingerStopCall), "{fault}");
    let mut bob = rig.connect("bob");
    // The server ends the ownership up to 5 ms after the servo has ended the motion.
    wait_for("end of the ownership", || bob.status().filter(|status| status.owner.is_none()));
    assert_eq!(bob.acquire().text, "", "the next client acquires");
    let counts = bob.status().expect("a Status").counts;
    assert_eq!((counts.caught, counts.ended), (1, 1));
    signal(&child, libc::SIGKILL);
    child.wait().expect("the client");
    rig.server.end();
}

#[test]
fn a_client_is_killed() {
    falls_silent(|child| {
        child.kill().expect("killed");
    });
}

#[test]
fn a_client_is_stopped() {
    falls_silent(|child| signal(child, libc::SIGSTOP));
}

#[test]
fn the_ownership_of_an_owner_that_never_commands_ends_too() {
    let rig = Rig::new("");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let springs = report(&rig).springs;
    wait_for("end state", || matches!(report(&rig).stage, Stage::Faulted(_)).then_some(()));
    assert_eq!(report(&rig).springs, springs, "a finger that nobody has commanded is not caught");
    let bob = rig.connect("bob");
    let status = wait_for("end of the ownership", || bob.status().filter(|status| status.owner.is_none()));
    assert_eq!(status.counts.ended, 1);
    rig.server.end();
}

#[test]
fn a_caught_finger_follows_an_owner_that_returns() {
    let rig = Rig::new("end_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let stiff = [[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 4.0]];
    let mut wanted = part(1, WANTED);
    wanted.stiffness = Some(stiff);
    let in_force = |rig: &Rig| {
        let report = report(rig);
        (rig.set_point() == WANTED && report.set_point.stiffness[(0, 0)] == 4.0).then_some(())
    };
    alice.repeat_until(&[wanted.clone()], "set point", |_| in_force(&rig));
    wait_for("catch", || report(&rig).expired.then_some(()));
    wait_for("State in which the finger is caught", || {
        let state = alice.state()?;
        state.records.iter().any(|record| record.finger.number() == 1 && record.caught).then_some(())
    });
    // The part has the same command number, so it is not new. It takes effect because the finger was caught.
    wanted.stiffness = None;
    alice.repeat_until(&[wanted], "set point", |_| in_force(&rig));
    assert!(!report(&rig).expired);
    rig.server.end();
}

#[test]
fn a_far_target_pulls_with_the_force_of_the_lead_only() {
    let rig = Rig::new("lead_force = 1.0\nend_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let from = report(&rig).cycle.joints;
    let far = [from[0] + 0.5, from[1] + 0.3, from[2] + 0.4];
    let mut wanted = part(1, far);
    wanted.stiffness = Some([[5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.0]]);
    let mut led = false;
    alice.repeat_until(&[wanted], "arrival", |_| {
        let report = report(&rig);
        led |= report.set_point_number > 0 && rig.set_point() != far;
        let near = (report.cycle.joints - Vector3::from(far)).amax() < 0.05;
        (near && rig.set_point() == far).then_some(())
    });
    assert!(led, "the set point went ahead of the finger in steps");
    rig.server.end();
}

/// The lead (how far a set point may be ahead of the finger) is shorter than the tolerance of an arrival. So the finger
/// counts as arrived at each set point as soon as the set point is sent.
#[test]
fn only_the_arrival_at_the_destination_is_published() {
    let rig = Rig::new("lead_force = 0.5\nend_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let of_hand = rig.hand().events();
    let from = report(&rig).cycle.joints;
    let far = Vector3::new(from[0] + 0.5, from[1] + 0.3, from[2] + 0.4);
    let mut wanted = part(1, far.into());
    wanted.stiffness = Some([[5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.0]]);
    let published = alice.repeat_until(&[wanted], "arrival", |alice| {
        let arrived = |event: &&Event| event.kind == u16::from(EventKind::Arrived.number());
        alice.events().iter().find(arrived).cloned()
    });
    let [first, second, third, _] = published.values;
    let distance = (Vector3::new(first, second, third) - far).amax();
    assert!(distance <= 2f64.to_radians(), "{distance} rad from the destination");
    let on_the_way = std::iter::from_fn(|| of_hand.next()).filter(|event| event.kind == EventKind::Arrived).count();
    assert!(on_the_way > 1, "the finger was at several set points on the way: {on_the_way}");

    let records = |alice: &Client| alice.states().into_iter().flat_map(|state| state.records);
    let early = records(&alice).find(|record| {
        record.command == 1 && record.arrived && (Vector3::from(record.joints) - far).amax() > 2f64.to_radians()
    });
    assert_eq!(early, None, "a record says that the finger has arrived while it is still on the way");
    // The next command has the same destination, so it causes no second Event. A record still reports the arrival.
    let again = sun2xp_remote_protocol::Part { command: 2, ..part(1, far.into()) };
    alice.repeat_until(&[again], "arrival", |alice| {
        records(alice).any(|record| record.command == 2 && record.arrived).then_some(())
    });
    rig.server.end();
}

/// A finger without stiffness stays where it is, far from its set point. A new owner sends only a stiffness.
#[test]
fn a_stiffness_alone_pulls_with_the_force_of_the_lead_only() {
    let rig = Rig::new("lead_force = 1.0\nend_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let from = report(&rig).cycle.joints;
    let far = [from[0] + 0.5, from[1] + 0.3, from[2] + 0.4];
    let mut limp = part(1, far);
    limp.stiffness = Some([[0.0; 3]; 3]);
    alice.repeat_until(&[limp], "set point", |_| (rig.set_point() == far).then_some(()));
    let mut bob = rig.connect("bob");
    let taken = bob.acquire_with(sun2xp_remote_protocol::Request { take_over: true, ..request(Action::Acquire) });
    assert_eq!(taken.text, "");
    let of_bob = wait_for("States of the new epoch", || {
        Some(bob.states().into_iter().filter(|state| state.owner == taken.number).collect::<Vec<_>>())
            .filter(|states| states.len() > 3)
    });
    assert!(
        of_bob.iter().flat_map(|state| &state.records).all(|record| record.command == 0),
        "command number 1 was that of alice"
    );
    let mut stiff = part(1, far);
    (stiff.place, stiff.stiffness) = (Place::Kept, Some([[5.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 5.0]]));
    bob.repeat_until(&[stiff.clone()], "stiffness", |_| {
        (report(&rig).set_point.stiffness[(0, 0)] == 5.0).then_some(())
    });
    assert_ne!(rig.set_point(), far, "the set point is ahead of the finger by the lead only");
    bob.repeat_until(&[stiff], "arrival", |_| (rig.set_point() == far).then_some(()));
    rig.server.end();
}

/// The recovery of finger 1 takes longer than the owner may be silent.
#[test]
fn fingers_wait_while_an_acquire_recovers_another_one() {
    let rig = Rig::new("end_ms = 200");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    alice.send(vec![]);
    rig.hand().stop(1).expect("finger 1");
    wait_for("stop", || matches!(report(&rig).stage, Stage::Faulted(_)).then_some(()));
    let mut bob = rig.connect("bob");
    let taking = sun2xp_remote_protocol::Request { take_over: true, recover: true, ..request(Action::Acquire) };
    assert_eq!(bob.acquire_with(taking).text, "");
    for finger in [2, 3] {
        let report = rig.hand().report(finger).expect("a report");
        assert_eq!((report.stage, report.recoveries), (Stage::Running, 0), "finger {finger}");
    }
    assert_eq!(report(&rig).recoveries, 1);
    rig.server.end();
}

#[test]
fn a_path_does_not_outlive_its_owner() {
    let rig = Rig::new("end_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let mut path = part(1, [0.0; 3]);
    let start = report(&rig).cycle.joints;
    let end = [start[0] + 0.2, start[1], start[2]];
    path.place = Place::Path(vec![sun2xp_remote_protocol::PathPose { time: 30.0, joints: end }]);
    alice.repeat_until(&[path], "path", |alice| (alice.status()?.counts.taken > 3).then_some(()));
    let silent_from = report(&rig).losses.cycles;
    let caught = wait_for("catch", || Some(report(&rig)).filter(|report| report.expired));
    // On a busy machine, this thread may notice the catch late.
    assert!(caught.losses.cycles - silent_from < 10 * CAUGHT, "{}", caught.losses.cycles - silent_from);
    assert!((caught.set_point.joints[0] - end[0]).abs() > 0.1, "the path has not ended");
    rig.server.end();
}

#[test]
fn states_have_every_cycle_or_count_it_as_missing() {
    let rig = Rig::new("");
    let client = rig.connect("carol");
    wait_for("States", || (client.states().len() > 100).then_some(()));
    let states = client.states();
    let begun = now();
    assert!(states.windows(2).all(|pair| pair[1].number == pair[0].number + 1), "no State is lost on loopback");
    for finger in 1..=3 {
        let records = states.iter().flat_map(|state| &state.records);
        let cycles: Vec<u64> = records.filter(|record| record.finger.number() == finger).map(|r| r.cycle).collect();
        let missing: u32 = states.iter().map(|state| state.missing).sum();
        let gaps: u64 = cycles.windows(2).map(|pair| pair[1] - pair[0] - 1).sum();
        assert!(cycles.len() > 100 && gaps <= u64::from(missing), "{} {gaps} {missing}", cycles.len());
    }
    let newest = states.last().expect("a State");
    assert!(
        newest.time <= begun
            && newest.owner == 0
            && begun - newest.time < 10 * Duration::from_secs(1).as_nanos() as u64
    );
    assert_eq!(client.status().map(|status| status.fingers.iter().flatten().count()), Some(3));
    let refused =
        rig.connect("alice").request(sun2xp_remote_protocol::Request { epoch: 3, ..request(Action::Recover) });
    assert_eq!(refused.code, Code::NotOwner);
    rig.server.end();
}

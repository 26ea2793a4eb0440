//! Commands the named simulated hands over the network. These hands differ from the configuration that their controller
//! uses.

mod common;

use common::client::{part, request};
use common::{Rig, wait_for};
use sun2xp::finger::FingerReport;
use sun2xp::model::configuration::NamedHand;
use sun2xp::nalgebra::Vector3;
use sun2xp::{FaultKind, Stage};
use sun2xp_remote_client::{RemoteConfiguration, RemoteHand};
use sun2xp_remote_protocol::Action;

fn report(rig: &Rig, finger: i32) -> FingerReport {
    rig.hand().report(finger).expect("a report")
}

/// Moves every finger to three places, and waits until it has settled. Each joint must then be within
/// `near`, rad, of its set point. The tips touch nothing.
fn follows(name: NamedHand, near: f64) {
    let rig = Rig::named(name, "end_ms = 20000");
    let (hand, client) = ("hand".parse().expect("a name"), "alice".parse().expect("a name"));
    let hand = RemoteHand::open(&RemoteConfiguration::new(&rig.endpoint, hand, client)).expect("open");
    for place in [[0.1, 0.5, 0.9], [-0.1, 0.7, 0.6], [0.0, 0.4, 1.0]] {
        (1..=3).for_each(|finger| hand.send_position(finger, place).expect("sent"));
        for finger in 1..=3 {
            wait_for("rest", || hand.progress(finger).is_ok_and(|progress| progress.settled).then_some(()));
            let error = (Vector3::from(hand.position(finger).expect("a position")) - Vector3::from(place)).amax();
            println!("{}: finger {finger} is {error:.4} rad from {place:?}", name.name());
            assert!(error < near, "{error} rad");
            assert_eq!(report(&rig, finger).stage, Stage::Running);
        }
    }
    drop(hand);
    rig.server.end();
}

/// Moves finger 1. On the way the client falls silent, and the finger is caught: it holds its pose softly, because its
/// Target is too old. The finger must hold this pose until its end state. `near` is the largest permitted motion of a
/// joint in this time, rad.
fn is_caught(name: NamedHand, near: f64) {
    let rig = Rig::named(name, "");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let wanted = [0.1, 0.5, 0.9];
    alice.repeat_until(&[part(1, wanted)], "set point", |_| (rig.set_point() == wanted).then_some(()));
    let caught = wait_for("catch", || Some(report(&rig, 1)).filter(|report| report.expired));
    assert_eq!(caught.set_point.stiffness[(0, 0)], 1.0, "the soft stiffness");
    let mut farthest = 0f64;
    let fault = wait_for("end state", || {
        let now = report(&rig, 1);
        let Stage::Faulted(fault) = now.stage else {
            farthest = farthest.max((now.cycle.joints - caught.set_point.joints).amax());
            return None;
        };
        Some(fault)
    });
    println!("{}: {farthest:.4} rad from the place of the catch", name.name());
    assert!(matches!(fault.kind, FaultKind::SetPointExpired | FaultKind::FingerStopCall), "{fault}");
    assert!(farthest < near, "{farthest} rad");
    rig.server.end();
}

#[test]
fn a_worn_hand_follows_its_owner_and_is_caught() {
    follows(NamedHand::Worn, 0.05);
    is_caught(NamedHand::Worn, 0.03);
}

#[test]
fn a_sheathed_hand_follows_its_owner_and_is_caught() {
    follows(NamedHand::Sheathed, 0.03);
    is_caught(NamedHand::Sheathed, 0.03);
}

/// The gauge errors of this hand act like a force of 0.3 N at the tip. This force moves the tip by 1 mm with the
/// default Kx of 3 N/cm, and by 3 mm while the finger is caught, with the soft Kx of 1 N/cm.
#[test]
fn a_cheap_hand_follows_its_owner_and_is_caught() {
    follows(NamedHand::Cheap, 0.12);
    is_caught(NamedHand::Cheap, 0.2);
}

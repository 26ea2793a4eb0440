//! The Rust client of this project against the server.

mod common;

use common::{Rig, wait_for};
use std::fs::read_dir;
use sun2xp::Stage;
use sun2xp_remote_client::{Finger, FingerCommand, PathPose, RemoteConfiguration, RemoteErrorKind, RemoteHand};

fn configuration(rig: &Rig, name: &str) -> RemoteConfiguration {
    RemoteConfiguration::new(&rig.endpoint, "hand".parse().expect("a name"), name.parse().expect("a name"))
}

fn open(rig: &Rig, name: &str) -> RemoteHand {
    RemoteHand::open(&configuration(rig, name)).unwrap_or_else(|error| panic!("{error}"))
}

fn joints(rig: &Rig, finger: i32) -> [f64; 3] {
    rig.hand().report(finger).expect("a report").set_point.joints.into()
}

#[test]
fn commands_arrive() {
    let rig = Rig::new("end_ms = 20000");
    let hand = open(&rig, "alice");
    let place = [0.1, 0.5, 0.9];
    hand.send_position(1, place).expect("sent");
    wait_for("set point", || (joints(&rig, 1) == place).then_some(()));
    wait_for("position", || {
        let found = hand.position(1).expect("a position");
        (0..3).all(|joint| (found[joint] - place[joint]).abs() < 0.02).then_some(())
    });
    let others = [[0.1, 0.6, 0.8], [0.2, 0.5, 1.0]];
    let stiff = [[4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]];
    let commands = [FingerCommand::new(2).joints(others[0]).stiffness(stiff), FingerCommand::new(3).joints(others[1])];
    hand.send_group(&commands).expect("sent");
    wait_for("group", || (joints(&rig, 2) == others[0] && joints(&rig, 3) == others[1]).then_some(()));
    let set_point = rig.hand().report(2).expect("a report").set_point;
    assert_eq!([0, 1, 2].map(|axis| set_point.stiffness[(axis, axis)]), [4.0, 3.0, 2.0]);
    let tip = rig.hand().tip_at(1, [0.0, 0.6, 1.0]).expect("a tip");
    hand.send_tip(1, tip).expect("sent");
    wait_for("tip", || {
        let found = rig.hand().tip_at(1, joints(&rig, 1)).expect("a tip");
        (0..3).all(|axis| (found[axis] - tip[axis]).abs() < 1e-6).then_some(())
    });
    let end = [0.1, 0.7, 1.1];
    hand.send_path(2, &[PathPose { time: 0.5, joints: end }]).expect("sent");
    wait_for("end of the path", || {
        (0..3).all(|joint| (joints(&rig, 2)[joint] - end[joint]).abs() < 1e-6).then_some(())
    });
    assert!(hand.finger_status(1).is_ok() && hand.statistics().refused == 0);
    hand.close().expect("released");
    wait_for("end state", || matches!(rig.hand().report(1).ok()?.stage, Stage::Faulted(_)).then_some(()));
    rig.server.end();
}

#[test]
fn another_client_may_watch_and_take_over() {
    let rig = Rig::new("end_ms = 20000");
    let alice = open(&rig, "alice");
    let refused = RemoteHand::open(&configuration(&rig, "bob")).err().expect("owned");
    assert!(refused.to_string().contains("alice"), "{refused}");
    let watcher = RemoteHand::watch(&configuration(&rig, "carol")).expect("a watcher");
    wait_for("position", || watcher.position(3).ok());
    assert!(watcher.send_position(1, [0.1, 0.5, 0.9]).is_err());
    let mut taking = configuration(&rig, "bob");
    taking.take_over = true;
    let bob = RemoteHand::open(&taking).unwrap_or_else(|error| panic!("{error}"));
    wait_for("loss", || (!alice.is_owner()).then_some(()));
    assert_eq!(alice.send_position(1, [0.1, 0.5, 0.9]).expect_err("lost").kind(), RemoteErrorKind::NotOwner);
    bob.send_position(1, [0.2, 0.5, 0.9]).expect("sent");
    wait_for("set point", || (joints(&rig, 1) == [0.2, 0.5, 0.9]).then_some(()));
    watcher.stop(Some(2)).expect("stopped");
    wait_for("stop", || matches!(rig.hand().report(2).ok()?.stage, Stage::Faulted(_)).then_some(()));
    assert_eq!(bob.finger_status(1).map(|status| status.stage.name()).unwrap_or_default(), "running");
    wait_for("news of the stop", || bob.send_position(2, [0.2, 0.5, 0.9]).err());
    bob.recover(Some(2)).expect("recovered");
    assert_eq!(rig.hand().report(2).expect("a report").stage, Stage::Running);
    drop((alice, watcher, bob));
    rig.server.end();
}

#[test]
fn clients_that_come_and_go_leave_nothing_behind() {
    let rig = Rig::new("");
    let used = || {
        let count = |folder| read_dir(folder).expect("a folder").count();
        (count("/proc/self/task"), count("/proc/self/fd"))
    };
    let come_and_go = || {
        let hand = open(&rig, "alice");
        hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
        hand.close().expect("released");
    };
    (0..3).for_each(|_| come_and_go());
    let before = used();
    (0..10).for_each(|_| come_and_go());
    wait_for("as few threads and descriptors as before", || {
        let after = used();
        (after.0 <= before.0 && after.1 <= before.1).then_some(())
    });
    assert_eq!(rig.server.status().clients, 1);
    rig.server.end();
}

#[test]
fn a_calibration_runs_while_the_owner_repeats_its_target() {
    let rig = Rig::new("");
    let hand = open(&rig, "alice");
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    hand.zero(2).unwrap_or_else(|error| panic!("{error}"));
    let report = rig.hand().report(2).expect("a report");
    assert_eq!(report.stage, Stage::Running);
    assert!(!rig.hand().report(1).expect("a report").expired, "the owner has repeated its Target");
    assert_eq!(joints(&rig, 1), [0.1, 0.5, 0.9]);
    assert!(hand.record(2).is_ok_and(|record| record.finger == Finger::ALL[1]));
    drop(hand);
    rig.server.end();
}

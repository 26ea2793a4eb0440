//! Tests what calls return, in simulated time.

mod ownership;

use super::*;
use crate::command::FingerCommand;
use crate::error::RemoteErrorKind;
use sun2xp_remote_protocol::{Code, Counts, FaultText, FingerStatus, PathPose, Record, Stage, Status};

const MS: u64 = 1_000_000;
/// The server's clock at the time 0 of the client, ns.
const SERVER: u64 = 5_000_000 * MS;

fn status(stage: Stage) -> Status {
    // Only the first 71 bytes of this text are sent. They end in the middle of a word.
    let lost = "lost replies (17 ms): the board has sent no valid reply for too long; the value is this time";
    let text = if matches!(stage, Stage::Faulted(_)) { lost } else { "" };
    let finger = FingerStatus {
        stage,
        warnings: 0,
        cycles: 1,
        skipped_periods: 0,
        lost_replies: 0,
        corrupt_replies: 0,
        low: [-0.5; 3],
        high: [1.5; 3],
        stiffness_bound: 10.0,
        calibration: 0.0,
        fault_text: FaultText::beginning_of(text),
    };
    Status {
        catch_ms: 100,
        end_ms: 1000,
        clients: 1,
        time: SERVER,
        rate: 1000.0,
        lead_force: 10.0,
        soft_stiffness: 1.0,
        counts: Counts::default(),
        fingers: [Some(finger.clone()), Some(finger), None],
        owner: None,
    }
}

fn state(number: u64, now: u64, stage: Stage) -> State {
    let record = |finger| Record {
        finger,
        stage,
        command: 0,
        cycle: number,
        begin: SERVER + now,
        touching: false,
        caught: false,
        arrived: false,
        settled: false,
        joints: [0.25; 3],
        set_point: None,
        tip: [0.0; 3],
        force: [0.0; 3],
        tensions: [5.0; 4],
    };
    let records = Finger::ALL[..2].iter().map(|&finger| record(finger)).collect();
    State { missing: 0, number, time: SERVER + now, owner: 2, records }
}

fn answer() -> Answer {
    Answer { code: Code::Done, catch_ms: 100, epoch: 77, time: SERVER, number: 2, text: String::new() }
}

/// An exchange that owns the hand, and that received a State at 10 ms.
fn owner() -> Exchange {
    let hand = "left".parse().expect("a name");
    let mut exchange = Exchange::new(hand, "tcp/127.0.0.1:7447".into(), 100);
    exchange.view.take_status(status(Stage::Running));
    exchange.outbox.acquired(&answer());
    exchange.take_state(&state(1, 10 * MS, Stage::Running), 10 * MS);
    exchange
}

fn send(exchange: &mut Exchange, command: FingerCommand, now: u64) -> Result<(), RemoteError> {
    let changes = exchange.admit(&[command], now)?;
    exchange.put(changes, None);
    Ok(())
}

fn refused(result: Result<(), RemoteError>) -> (RemoteErrorKind, String) {
    let error = result.expect_err("refused");
    (error.kind(), error.to_string())
}

fn good(finger: i32) -> FingerCommand {
    FingerCommand::new(finger).joints([0.5; 3])
}

#[test]
fn a_fresh_position_is_returned_and_an_old_one_refused() {
    let exchange = owner();
    assert_eq!(exchange.moving(1, 110 * MS).expect("fresh").joints, [0.25; 3]);
    let error = exchange.moving(1, 111 * MS).expect_err("stale");
    assert_eq!(error.kind(), RemoteErrorKind::Stale);
    let text = error.to_string();
    assert!(text.contains("is 101 ms old, and remote.stale_ms is 100: check the line to tcp/127.0.0.1:7447"), "{text}");
}

#[test]
fn a_position_that_was_long_on_its_way_is_old() {
    let mut exchange = owner();
    exchange.take_state(&state(2, 20 * MS, Stage::Running), 150 * MS);
    assert_eq!(exchange.moving(1, 150 * MS).expect_err("stale").kind(), RemoteErrorKind::Stale);
}

#[test]
fn fingers_that_are_not_there_are_refused() {
    let mut exchange = owner();
    for number in [0, 4, -1, i32::MAX] {
        assert_eq!(exchange.moving(number, 10 * MS).expect_err("none").kind(), RemoteErrorKind::NoSuchFinger);
        assert_eq!(refused(send(&mut exchange, good(number), 10 * MS)).0, RemoteErrorKind::NoSuchFinger);
    }
    assert_eq!(refused(send(&mut exchange, good(3), 10 * MS)).0, RemoteErrorKind::NotInHand);
}

#[test]
fn wrong_arguments_are_refused_and_change_nothing() {
    let mut exchange = owner();
    let kx = |entry: f64| [[1.0, entry, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let diagonal = |entry: f64| [[entry, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let command = FingerCommand::new(1);
    let cases = [
        (command.joints([0.0, f64::NAN, 0.0]), RemoteErrorKind::Argument, "Pos of finger 1 contains NaN"),
        (command.joints([0.0, 1.6, 0.0]), RemoteErrorKind::OutOfRange, "joint 1 would be at 1.6000 rad, outside the "),
        (command.tip([f64::INFINITY; 3]), RemoteErrorKind::Argument, "Tip of finger 1 contains inf"),
        (command.stiffness(kx(0.5)), RemoteErrorKind::NotASpring, "Kx of finger 1 is not symmetric"),
        (command.stiffness(kx(f64::NAN)), RemoteErrorKind::Argument, "Kx of finger 1 contains NaN"),
        (command.stiffness(diagonal(-0.5)), RemoteErrorKind::NotASpring, "has the negative eigenvalue -5.000e-1"),
        (command.stiffness(diagonal(11.0)), RemoteErrorKind::OutOfRange, "is 11.000 N/cm, above the bound of 10.000"),
        (command.damping(-0.5), RemoteErrorKind::OutOfRange, "the damping ratio -0.5 of finger 1 is negative"),
        (command.damping(f64::NAN), RemoteErrorKind::Argument, "Damping of finger 1 contains NaN"),
    ];
    for (command, kind, excerpt) in cases {
        let (refused_kind, text) = refused(send(&mut exchange, command, 10 * MS));
        assert!(refused_kind == kind && text.contains(excerpt), "{refused_kind:?}: {text}");
    }
    let twice = exchange.admit(&[good(1), good(1)], 10 * MS).map(drop);
    assert!(refused(twice).1.contains("the group has two commands for finger 1"));
    let target = exchange.outbox.next(10 * MS).expect("a Target");
    assert!(target.parts.is_empty(), "nothing was put into the outbox");
}

#[test]
fn limits_that_were_rounded_to_float_are_admitted() {
    let mut exchange = owner();
    let mut narrow = status(Stage::Running);
    if let Some(finger) = narrow.fingers[0].as_mut() {
        (finger.high, finger.stiffness_bound) = ([0.1; 3], 0.1);
    }
    exchange.view.take_status(narrow);
    let rounded = f64::from(0.1f32);
    assert!(rounded > 0.1);
    let kx = [[rounded, 0.0, 0.0], [0.0, rounded, 0.0], [0.0, 0.0, rounded]];
    send(&mut exchange, FingerCommand::new(1).joints([rounded; 3]).stiffness(kx), 10 * MS).expect("admitted");
}

#[test]
fn paths_are_checked() {
    let mut exchange = owner();
    let pose = |time, angle| PathPose { time, joints: [angle; 3] };
    let cases = [
        (vec![], RemoteErrorKind::Argument, "the path has 0 poses: send 1 to 32 poses"),
        (vec![pose(0.0, 0.5)], RemoteErrorKind::Argument, "the time of pose 0 of the path of finger 1 is 0 s after"),
        (vec![pose(1.0, 0.5), pose(1.0, 0.5)], RemoteErrorKind::Argument, "the time of pose 1"),
        (vec![pose(f64::NAN, 0.5)], RemoteErrorKind::Argument, "the time of pose 0"),
        (vec![pose(3601.0, 0.5)], RemoteErrorKind::Argument, "the time of pose 0"),
        (vec![pose(1.0, 2.0)], RemoteErrorKind::OutOfRange, "joint 0 would be at 2.0000 rad"),
        (vec![pose(1.0, 0.5); 33], RemoteErrorKind::Argument, "the path has 33 poses"),
    ];
    for (poses, kind, beginning) in cases {
        let (refused_kind, text) = refused(exchange.admit_path(1, &poses, 10 * MS).map(drop));
        assert!(refused_kind == kind && text.starts_with(beginning), "{refused_kind:?}: {text}");
    }
    assert!(exchange.admit_path(1, &[pose(1.0, 0.5)], 10 * MS).is_ok());
    // The difference of these two times is rounded below 1 ms.
    assert!(exchange.admit_path(1, &[pose(0.008, 0.5), pose(0.009, 0.5)], 10 * MS).is_ok());
    exchange.take_state(&state(2, 11 * MS, Stage::Calibrating), 11 * MS);
    let (kind, text) = refused(exchange.admit_path(1, &[pose(1.0, 0.5)], 11 * MS).map(drop));
    assert_eq!((kind, text.as_str()), (RemoteErrorKind::Busy, "finger 1 is calibrating: wait until it is running"));
    exchange.take_state(&state(3, 12 * MS, Stage::Limp), 12 * MS);
    let (kind, text) = refused(exchange.admit_path(1, &[pose(1.0, 0.5)], 12 * MS).map(drop));
    assert_eq!((kind, text.as_str()), (RemoteErrorKind::Busy, "finger 1 is limp: zero or identify it"));
    for (number, stage) in [(4, Stage::Closing), (5, Stage::Closed)] {
        let now = (9 + number) * MS;
        exchange.take_state(&state(number, now, stage), now);
        let (kind, text) = refused(exchange.admit_path(1, &[pose(1.0, 0.5)], now).map(drop));
        let remedy = "its server is shutting down. Start the server again, then open or reopen the hand";
        assert_eq!((kind, text), (RemoteErrorKind::Busy, format!("finger 1 is {}: {remedy}", stage.name())));
    }
}

#[test]
fn a_finger_that_has_stopped_is_reported_with_its_fault() {
    let mut exchange = owner();
    exchange.take_state(&state(2, 11 * MS, Stage::Faulted(10)), 11 * MS);
    let error = exchange.moving(1, 11 * MS).expect_err("faulted");
    assert_eq!((error.kind(), error.fault(), error.finger()), (RemoteErrorKind::Faulted, 10, Some(1)));
    assert!(error.to_string().starts_with("finger 1 is faulted (fault 10). Remove the cause"), "{error}");
    exchange.view.take_status(status(Stage::Faulted(10)));
    let (kind, text) = refused(send(&mut exchange, good(1), 11 * MS));
    assert!(text.starts_with("finger 1 is faulted (fault 10): lost replies (17 ms). Remove"), "{kind:?}: {text}");
    assert!(exchange.record(1, 11 * MS).is_ok(), "its record can be read");
    // The servo of the finger has no cycles any more, but the server repeats the record of the newest one.
    let State { records, .. } = state(2, 11 * MS, Stage::Faulted(10));
    exchange.take_state(&State { records, ..state(3, 500 * MS, Stage::Running) }, 500 * MS);
    assert_eq!(exchange.moving(1, 600 * MS).expect_err("faulted").kind(), RemoteErrorKind::Faulted);
    assert_eq!(exchange.moving(1, 601 * MS).expect_err("stale").kind(), RemoteErrorKind::Stale);
}

#[test]
fn set_points_are_not_sent_into_silence() {
    let mut exchange = owner();
    assert!(send(&mut exchange, good(1), 110 * MS).is_ok());
    let (kind, text) = refused(send(&mut exchange, good(1), 111 * MS));
    assert_eq!(kind, RemoteErrorKind::NotConnected);
    assert!(text.starts_with("for 101 ms, nothing was received from the hand \"left\""), "{text}");
    assert_eq!(exchange.status(3010 * MS).map(|status| status.catch_ms).ok(), Some(100));
    assert_eq!(exchange.status(3011 * MS).expect_err("old").kind(), RemoteErrorKind::NotConnected);
}

#[test]
fn a_refusal_is_reported_once() {
    let mut exchange = owner();
    send(&mut exchange, good(1), 10 * MS).expect("sent");
    let sequence = exchange.outbox.next(10 * MS).expect("a Target").sequence;
    let text = "out of reach: send a nearer tip".to_string();
    exchange.take_refusal(&Answer { code: Code::Argument, number: sequence, text, ..answer() });
    let (kind, text) = refused(send(&mut exchange, good(2), 10 * MS));
    assert_eq!(kind, RemoteErrorKind::Refused);
    assert!(text.ends_with("send it again. Reason of the refusal: out of reach: send a nearer tip"), "{text}");
    send(&mut exchange, good(2), 10 * MS).expect("sent");
    let target = exchange.outbox.next(30 * MS).expect("a Target");
    assert_eq!(target.parts.iter().map(|part| part.finger.number()).collect::<Vec<_>>(), [2]);
    assert_eq!(exchange.view.statistics.refused, 1);
}

#[test]
fn records_confirm_what_was_sent() {
    let mut exchange = owner();
    send(&mut exchange, good(1), 10 * MS).expect("sent");
    let command = exchange.outbox.next(10 * MS).expect("a Target").parts[0].command;
    let mut confirming = state(2, 11 * MS, Stage::Running);
    confirming.records[0].arrived = true;
    exchange.take_state(&confirming, 11 * MS);
    let progress = exchange.progress(1, 11 * MS).expect("running");
    assert!(!progress.applied && !progress.arrived, "the record is of an earlier command");
    confirming = state(3, 12 * MS, Stage::Running);
    (confirming.records[0].command, confirming.records[0].arrived) = (command, true);
    exchange.take_state(&confirming, 12 * MS);
    let progress = exchange.progress(1, 12 * MS).expect("running");
    assert!(progress.applied && progress.arrived && !progress.settled);
    send(&mut exchange, FingerCommand::new(1).damping(0.5), 12 * MS).expect("sent");
    let target = exchange.outbox.next(13 * MS).expect("a Target");
    assert_eq!(target.parts[0].place, sun2xp_remote_protocol::Place::Kept);
}

#[test]
fn numbers_without_sense_do_not_overflow() {
    let mut exchange = owner();
    for number in [u64::MAX, 0, u64::MAX, 1, u64::MAX] {
        for time in [u64::MAX, 0, 1 << 63] {
            let mut wild = State { number, time, missing: u32::MAX, ..state(1, 0, Stage::Running) };
            wild.records[0].begin = u64::MAX - time;
            exchange.take_state(&wild, 20 * MS);
            let _ = exchange.moving(1, 21 * MS);
        }
    }
    assert!(exchange.outbox.next(21 * MS).is_none(), "the ownership is lost");
    exchange.outbox.acquired(&answer());
    exchange.take_refusal(&Answer { time: u64::MAX, number: u64::MAX, ..answer() });
    assert!(exchange.outbox.next(22 * MS).is_some());
    assert!(exchange.view.statistics.lost_states > 0);
}

#[test]
fn lost_states_and_missing_cycles_are_counted() {
    let mut exchange = owner();
    exchange.take_state(&State { missing: 3, ..state(5, 11 * MS, Stage::Running) }, 11 * MS);
    let statistics = exchange.view.statistics;
    assert_eq!((statistics.states, statistics.lost_states, statistics.missing_cycles), (2, 3, 3));
}

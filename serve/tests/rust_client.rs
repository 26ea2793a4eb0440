//! The Rust client against the server with the simulated hand, with and without TLS.

mod common;

use common::{CLIENTS, Rig, free_port, wait_for};
use std::path::Path;
use std::time::Duration;
use sun2xp::Stage;
use sun2xp_remote_client::{
    FingerCommand, PathPose, RemoteConfiguration, RemoteErrorKind, RemoteHand, RemoteTls, discover, send_together,
};
use sun2xp_serve::certificates::{Wanted, make};

/// Time limits for the silence of the owner. They and [`STALE_MS`] are long, because the machine may be busy.
const PATIENT: &str = "catch_ms = 5000\nend_ms = 20000\n";
/// Largest age of a position, ms.
const STALE_MS: u32 = 4000;

/// The number of the event *settled*.
const SETTLED: u16 = 12;

fn configuration(rig: &Rig, client: &str) -> RemoteConfiguration {
    let (hand, client) = ("hand".parse().expect("a name"), client.parse().expect("a name"));
    let mut configuration = RemoteConfiguration::new(&rig.endpoint, hand, client);
    configuration.stale_ms = STALE_MS;
    configuration
}

fn near(one: [f64; 3], other: [f64; 3]) -> bool {
    one.iter().zip(other).all(|(one, other)| (one - other).abs() < 0.02)
}

/// Waits until finger 1 is near these angles.
fn arrives(hand: &RemoteHand, joints: [f64; 3]) {
    wait_for("arrival", || near(hand.position(1).expect("a position"), joints).then_some(()));
}

#[test]
fn a_planner_moves_the_hand_and_reads_it() {
    let rig = Rig::new(PATIENT);
    let hand = RemoteHand::open(&configuration(&rig, "alice")).expect("open");
    let events = hand.events();
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    arrives(&hand, [0.1, 0.5, 0.9]);
    let settled = wait_for("an event", || events.wait(Some(Duration::from_secs(1))).filter(|one| one.kind == SETTLED));
    assert_eq!(settled.finger.number(), 1);
    let tip = hand.fingertip(1).expect("a tip").tip;
    let local = rig.hand().fingertip(1).expect("a tip").tip;
    assert!(tip.iter().zip(local).all(|(one, other)| (one - other).abs() < 0.1), "{tip:?} {local:?}");
    let soft = [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]];
    hand.send_path(1, &[PathPose { time: 0.5, joints: [0.0, 0.6, 0.6] }]).expect("sent");
    hand.send_stiffness(1, soft).expect("sent");
    arrives(&hand, [0.0, 0.6, 0.6]);
    wait_for("Kx", || ((rig.hand().report(1).ok()?.set_point.stiffness[(0, 0)] - 0.5).abs() < 1e-9).then_some(()));
    assert_eq!(hand.status().expect("a Status").counts.refused, 0);
    hand.close().expect("released");
    wait_for("end state", || matches!(rig.hand().report(1).ok()?.stage, Stage::Faulted(_)).then_some(()));
    rig.server.end();
}

#[test]
fn what_only_the_hand_can_refuse_is_reported_by_the_next_call() {
    let rig = Rig::new(PATIENT);
    let hand = RemoteHand::open(&configuration(&rig, "alice")).expect("open");
    let before = rig.set_point();
    hand.send_tip(1, [100.0, 0.0, 0.0]).expect("sent");
    wait_for("the refusal", || (hand.statistics().refused > 0).then_some(()));
    let error = hand.send_damping(1, 1.0).expect_err("refused");
    assert_eq!(error.kind(), RemoteErrorKind::Refused);
    assert!(error.to_string().contains("the tip of finger 1 cannot be at 100.000, 0.000, 0.000 cm"), "{error}");
    assert_eq!(rig.set_point(), before);
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    wait_for("the set point", || (rig.set_point() == [0.1, 0.5, 0.9]).then_some(()));
    rig.server.end();
}

#[test]
fn a_hand_that_was_stopped_moves_only_when_it_is_commanded_again() {
    let rig = Rig::new(PATIENT);
    let hand = RemoteHand::open(&configuration(&rig, "alice")).expect("open");
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    arrives(&hand, [0.1, 0.5, 0.9]);
    let watcher = RemoteHand::watch(&configuration(&rig, "carol")).expect("open");
    watcher.stop(None).expect("stopped");
    let error = wait_for("the fault", || hand.position(1).err());
    assert_eq!(error.kind(), RemoteErrorKind::Faulted, "{error}");
    assert_eq!(hand.send_position(1, [0.0, 0.5, 0.5]).expect_err("faulted").kind(), RemoteErrorKind::Faulted);
    rig.hand().push_simulated(1, [0.0, 1.0, 0.0]).expect("pushed");
    hand.recover(None).expect("recovered");
    wait_for("a position", || hand.position(1).ok());
    assert!(hand.is_owner());
    let held = rig.set_point();
    hand.send_damping(1, 1.0).expect("sent");
    hand.send_group(&[FingerCommand::new(2).joints([0.0, 0.5, 0.5])]).expect("sent");
    wait_for("finger 2", || (rig.hand().report(2).ok()?.set_point.joints.as_slice() == [0.0, 0.5, 0.5]).then_some(()));
    assert_eq!(rig.set_point(), held, "the place that was sent before the stop is not sent again");
    hand.release().expect("released");
    assert_eq!(hand.send_position(1, [0.0, 0.5, 0.5]).expect_err("released").kind(), RemoteErrorKind::NotOwner);
    hand.reopen().expect("acquired again, and recovered");
    wait_for("a position", || hand.position(1).ok());
    rig.server.end();
}

#[test]
fn a_hand_is_not_taken_over_while_a_finger_is_calibrated() {
    let rig = Rig::new(PATIENT);
    let hand = RemoteHand::open(&configuration(&rig, "alice")).expect("open");
    let mut other = configuration(&rig, "bob");
    other.take_over = true;
    std::thread::scope(|scope| {
        let calibration = scope.spawn(|| hand.zero(1));
        let stage = || rig.hand().report(1).expect("a report").stage;
        wait_for("the calibration", || (stage() == Stage::Calibrating).then_some(()));
        let error = RemoteHand::open(&other).map(drop).expect_err("a finger is calibrated");
        assert!(error.to_string().contains("repeat the request when that has ended"), "{error}");
        assert_eq!(stage(), Stage::Calibrating);
        assert!(hand.is_owner());
        RemoteHand::watch(&other).expect("bob may stop").stop(Some(1)).expect("stopped");
        let error = calibration.join().expect("no panic").expect_err("the calibration was stopped");
        assert_eq!(error.kind(), RemoteErrorKind::Faulted, "{error}");
    });
    let taken = RemoteHand::open(&other).expect("taken over");
    assert!(taken.is_owner());
    wait_for("the loss", || (!hand.is_owner()).then_some(()));
    rig.server.end();
}

#[test]
fn a_client_that_may_only_read_is_told_how_to_get_permission() {
    let rig = Rig::new("");
    let error = RemoteHand::open(&configuration(&rig, "carol")).map(drop).expect_err("carol only reads");
    assert_eq!(error.kind(), RemoteErrorKind::NotOwner);
    assert!(error.to_string().contains("[serve.clients]"), "{error}");
    let found = discover(&configuration(&rig, "carol")).expect("hands");
    assert_eq!(found.iter().map(|hand| hand.name.as_str()).collect::<Vec<_>>(), ["hand"]);
    rig.server.end();
}

fn certificates(folder: &Path, clients: &[&str]) {
    let clients = clients.iter().map(|name| name.parse().expect("a name")).collect();
    let servers = vec!["server".parse().expect("a name")];
    make(folder, &Wanted { servers, addresses: Vec::new(), clients }).expect("made");
}

/// The configuration of a client with the certificate of this name.
fn with_tls(rig: &Rig, folder: &Path, name: &str) -> RemoteConfiguration {
    let file = |name: String| folder.join(name);
    let (certificate, key) = (file(format!("{name}.pem")), file(format!("{name}.key")));
    let mut configuration = configuration(rig, name);
    configuration.client = None;
    configuration.tls = Some(RemoteTls { authority: file("ca.pem".into()), certificate, key });
    configuration
}

#[test]
fn with_tls_the_certificate_names_the_client() {
    let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    certificates(folder.path(), &["alice", "carol", "mallory"]);
    certificates(other.path(), &["alice"]);
    let endpoint = format!("tls/127.0.0.1:{}", free_port());
    let files = "authority = 'ca.pem'\ncertificate = 'server.pem'\nkey = 'server.key'\n";
    let text = format!("[serve]\nlisten = ['{endpoint}']\n{PATIENT}[serve.tls]\n{files}{CLIENTS}");
    let rig = Rig::from_text(&text, folder.path(), endpoint);

    let hand = RemoteHand::open(&with_tls(&rig, folder.path(), "alice")).expect("open");
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    wait_for("the set point", || (rig.set_point() == [0.1, 0.5, 0.9]).then_some(()));
    let group = [FingerCommand::new(2).joints([0.0, 0.5, 0.5])];
    send_together(&[(&hand, &group)]).expect("sent");

    let carol = RemoteHand::watch(&with_tls(&rig, folder.path(), "carol")).expect("she may read");
    assert!(carol.position(1).is_ok());
    let error = carol.reopen().expect_err("she may not command");
    assert_eq!(error.kind(), RemoteErrorKind::NotConnected);
    assert!(error.to_string().contains("[serve.clients]"), "{error}");

    let refused = |configuration: &RemoteConfiguration| {
        let error = RemoteHand::open(configuration).map(drop).expect_err("refused");
        (error.kind(), error.to_string())
    };
    let (kind, text) = refused(&with_tls(&rig, folder.path(), "mallory"));
    assert!(kind == RemoteErrorKind::NotConnected && text.contains("[serve.clients]"), "{text}");
    let (kind, text) = refused(&with_tls(&rig, other.path(), "alice"));
    assert!(kind == RemoteErrorKind::NotConnected && text.contains("the TLS handshake fails"), "{text}");
    let mut named = with_tls(&rig, folder.path(), "alice");
    named.client = Some("bob".parse().expect("a name"));
    let (kind, text) = refused(&named);
    assert!(
        kind == RemoteErrorKind::Configuration && text.contains("is that of alice, and remote.client is bob"),
        "{text}"
    );
    let mut swapped = with_tls(&rig, folder.path(), "alice");
    if let Some(tls) = &mut swapped.tls {
        tls.key = tls.certificate.clone();
    }
    let (kind, text) = refused(&swapped);
    assert!(kind == RemoteErrorKind::Configuration && text.contains("is not a private key in PEM"), "{text}");
    drop(hand);
    rig.server.end();
}

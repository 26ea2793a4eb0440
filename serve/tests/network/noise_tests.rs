//! Noise and spoiled Targets are refused and counted, and nothing moves: in process, and over loopback.

use super::noise::Noise;
use super::raw::{Raw, joints};
use super::security::{clients_of, loopback, simulated};
use std::sync::Arc;
use std::time::{Duration, Instant};
use sun2xp::realtime::now;
use sun2xp::{Hand, model::FingerNumber};
use sun2xp_remote_protocol::{ClientName, Counts, Target};
use sun2xp_serve::desk::Desk;
use sun2xp_serve::server::Server;

/// The owner's only command, rad.
const HELD: [f64; 3] = [0.1, 0.7, 0.8];

/// Largest motion of a finger that only holds its pose, rad. Gauge noise and friction cause this motion.
const STILL: f64 = 0.02;

/// Interval between two good Targets of the owner.
const REPEATED: Duration = Duration::from_millis(20);

/// Number of payloads over the wire after which the sender waits for an answer, so that the queues stay short and the
/// owner's Targets are not late.
const PACE: u64 = 100;

/// Number of messages that were not taken.
fn refused(counts: &Counts) -> u64 {
    counts.malformed + counts.old_epoch + counts.replayed + counts.late + counts.refused
}

/// Set point and pose of a finger, rad.
fn pose(hand: &Hand, finger: i32) -> ([f64; 3], [f64; 3]) {
    let report = hand.report(finger).expect("a finger");
    (report.set_point.joints.into(), hand.position(finger).expect("a finger"))
}

fn assert_still(hand: &Hand, before: &[([f64; 3], [f64; 3])]) {
    for (finger, before) in (1..).zip(before) {
        let after = pose(hand, finger);
        assert_eq!(after.0, before.0, "the set point of finger {finger} has changed");
        let moved = (0..3).map(|joint| (after.1[joint] - before.1[joint]).abs()).fold(0.0, f64::max);
        assert!(moved < STILL, "finger {finger} has moved by {moved} rad");
    }
}

fn poses(hand: &Hand) -> Vec<([f64; 3], [f64; 3])> {
    FingerNumber::ALL.iter().map(|finger| pose(hand, finger.index() as i32 + 1)).collect()
}

/// Gives `count` payloads to the desk of a hand that holds a pose for its owner.
fn noise_in_process(count: u64) {
    let (hand, settings) = simulated("noise", &clients_of(&["planner"]), "tcp/127.0.0.1:0", None);
    let hand = Arc::new(hand);
    let mut desk = Desk::new(Arc::clone(&hand), settings.limits, now());
    let planner: ClientName = "planner".parse().expect("a name");
    let epoch = 0x1234_5678_9ABC_DEF0;
    desk.acquire(&planner, false, epoch, now()).expect("nobody owns the hand");
    assert!(desk.begin(&planner, epoch, now()));
    let mut sequence = 0;
    let mut next = |parts| {
        sequence += 1;
        let time = now();
        Target { validity_ms: 100, epoch, sequence, sent: time, seen: time, parts }
    };
    let parts: Vec<_> = (1..=3).map(|finger| joints(finger, 1, HELD)).collect();
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_secs(3) {
        let good = next(parts.clone()).encode().expect("a good Target");
        desk.take_target(&planner, &good, now());
        desk.look(now());
        std::thread::sleep(REPEATED);
    }
    let (before, counted) = (poses(&hand), *desk.counts());
    let mut noise = Noise::new(31);
    let (mut good, mut newest, mut repeated) = (0, 0, Instant::now());
    for number in 0..count {
        if number % 64 == 0 && repeated.elapsed() >= REPEATED {
            let target = next(parts.clone());
            desk.take_target(&planner, &target.encode().expect("a good Target"), now());
            desk.look(now());
            (good, newest, repeated) = (good + 1, target.sequence, Instant::now());
        }
        desk.take_target(&planner, &noise.payload(&next(Vec::new()), newest), now());
    }
    let after = desk.counts();
    assert_eq!(after.taken - counted.taken, good, "noise was taken: {after:?}");
    assert_eq!(refused(after) - refused(&counted), count, "{after:?}");
    assert_still(&hand, &before);
    println!("{count} payloads: {after:?}");
}

#[test]
fn noise_is_refused_and_counted_and_nothing_moves() {
    noise_in_process(200_000);
}

#[test]
#[ignore = "takes minutes"]
fn ten_million_payloads_are_refused_and_counted_and_nothing_moves() {
    noise_in_process(10_000_000);
}

/// Sends `count` payloads to a server, which holds a pose for the sender.
fn noise_over_the_wire(count: u64) {
    let endpoint = loopback();
    let (hand, settings) = simulated("wire", &clients_of(&["planner"]), &endpoint, None);
    let server = Server::start(hand, settings).expect("the server starts");
    let mut raw = Raw::connect(&endpoint, "hand", "planner", None).expect("connected");
    raw.acquire(false).expect("an answer");
    let parts: Vec<_> = (1..=3).map(|finger| joints(finger, 1, HELD)).collect();
    let begin = Instant::now();
    while begin.elapsed() < Duration::from_secs(3) {
        raw.send(parts.clone());
        std::thread::sleep(REPEATED);
    }
    let (before, counted) = (poses(server.hand()), raw.status().expect("an answer").counts);
    let good = raw.good;
    let mut noise = Noise::new(32);
    let (mut newest, mut repeated) = (0, Instant::now());
    for number in 0..count {
        if number % PACE == 0 {
            raw.status().expect("an answer");
        }
        if repeated.elapsed() >= REPEATED {
            raw.send(parts.clone());
            (newest, repeated) = (raw.sequence, Instant::now());
        }
        let next = raw.target(Vec::new());
        raw.put(noise.payload(&next, newest));
    }
    let counts = |counts: &Counts| counts.taken + refused(counts);
    let after = raw.until(|status| counts(&status.counts) - counts(&counted) >= count);
    let good = raw.good - good;
    assert_eq!(counts(&after.counts) - counts(&counted), count + good, "{:?}", after.counts);
    // A good Target may be late if the machine is busy. No payload except good Targets is taken.
    assert!(after.counts.taken - counted.taken <= good, "noise was taken: {:?}", after.counts);
    assert_still(server.hand(), &before);
    assert_eq!(after.owner.map(|owner| owner.to_string()), Some("planner".into()), "the owner has lost the hand");
    println!("{count} payloads: {:?}", after.counts);
    server.end();
}

#[test]
fn noise_over_the_wire_is_refused_and_counted_and_nothing_moves() {
    noise_over_the_wire(10_000);
}

#[test]
#[ignore = "takes a minute"]
fn a_hundred_thousand_payloads_over_the_wire_are_refused_and_counted() {
    noise_over_the_wire(100_000);
}

//! Runs planners in the styles of 1990 and later. The planners are linked against libsun2xp and know nothing of the
//! network. Most planners run on a simulated hand of this machine, and on the same hand behind a server. Such a planner
//! must print the same in both runs: results, errnos and texts exactly, and numbers with a decimal point, such as
//! poses, within 0.01. The other planners run only on the hand behind the server, and must print given texts.

mod rig;

use rig::{Rig, Way};
use std::process::ExitStatus;

/// Largest difference of two numbers with a decimal point, in the unit of the numbers.
const TOLERANCE: f64 = 0.01;

/// A number with a decimal point, without the punctuation that follows it.
fn number(word: &str) -> Option<f64> {
    let trimmed = word.trim_end_matches([',', ':', '.']);
    trimmed.contains('.').then(|| trimmed.parse().ok()).flatten()
}

fn same(one: &str, other: &str) -> bool {
    match (number(one), number(other)) {
        (Some(one), Some(other)) => (one - other).abs() <= TOLERANCE,
        _ => one == other,
    }
}

fn assert_alike(planner: &str, way: Way, local: &(ExitStatus, String), remote: &(ExitStatus, String)) {
    let words = |text: &str| -> Vec<String> { text.split_whitespace().map(str::to_owned).collect() };
    let (here, there) = (words(&local.1), words(&remote.1));
    let alike = here.len() == there.len() && here.iter().zip(&there).all(|(one, other)| same(one, other));
    assert!(
        alike && local.0 == remote.0,
        "{planner} {way:?}: {} and {}\nhere:\n{}\nthere:\n{}",
        local.0,
        remote.0,
        local.1,
        remote.1
    );
    assert!(!here.is_empty(), "{planner} says something");
}

/// Runs a planner on the simulated hand of this machine, and then on the hand of the server in each of these ways.
fn alike(planner: &str, flags: &[&str], ways: &[Way]) {
    let rig = Rig::start();
    let program = rig.planners.compile(planner, flags);
    let local = rig.planners.run(&program, Way::Local);
    for &way in ways {
        let remote = rig.planners.run(&program, way);
        assert_alike(planner, way, &local, &remote);
    }
}

/// The ways to the hand of the server. Some planners test both ways. Each of the other planners tests one way, because
/// both ways lead to the same code.
const BY_BOTH: &[Way] = &[Way::Configured, Way::Path];
const BY_CONFIGURATION: &[Way] = &[Way::Configured];
const BY_PATH: &[Way] = &[Way::Path];

#[test]
fn the_oldest_planner() {
    alike("oldest.c", &["-std=gnu89", "-w"], BY_BOTH);
}

#[test]
fn one_that_polls() {
    alike("polls.c", &["-std=c89"], BY_CONFIGURATION);
}

#[test]
fn three_fingers() {
    alike("three.c", &["-std=gnu89", "-w"], BY_PATH);
}

#[test]
fn one_that_sends_nonsense_and_looks_at_nothing() {
    alike("careless.c", &["-std=c99"], BY_CONFIGURATION);
}

#[test]
fn every_refusal() {
    alike("refusals.c", &["-std=c11"], BY_BOTH);
}

#[test]
fn one_with_a_timer() {
    alike("alarms.c", &["-std=gnu99"], BY_CONFIGURATION);
}

#[test]
fn one_that_forks() {
    alike("forks.c", &["-std=gnu99"], BY_BOTH);
}

#[test]
fn one_that_jumps() {
    alike("jumps.c", &["-std=gnu89"], BY_PATH);
}

#[test]
fn one_with_threads() {
    alike("threads.c", &["-std=gnu99"], BY_CONFIGURATION);
}

#[test]
fn one_that_leaves_the_hand_open() {
    alike("leaves.c", &["-std=c99"], BY_BOTH);
}

#[test]
fn one_that_opens_again_and_again() {
    alike("reopens.c", &["-std=c99"], BY_CONFIGURATION);
}

#[test]
fn one_that_streams() {
    alike("streams.c", &["-std=gnu99"], BY_PATH);
}

#[test]
fn one_that_changes_the_stiffness() {
    alike("softens.c", &["-std=gnu89", "-w"], BY_CONFIGURATION);
}

#[test]
fn one_that_is_interrupted() {
    alike("interrupted.c", &["-std=gnu99"], BY_CONFIGURATION);
}

#[test]
fn one_with_a_table() {
    alike("table.c", &["-std=gnu99"], BY_PATH);
}

#[test]
fn one_with_both_headers() {
    alike("both.c", &["-std=gnu11"], BY_BOTH);
}

#[test]
fn one_with_events_and_an_emergency_stop() {
    alike("events.c", &["-std=gnu99"], BY_BOTH);
}

#[test]
fn one_that_waits_for_a_finger_that_is_being_zeroed() {
    alike("waits.c", &["-std=gnu99"], BY_CONFIGURATION);
}

/// After a planner has lost the hand, a call that recovers one finger leaves the others stopped.
#[test]
fn one_that_loses_the_hand() {
    let rig = Rig::start();
    let said = rig.planners.said("loses.c", Way::Configured);
    assert_eq!(said, "stop 0\nrecovered 1, stopped 1 1\nrecovered 1, stopped 0 0\n");
}

/// The hand is released even if a thread of the planner still waits for an event.
#[test]
fn one_that_closes_while_it_waits_for_events() {
    let rig = Rig::start();
    for &way in BY_BOTH {
        assert_eq!(rig.planners.said("ends.c", way), "close 0\nanother 0\nclose 0\n", "{way:?}");
    }
}

/// A client that the server does not list may not command the hand. The text names the key.
#[test]
fn one_that_may_not_command() {
    let rig = Rig::start();
    let stranger = rig::remote(&rig.endpoint).replace("planner", "stranger");
    std::fs::write(rig.planners.place("remote.toml"), stranger).expect("a file");
    for &way in BY_BOTH {
        let said = rig.planners.said("opens.c", way);
        assert!(said.starts_with(&format!("-1 {} OpenHand: ", libc::EACCES)), "{way:?} {said}");
        assert!(said.contains("[serve.clients]"), "{way:?} {said}");
    }
}

/// Calls that a hand on another machine does not support are refused with ENOTSUP, and the hand stays open.
#[test]
fn calls_that_do_not_reach_the_hand_say_so() {
    let rig = Rig::start();
    for &way in BY_BOTH {
        assert_eq!(rig.planners.said("others.c", way), "open_io -16\nothers 0\n", "{way:?}");
    }
}

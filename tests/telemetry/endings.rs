//! Tests what a reader sees when its hand is closed, when the hand's process is killed by SIGKILL, and when a forked
//! child survives its killed parent. Tests also that a killed reader disturbs neither its hand nor other readers.

use crate::support::{OtherProcess, name, open, read_for, reader};
use std::fs;
use std::time::{Duration, Instant};
use sun2xp::telemetry::{AttachError, Ended, Reader, hands};

/// Reads until the end, for at most 5 s.
fn read_to_the_end(reader: &mut Reader) -> Ended {
    let limit = Instant::now() + Duration::from_secs(5);
    loop {
        if let Err(ended) = reader.read(Duration::from_millis(500), &mut Vec::new()) {
            return ended;
        }
        assert!(Instant::now() < limit, "the reader does not see the end");
    }
}

#[test]
fn a_closed_hand_is_a_clear_end() {
    let name = name("closed");
    let hand = open(&name);
    let mut reader = reader(&name);
    read_for(&mut reader, Duration::from_millis(200), &mut Vec::new());
    drop(hand);
    assert_eq!(read_to_the_end(&mut reader), Ended::Closed);
    assert_eq!(reader.read(Duration::ZERO, &mut Vec::new()), Err(Ended::Closed), "the end stays");
    assert!(matches!(Reader::attach(Some(&name)), Err(AttachError::Unknown { .. })));
}

#[test]
fn a_killed_hand_leaves_nothing_behind_and_is_a_clear_end() {
    let name = name("killed");
    let mut process = OtherProcess::with_hand(&name);
    let mut reader = reader(&name);
    read_for(&mut reader, Duration::from_millis(200), &mut Vec::new());
    assert!(hands().expect("names").contains(&name));
    // The shared memory of the hand has no file in /dev/shm, so none can be left behind. The contents of /dev/shm are
    // not compared, because other programs of the machine use that folder too.
    let mapped = fs::read_to_string(format!("/proc/{}/maps", process.child.id())).expect("the memory of the process");
    assert!(mapped.contains("/memfd:sun2xp telemetry"), "{mapped}");
    assert!(!mapped.contains("/dev/shm/"), "{mapped}");
    process.kill();
    assert_eq!(read_to_the_end(&mut reader), Ended::Closed);
    drop(reader);
    let sockets = fs::read_to_string("/proc/net/unix").expect("the table");
    assert!(!sockets.contains(&name), "{sockets}");
    assert!(!hands().expect("names").contains(&name));
}

#[test]
fn a_forked_child_that_survives_does_not_hide_the_end() {
    let name = name("forked");
    let mut process = OtherProcess::with_forked_hand(&name);
    let mut reader = reader(&name);
    read_for(&mut reader, Duration::from_millis(200), &mut Vec::new());
    process.kill();
    assert_eq!(read_to_the_end(&mut reader), Ended::Closed);
    assert!(!hands().expect("names").contains(&name), "the child's copy of the socket is no hand");
}

#[test]
fn a_killed_reader_disturbs_neither_hand_nor_other_readers() {
    let name = name("bystander");
    let hand = open(&name);
    let mut own = reader(&name);
    let mut other = OtherProcess::with_reader(&name);
    let mut messages = Vec::new();
    read_for(&mut own, Duration::from_millis(300), &mut messages);
    other.kill();
    read_for(&mut own, Duration::from_millis(300), &mut messages);
    assert_eq!(own.lost(), [0; 3]);
    drop(own);
    // The hand releases the shared memory when its last reader has ended, and serves the next reader again.
    std::thread::sleep(Duration::from_millis(200));
    let mut next = reader(&name);
    read_for(&mut next, Duration::from_millis(300), &mut messages);
    assert_eq!(next.lost(), [0; 3]);
    drop(hand);
}

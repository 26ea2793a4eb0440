//! Telemetry of open hands with simulated boards: what readers in this and in other processes receive.

#[allow(dead_code)]
#[path = "../common/pauses.rs"]
mod pauses;

#[allow(dead_code)]
#[path = "../common/tools.rs"]
mod tools;

mod contents;
mod endings;
mod hostile;
mod naming;
mod raw;
mod slow;
mod support;

use std::time::Duration;
use sun2xp::model::FingerNumber;
use sun2xp::telemetry::Message;
use support::{child_is_told_what_to_do, cycles, name, open, read_for, reader};

#[test]
fn two_readers_get_every_cycle_in_order() {
    let name = name("two");
    let hand = open(&name);
    let mut readers = [reader(&name), reader(&name)];
    let mut received: [Vec<Message>; 2] = Default::default();
    for _ in 0..3 {
        for (reader, received) in readers.iter_mut().zip(&mut received) {
            read_for(reader, Duration::from_millis(300), received);
        }
    }
    drop(hand);
    for ((number, reader), mut received) in readers.iter_mut().enumerate().zip(received) {
        while reader.read(Duration::from_secs(1), &mut received).is_ok() {}
        assert_eq!(reader.lost(), [0; 3], "reader {number}");
        for finger in FingerNumber::ALL {
            let cycles = cycles(&received, finger);
            assert!(cycles.len() > 700, "reader {number}, finger {finger}: {} cycles", cycles.len());
            let gap = cycles.windows(2).find(|pair| pair[1] != pair[0] + 1);
            assert_eq!(gap, None, "reader {number}, finger {finger}");
        }
    }
}

#[test]
fn a_child_process() {
    child_is_told_what_to_do();
}

//! Tests that a hand which was closed leaves no threads, descriptors or memory behind. The other tests of this process
//! would disturb the counts, so this test runs alone.

use crate::server::{FakeServer, configuration, free_port};
use std::fs::{read_dir, read_to_string};
use sun2xp_remote_client::RemoteHand;

/// Threads, descriptors, and kilobytes of memory of this process.
fn used() -> [usize; 3] {
    let count = |folder| read_dir(folder).expect("a folder of /proc").count();
    let status = read_to_string("/proc/self/status").expect("/proc/self/status");
    let memory = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).expect("VmRSS");
    let memory = memory.trim().trim_end_matches(" kB").parse().expect("a number");
    [count("/proc/self/task"), count("/proc/self/fd"), memory]
}

#[test]
#[ignore = "it runs alone: cargo test -p sun2xp-remote-client --test over_zenoh leaks -- --ignored --nocapture"]
fn opening_and_closing_leaks_nothing() {
    let port = free_port();
    let _server = FakeServer::start(port, &["left"]);
    let mut before = [0; 3];
    for run in 1..=300 {
        let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
        let events = hand.events();
        hand.send_position(1, [0.5; 3]).expect("sent");
        hand.close().expect("released");
        assert!(events.is_closed());
        // The first runs create everything that is created once and then kept.
        if run == 50 {
            before = used();
        }
    }
    let after = used();
    println!("threads, descriptors, kB after 50 runs: {before:?}, after 300 runs: {after:?}");
    assert!(after[0] <= before[0] && after[1] <= before[1], "{before:?} {after:?}");
    assert!(after[2] < before[2] + 4096, "more than 16 kB a run: {before:?} {after:?}");
}

//! The planner or the line fails: the fingers are caught (held softly where they are), go to their end states, and
//! follow the next planner. `cargo bench -p sun2xp-serve --bench outage` repeats each failure a hundred times.

use super::outage::{CATCH_GOAL, CATCH_MS, END_GOAL, Failure, Rig};
use super::permitted_line;
use super::process::Resources;
use crate::attempts::attempts;
use crate::pauses::Part;
use std::time::{Duration, Instant};

/// Repetitions of each failure.
const REPETITIONS: usize = 3;

/// The goal for the catch allows this much more than `catch_ms`.
const TOLERATED_PAUSE: Duration = Duration::from_millis(20);

/// Longest time in which the server notices that the connection of a lost client is over.
const LEASE: Duration = Duration::from_secs(14);

#[test]
fn every_failure_is_caught_and_the_next_planner_gets_the_hand() {
    let Some(line) = permitted_line(10) else { return };
    let mut rig = Rig::new(line, "outage", CATCH_MS);
    // The server creates threads and buffers when the first planners connect.
    for failure in Failure::ALL {
        rig.fail(failure);
    }
    let before = settled(&rig, None);
    for failure in Failure::ALL {
        for repetition in 0..REPETITIONS {
            attempts(&format!("{failure:?}, repetition {repetition}"), TOLERATED_PAUSE, |watch| {
                watch.also(rig.served.process(), Part::Servo);
                let outcome = rig.fail(failure);
                let (pause, lost) = (outcome.pause, outcome.lost);
                println!("{failure:?} {repetition}: {outcome:?}; a pause of {pause:.0} ms, {lost} cycles are missing");
                let in_time = outcome.caught <= CATCH_GOAL && outcome.ended <= END_GOAL;
                // The finger is held where it is.
                if in_time && outcome.distance < 0.01 { Ok(()) } else { Err(format!("{outcome:?}")) }
            });
        }
    }
    let after = settled(&rig, Some(before));
    assert!(after.threads <= before.threads, "threads are left: {before:?}, {after:?}");
    assert!(after.descriptors <= before.descriptors, "descriptors are left: {before:?}, {after:?}");
}

/// Waits until the connections of the lost clients are over, and returns what the server uses.
fn settled(rig: &Rig, expected: Option<Resources>) -> Resources {
    let (mut found, mut since) = (Resources::of(rig.served.process()), Instant::now());
    loop {
        let now = Resources::of(rig.served.process());
        if (now.threads, now.descriptors) != (found.threads, found.descriptors) {
            (found, since) = (now, Instant::now());
        }
        let below = |expected: Resources| now.threads <= expected.threads && now.descriptors <= expected.descriptors;
        if expected.is_some_and(below) || since.elapsed() > LEASE {
            return now;
        }
        std::thread::sleep(Duration::from_millis(200));
    }
}

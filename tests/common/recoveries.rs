//! Recoveries that a pause of the machine can spoil.

use crate::attempts::attempts;
use crate::pauses::Part;
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::hand::{Hand, HandError};

/// A recovery asks a board every 50 ms, and gives it 300 ms to answer. A pause of less than 100 ms leaves enough time.
pub const TOLERATED_PAUSE: Duration = Duration::from_millis(100);

/// Longest time from a request to stop until the fault.
const LIMIT: Duration = Duration::from_secs(20);

/// Recovers a faulted finger. A refusal of the recovery is excused only if a pause of the hand or of its boards
/// was measured. After such a refusal the finger is stopped and recovered again, until more recoveries have succeeded
/// than were refused. `boards` are the processes of boards that are not in this process.
pub fn recovers_despite_pauses(hand: &Hand, finger: i32, boards: &[u32]) {
    recovers_unless(hand, finger, boards, |_| false);
}

/// Does the same as [`recovers_despite_pauses`]. No pause excuses an error for which `inexcusable` returns true.
pub fn recovers_unless(hand: &Hand, finger: i32, boards: &[u32], inexcusable: impl Fn(&HandError) -> bool) {
    attempts(&format!("recovery of finger {finger}"), TOLERATED_PAUSE, |watch| {
        boards.iter().for_each(|&board| watch.also(board, Part::Board));
        stop(hand, finger);
        let recoveries = || hand.report(finger).expect("a report").recoveries;
        let before = recoveries();
        hand.recover(finger).map_err(|error| {
            assert!(!inexcusable(&error), "finger {finger}: {error}");
            error.to_string()
        })?;
        assert_eq!(recoveries(), before + 1);
        Ok(())
    });
}

/// Stops a finger that runs, and waits until it has faulted.
fn stop(hand: &Hand, finger: i32) {
    let faulted = || matches!(hand.report(finger).expect("a report").stage, Stage::Faulted(_));
    if faulted() {
        return;
    }
    hand.stop(finger).expect("a finger");
    let begun = Instant::now();
    while !faulted() {
        assert!(begun.elapsed() < LIMIT, "finger {finger} does not stop");
        std::thread::sleep(Duration::from_millis(2));
    }
}

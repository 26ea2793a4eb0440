//! Readers that are too slow.

use crate::support::{cycles, name, open, read_for, reader};
use std::time::Duration;
use sun2xp::model::FingerNumber;

#[test]
fn a_sleeping_reader_counts_the_cycles_that_it_loses_and_other_readers_lose_none() {
    let name = name("slow");
    let hand = open(&name);
    let (mut slow, mut awake) = (reader(&name), reader(&name));
    let (mut of_slow, mut of_awake) = (Vec::new(), Vec::new());
    read_for(&mut slow, Duration::from_millis(200), &mut of_slow);
    // For 8 s, only `awake` reads. The ring holds the messages of 2 s.
    for _ in 0..80 {
        read_for(&mut awake, Duration::from_millis(100), &mut of_awake);
    }
    read_for(&mut slow, Duration::from_millis(300), &mut of_slow);
    read_for(&mut awake, Duration::from_millis(100), &mut of_awake);
    let collected = hand.losses(1).expect("losses");
    drop(hand);
    while slow.read(Duration::from_secs(1), &mut of_slow).is_ok() {}
    while awake.read(Duration::from_secs(1), &mut of_awake).is_ok() {}
    assert_eq!(awake.lost(), [0; 3], "{collected:?}");
    for finger in FingerNumber::ALL {
        let lost = slow.lost()[finger.index()];
        assert!(lost > 1000, "finger {finger}: {lost}");
        let arrived = cycles(&of_slow, finger);
        let (first, last) = (arrived[0], *arrived.last().expect("cycles"));
        assert_eq!(arrived.len() as u64 + lost, last - first + 1, "every cycle has arrived or is counted");
        assert!(arrived.is_sorted());
        let all = cycles(&of_awake, finger);
        assert_eq!(all.len() as u64, all.last().expect("cycles") - all[0] + 1);
    }
}

//! Files of black boxes: a file is written whole or not at all, and no file, however it was altered, makes a replay
//! panic, hang or exhaust the memory.

mod writing;

use std::sync::OnceLock;
use std::time::{Duration, Instant};
use sun2xp::finger::Recording;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

/// A short recording of a simulated finger with set points, springs and an adjustment.
fn recording() -> &'static Recording {
    static RECORDING: OnceLock<Recording> = OnceLock::new();
    RECORDING.get_or_init(|| {
        let mut configuration = Configuration::default();
        configuration.hand.rate = 750.0;
        let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"));
        let cycles = |count: u64| {
            let now = || hand.report(1).expect("a report").losses.cycles;
            let (begun, end) = (Instant::now(), now() + count);
            while now() < end {
                assert!(begun.elapsed() < Duration::from_secs(20), "the servo does not run");
                std::thread::sleep(Duration::from_millis(2));
            }
        };
        hand.send_position(1, [0.1, 0.5, 1.1]).expect("sent");
        cycles(60);
        hand.adjust(1, "tendon.minimum = 6").expect("adjusted");
        hand.send_stiffness(1, [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.5]]).expect("sent");
        cycles(60);
        hand.recording(1).expect("a recording")
    })
}

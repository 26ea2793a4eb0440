//! The servo loop must cause no page fault. This test runs alone in its process, because a fork by another test would
//! make the servo threads fault on each of their pages once more.

use std::fs;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, RealTime};

/// Returns the name of each servo thread of this process, and the number of its page faults so far, minor and major.
fn page_faults() -> Vec<(String, u64)> {
    let threads = fs::read_dir("/proc/self/task").expect("the threads of this process");
    let stat = threads.map(|thread| fs::read_to_string(thread.expect("a thread").path().join("stat")));
    let mut faults: Vec<_> = stat
        .filter_map(|stat| {
            let stat = stat.ok()?;
            let (name, fields) = stat.split_once('(')?.1.rsplit_once(") ")?;
            // The list begins with the state, field 3 of proc(5). minflt is field 10, and majflt is field 12.
            let fields: Vec<&str> = fields.split(' ').collect();
            let count = |field: usize| fields[field - 3].parse::<u64>().expect("a number");
            name.starts_with("sun2xp servo").then(|| (name.to_owned(), count(10) + count(12)))
        })
        .collect();
    faults.sort();
    faults
}

#[test]
fn a_servo_thread_causes_no_page_fault() {
    // Threads that are not real-time wait for other threads of the machine, so the second hand runs at a lower rate.
    for (real_time, rate, periods) in [(RealTime::Try, 1000.0, 1000), (RealTime::Ignore, 500.0, 400)] {
        let mut configuration = Configuration::default();
        (configuration.hand.real_time, configuration.hand.rate) = (real_time, rate);
        let hand = Hand::open(configuration).expect("the simulated hand");
        let cycles = |finger| hand.report(finger).expect("a report").losses.cycles;
        let before = page_faults();
        assert_eq!(before.len(), 3, "{before:?}");
        if real_time == RealTime::Try {
            // The threads of the second hand may reuse the stacks of the first.
            assert!(before.iter().all(|(_, faults)| *faults > 0), "starting a thread causes page faults: {before:?}");
        }
        let end = [1, 2, 3].map(|finger| cycles(finger) + periods);
        let mut angle = 0.0;
        while (1..=3).any(|finger| cycles(finger) < end[finger as usize - 1]) {
            angle = (angle + 0.1) % 0.5;
            for finger in 1..=3 {
                hand.send_position(finger, [0.1, 0.5, 1.0 + angle]).expect("sent");
            }
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        assert_eq!(page_faults(), before, "{real_time:?}");
    }
}

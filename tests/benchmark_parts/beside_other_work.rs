//! The benchmark `throughput` on a machine with other work. Servos without a rate limit once lost all of their replies
//! there, and the benchmark measured nothing.

use crate::cores::permitted;
use crate::throughput::{Arguments, MEASURE, OPEN, UnlimitedClock, measure};
use crate::turn;
use std::hint::spin_loop;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering::Relaxed};
use std::thread::{JoinHandle, spawn};
use sun2xp::realtime::Clock;

/// One thread for each core. Each thread computes without a pause. Dropping this value ends the threads.
struct OtherWork {
    ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
}

impl OtherWork {
    fn begin() -> Self {
        let ended = Arc::new(AtomicBool::new(false));
        let work = |_| {
            let ended = ended.clone();
            spawn(move || {
                while !ended.load(Relaxed) {
                    spin_loop();
                }
            })
        };
        let threads = permitted().expect("known").into_iter().map(work).collect();
        Self { ended, threads }
    }
}

impl Drop for OtherWork {
    fn drop(&mut self) {
        self.ended.store(true, Relaxed);
        self.threads.drain(..).for_each(|thread| thread.join().expect("no panic"));
    }
}

#[test]
fn throughput_measures_every_finger_beside_other_work() {
    let _turn = turn();
    let _other_work = OtherWork::begin();
    let rows = measure(&Arguments { seconds: 1, ..Arguments::default() }).expect("three fingers");
    for (finger, row) in (1..).zip(&rows) {
        let (rate, lost, ended) = row.as_ref().unwrap_or_else(|reason| panic!("finger {finger}: {reason}"));
        println!("finger {finger}: {rate:.0} cycles a second, {lost} lost replies, ended early: {ended:?}");
        assert!(*rate > 100.0, "finger {finger}: {rate} cycles a second");
    }
    assert_eq!(rows.len(), 3);
}

/// A servo that has real-time priority and never sleeps prevents the system from transporting bytes. Without permission
/// for real-time priority, the test above does not find this defect. This test finds it in any case.
#[test]
fn the_servos_sleep_until_the_fingers_are_under_control() {
    let clock = UnlimitedClock { phase: Arc::new(AtomicU8::new(OPEN)) };
    let soon = clock.now() + 5_000_000;
    clock.sleep_until(soon);
    assert!(clock.now() >= soon);
    clock.phase.store(MEASURE, Relaxed);
    let late = clock.now() + 60_000_000_000;
    clock.sleep_until(late);
    assert!(clock.now() < late);
}

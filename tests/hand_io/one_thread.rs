//! Fingers that share a servo thread. Some hardware sends one telegram for all fingers of a thread. These tests check
//! what such hardware relies on.

use super::plant_io::PlantIo;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::Hand;
use sun2xp::finger::Stage;
use sun2xp::io::{FingerIo, IoCommand, IoProperties, IoSample, IoTerms};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Mutex;

/// Longest wait for anything.
const PATIENCE: Duration = Duration::from_secs(10);

/// What the fingers share.
#[derive(Default)]
struct Shared {
    /// The exchanges in their order: the index of the finger, and the deadline.
    exchanges: Mutex<Vec<(usize, u64)>>,
    /// Whether a start first waits for an exchange with another finger.
    waits: AtomicBool,
    /// Number of calls of `properties`.
    asked: Mutex<u32>,
}

impl Shared {
    /// Waits for this number of exchanges from now on.
    fn wait_for_exchanges(&self, number: usize) {
        let (before, begun) = (self.exchanges.lock().len(), Instant::now());
        while self.exchanges.lock().len() < before + number {
            assert!(begun.elapsed() < PATIENCE, "no exchange takes place");
            sleep(Duration::from_millis(1));
        }
    }
}

/// A finger whose exchanges are noted.
struct Noted {
    plant: PlantIo,
    place: usize,
    shared: Arc<Shared>,
}

impl FingerIo for Noted {
    fn properties(&self) -> IoProperties {
        *self.shared.asked.lock() += 1;
        self.plant.properties()
    }

    fn start(&mut self, terms: &IoTerms) -> io::Result<IoSample> {
        if self.shared.waits.load(Ordering::Relaxed) {
            self.shared.wait_for_exchanges(1);
        }
        self.plant.start(terms)
    }

    fn exchange(&mut self, command: &IoCommand) -> io::Result<IoSample> {
        self.shared.exchanges.lock().push((self.place, command.deadline));
        self.plant.exchange(command)
    }

    fn stop(&mut self) -> io::Result<()> {
        self.plant.stop()
    }
}

/// Opens a hand with three fingers in one servo thread.
fn open() -> (Hand, Arc<Shared>) {
    let mut configuration = Configuration::default();
    configuration.hand.watchdog_ms = 200;
    configuration.fingers.iter_mut().for_each(|finger| finger.thread = 1);
    let shared = Arc::new(Shared::default());
    let io = FingerNumber::ALL.map(|number| {
        let plant = PlantIo::new(&configuration, number, true);
        Some(Box::new(Noted { plant, place: number.index(), shared: shared.clone() }) as Box<dyn FingerIo>)
    });
    (Hand::open_with_io(configuration, io).expect("open"), shared)
}

fn wait_for_fault(hand: &Hand, finger: i32) {
    let begun = Instant::now();
    while !matches!(hand.report(finger).expect("a report").stage, Stage::Faulted(_)) {
        assert!(begun.elapsed() < PATIENCE, "finger {finger} does not stop");
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_new_deadline_marks_the_first_exchange_of_a_cycle_even_if_finger_1_is_stopped() {
    let (hand, shared) = open();
    let cycles_of = |fingers: &[usize]| {
        shared.exchanges.lock().clear();
        shared.wait_for_exchanges(60);
        let exchanges = shared.exchanges.lock();
        // The first cycle may have begun before the list was cleared, and the last one may not be complete.
        let mut cycles = exchanges.chunk_by(|one, next| one.1 == next.1).skip(1).collect::<Vec<_>>();
        cycles.pop();
        assert!(cycles.is_sorted_by(|one, next| one[0].1 < next[0].1), "the deadlines increase from cycle to cycle");
        for cycle in cycles {
            let order: Vec<usize> = cycle.iter().map(|&(place, _)| place).collect();
            assert_eq!(order, fingers);
        }
    };
    cycles_of(&[0, 1, 2]);
    hand.stop(1).expect("asked");
    wait_for_fault(&hand, 1);
    cycles_of(&[1, 2]);
    hand.close();
}

#[test]
fn a_start_at_a_recovery_overlaps_with_exchanges_of_the_other_fingers() {
    let (hand, shared) = open();
    hand.stop(2).expect("asked");
    wait_for_fault(&hand, 2);
    shared.waits.store(true, Ordering::Relaxed);
    hand.recover(2).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(hand.report(2).expect("a report").stage, Stage::Running);
    hand.close();
}

#[test]
fn the_properties_of_the_hardware_are_read_once() {
    let (hand, shared) = open();
    assert_eq!(*shared.asked.lock(), 3, "once for each finger");
    hand.close();
}

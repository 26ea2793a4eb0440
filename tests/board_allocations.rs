//! A servo thread must not allocate. This test checks the link between a servo thread and its boards.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use sun2xp::board::protocol::Command;
use sun2xp::board::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand};
use sun2xp::realtime::{Priority, now};
use sun2xp::simulated::*;

const MS: u64 = 1_000_000;

/// The system's allocator with a count of requests for each thread.
struct Counting;

thread_local! {
    static REQUESTS: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // The access fails while a thread ends. Nothing is counted then.
    let _ = REQUESTS.try_with(|requests| requests.set(requests.get() + 1));
}

// SAFETY: every call is passed to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller satisfies the contract of this same function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        count();
        // SAFETY: the caller satisfies the contract of this same function.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Hardware that a program provides. Every second exchange with it fails.
struct Failing;

impl FingerIo for Failing {
    fn start(&mut self, _: &IoTerms) -> std::io::Result<IoSample> {
        Ok(IoSample { tensions: [5.0; 4], ..Default::default() })
    }

    fn exchange(&mut self, command: &IoCommand) -> std::io::Result<IoSample> {
        match command.number.is_multiple_of(2) {
            true => Err(std::io::Error::from_raw_os_error(libc::EIO)),
            false => Ok(IoSample { tensions: [6.0; 4], encoders: [7; 4], ..Default::default() }),
        }
    }

    fn stop(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_cycle_with_hardware_of_the_program_allocates_nothing() {
    let mut configuration = Configuration::default();
    configuration.hand.watchdog_ms = 500;
    let board = IoBoard::new(&configuration, FingerNumber::ONE, Box::new(Failing), Default::default()).unwrap();
    let mut link = Link::new(Connection::from(board));
    let terms = Terms::new(&configuration.hand, &ConfiguredFinger::default());
    link.shake_hands(1, &terms, now() + 2000 * MS).unwrap();

    let before = REQUESTS.get();
    let mut answered = 0;
    for sequence in 0..20 {
        let command = Command { toggle: true, enable: true, torques: [100; 4] };
        link.send(&[OutgoingCommand { address: 1, sequence, command }]).unwrap();
        answered += usize::from(link.receive(now() + MS).unwrap().is_some());
    }
    assert!(link.stop(1, now() + MS).unwrap());
    assert_eq!((REQUESTS.get() - before, answered), (0, 10));
}

#[test]
fn a_cycle_allocates_nothing_whether_answered_or_not() {
    let board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).unwrap();
    let board = SimulatedPort::start(board, Pace::RealTime, Priority::default()).unwrap();
    let mut link = Link::open(&board.path(), 1_000_000).unwrap();
    let terms = Terms::new(&ConfiguredHand { watchdog_ms: 500, ..Default::default() }, &ConfiguredFinger::default());
    link.shake_hands(1, &terms, now() + 2000 * MS).unwrap();

    let before = REQUESTS.get();
    let mut answered = 0;
    for sequence in 0..20 {
        let command = Command { toggle: true, enable: true, torques: [100; 4] };
        link.send(&[OutgoingCommand { address: 1, sequence, command }]).unwrap();
        answered += usize::from(link.receive(now() + 1000 * MS).unwrap().is_some());
        // There is nothing left to receive.
        assert!(link.receive(now() + MS).unwrap().is_none());
    }
    assert_eq!(REQUESTS.get() - before, 0);
    assert_eq!(answered, 20);

    // Proves that the counter works.
    drop(std::hint::black_box(Box::new(1)));
    assert_eq!(REQUESTS.get() - before, 2);
}

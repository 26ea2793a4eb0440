//! A servo thread must not allocate. This test checks the link that it uses.

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
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

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

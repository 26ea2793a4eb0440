//! Measures the cost of timing one cycle of one finger. As in `Servo::cycle`, the clock is read, the duration of each
//! stage is noted, and the result is pushed into the ring.

use divan::{Bencher, black_box};
use sun2xp::realtime::ring;
use sun2xp::realtime::{CycleStage, CycleTiming, now};

fn main() {
    divan::main();
}

/// The goal is below 400 ns.
#[divan::bench]
fn of_a_cycle(bencher: Bencher) {
    let (mut timings, mut arriving) = ring(4096);
    let mut beginning = now();
    bencher.bench_local(|| {
        let mut timing = CycleTiming::default();
        let began = now();
        timing.note(CycleStage::WakeUp, beginning, began);
        let sent = now();
        timing.note(CycleStage::Write, began, sent);
        let ready = now();
        timing.note(CycleStage::Wire, sent, ready);
        let read = now();
        timing.note(CycleStage::Read, ready, read);
        timing.note(CycleStage::Decode, read, now());
        timing.note(CycleStage::Age, 0, black_box(1_000_000));
        let computing = now();
        let computed = now();
        timing.note(CycleStage::Compute, computing, computed);
        timing.note(CycleStage::Whole, beginning, computed);
        let left = timings.push(black_box(timing));
        beginning = computed;
        // In the library another thread collects the timings. Here they are popped at once, so that the ring does not
        // fill up.
        let _ = black_box(arriving.pop());
        left
    });
}

/// One clock reading, for comparison: a cycle has seven.
#[divan::bench]
fn of_a_clock_reading() -> u64 {
    now()
}

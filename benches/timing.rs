//! What the timing figures cost a cycle of one finger: the readings of the clock, the notes and the ring, as in `Servo::cycle`.

use divan::{Bencher, black_box};
use sun2xp::realtime::ring;
use sun2xp::realtime::{CycleTiming, Stage, now};

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
        timing.note(Stage::WakeUp, beginning, began);
        let sent = now();
        timing.note(Stage::Write, began, sent);
        let ready = now();
        timing.note(Stage::Wire, sent, ready);
        let read = now();
        timing.note(Stage::Read, ready, read);
        timing.note(Stage::Decode, read, now());
        timing.note(Stage::Age, 0, black_box(1_000_000));
        let computing = now();
        let computed = now();
        timing.note(Stage::Compute, computing, computed);
        timing.note(Stage::Whole, beginning, computed);
        let left = timings.push(black_box(timing));
        beginning = computed;
        // Somebody else collects; here it keeps the ring from filling.
        let _ = black_box(arriving.pop());
        left
    });
}

/// One reading of the clock, to compare with: a cycle has seven.
#[divan::bench]
fn of_a_clock_reading() -> u64 {
    now()
}

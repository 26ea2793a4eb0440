//! The black box of a finger that is stopped.

use crate::rig::Bench;
use sun2xp::finger::{CycleRecord, Stage};

/// Runs some periods, and collects their records often enough that none is lost.
fn run_collected(bench: &mut Bench) {
    for _ in 0..5 {
        bench.black_box.collect();
        bench.cycles(100);
    }
    bench.black_box.collect();
}

fn newest(bench: &Bench) -> CycleRecord {
    bench.black_box.record(None).expect("a record").record
}

/// A recovery over a fast line takes less time than the interval at which the records are collected.
#[test]
fn a_fast_recovery_does_not_replace_the_records_of_a_fault() {
    let mut bench = Bench::new();
    bench.black_box.wait_at_faults();
    run_collected(&mut bench);
    assert!(!bench.black_box.faulted());
    for _ in 0..2 {
        bench.mailbox.stop();
        bench.cycles(1);
        let fault = bench.report().losses.cycles;
        bench.repair();
        bench.cycles(20);
        bench.black_box.collect();
        assert!(bench.black_box.faulted());
        let kept = bench.black_box.record(None).expect("a record");
        assert!(matches!(kept.record.stage, Stage::Faulted(_)), "{:?}", kept.record.stage);
        assert!(kept.newest == fault && kept.oldest + 200 < fault, "{fault}: {} to {}", kept.oldest, kept.newest);
        let recording = bench.black_box.recording().expect("a recording");
        assert_eq!(recording.cycles.last().map(|record| record.cycle), Some(fault));

        run_collected(&mut bench);
        assert!(!bench.black_box.faulted());
        assert_eq!(newest(&bench).cycle, bench.report().losses.cycles);
    }
}

/// In the cycle of a stop the servo sends no Command, so it has no new measurement.
#[test]
fn the_cycle_of_a_stop_has_no_feedback() {
    let mut bench = Bench::new();
    run_collected(&mut bench);
    assert!(newest(&bench).feedback.is_some());
    bench.mailbox.stop();
    bench.cycles(1);
    bench.black_box.collect();
    let last = newest(&bench);
    assert!(matches!(last.stage, Stage::Faulted(_)), "{:?}", last.stage);
    assert_eq!((last.cycle, last.feedback), (bench.report().losses.cycles, None));
}

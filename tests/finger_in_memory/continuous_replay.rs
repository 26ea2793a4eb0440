//! The replay of cycles as they arrive: across keyframes, gaps, faults and recoveries.

use crate::rig::{Bench, TARGET};
use sun2xp::finger::{ContinuousReplay, CycleRecord, Fault, FaultKind, Recording, Stage, Step, Unsound};
use sun2xp::simulated::Defect;

/// Runs periods, and collects their records.
fn collect(bench: &mut Bench, cycles: usize) -> Recording {
    for _ in 0..cycles.div_ceil(100) {
        bench.cycles(100);
        bench.black_box.collect();
    }
    bench.black_box.recording().expect("a recording")
}

/// Returns the cycles of a recording. A recording has stages as texts, and the replay needs stages as values. The
/// replay uses only whether the finger was faulted, so this function gives every fault the same kind.
fn cycles(recording: &Recording) -> impl Iterator<Item = CycleRecord> {
    recording.cycles.iter().map(|record| {
        let faulted = record.stage.starts_with("faulted");
        let stage = if faulted { Stage::Faulted(Fault::new(FaultKind::EmergencyStopInput)) } else { Stage::Running };
        let CycleRecord { cycle, began, timing, feedback, status, control, .. } = *record;
        CycleRecord { cycle, began, stage, timing, feedback, status, control }
    })
}

/// A replay that has the controllers of a recording.
fn with_controllers(recording: &Recording) -> ContinuousReplay {
    let mut replay = ContinuousReplay::default();
    announce(&mut replay, recording);
    replay
}

fn announce(replay: &mut ContinuousReplay, recording: &Recording) {
    for source in &recording.origin.controllers {
        replay.controller(source.clone(), recording.origin.hand.clone()).expect("usable");
    }
}

/// A replay that has the controllers and the first state of a recording, and computes its first cycle next.
fn begun(recording: &Recording) -> ContinuousReplay {
    let mut replay = with_controllers(recording);
    assert_eq!(replay.keyframe(recording.cycles[0].cycle, recording.origin.state), Ok(true));
    replay
}

/// Two recordings of a run. The second one begins within the first one.
fn moved() -> (Bench, Recording, Recording) {
    let mut bench = Bench::new();
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    let first = collect(&mut bench, 1500);
    bench.mailbox.send(|set_point| set_point.stiffness *= 0.5).expect("not faulted");
    let second = collect(&mut bench, 1000);
    let overlap = first.cycles[0].cycle < second.cycles[0].cycle
        && second.cycles[0].cycle < first.cycles.last().expect("cycles").cycle;
    assert!(overlap, "{} {}", first.cycles[0].cycle, second.cycles[0].cycle);
    (bench, first, second)
}

#[test]
fn keyframes_have_the_state_that_the_replay_computes() {
    let (_, first, second) = moved();
    let keyframe = second.cycles[0].cycle;
    let mut replay = begun(&first);
    for record in cycles(&first).take_while(|record| record.cycle < keyframe) {
        assert_eq!(replay.cycle(&record).expect("sound").step, Step::Same, "{}", record.cycle);
    }
    // A state of another cycle is different, and the replay continues with it.
    assert_eq!(replay.keyframe(keyframe, first.origin.state), Ok(false));
    replay.keyframe(keyframe, second.origin.state).expect("sound");
    for record in cycles(&second) {
        assert_eq!(replay.cycle(&record).expect("sound").step, Step::Same, "{}", record.cycle);
    }

    let mut replay = begun(&first);
    cycles(&first).take_while(|record| record.cycle < keyframe).for_each(|record| {
        replay.cycle(&record).expect("sound");
    });
    assert_eq!(replay.keyframe(keyframe, second.origin.state), Ok(true));
}

#[test]
fn a_gap_is_reported_and_the_next_keyframe_ends_it() {
    let (_, first, second) = moved();
    let keyframe = second.cycles[0].cycle;
    let mut replay = begun(&first);
    let mut waited = 0;
    for record in cycles(&first).take_while(|record| record.cycle < keyframe) {
        let number = record.cycle - first.cycles[0].cycle;
        if (10..15).contains(&number) {
            continue;
        }
        let recomputed = replay.cycle(&record).expect("sound");
        assert_eq!(recomputed.gap.map(|gap| gap.count()), (number == 15).then_some(5));
        waited += u64::from(recomputed.step == Step::Waiting);
        assert_eq!(recomputed.step, if number < 10 { Step::Same } else { Step::Waiting });
    }
    assert_eq!(waited, keyframe - first.cycles[15].cycle);
    assert_eq!(replay.keyframe(keyframe, second.origin.state), Ok(true));
    assert!(cycles(&second).all(|record| replay.cycle(&record).expect("sound").step == Step::Same));
}

#[test]
fn a_fault_and_a_recovery_are_no_gap() {
    let (mut bench, _, second) = moved();
    let mut replay = begun(&second);
    assert!(cycles(&second).all(|record| replay.cycle(&record).is_ok()));
    bench.with_finger(|finger| finger.inject(&Defect::EmergencyStop));
    bench.faults(FaultKind::EmergencyStopInput);
    let last = collect(&mut bench, 100);
    for record in cycles(&last).filter(|record| record.cycle > second.cycles.last().expect("cycles").cycle) {
        assert!(matches!(replay.cycle(&record).expect("sound").step, Step::Same | Step::Idle));
    }
    bench.with_finger(|finger| finger.repair());
    bench.repair();
    let after = collect(&mut bench, 500);
    assert!(after.cycles[0].cycle > last.cycles.last().expect("cycles").cycle + 50, "not faulted for long");
    announce(&mut replay, &after);
    assert_eq!(replay.keyframe(after.cycles[0].cycle, after.origin.state), Ok(true));
    for record in cycles(&after) {
        let recomputed = replay.cycle(&record).expect("sound");
        assert_eq!((recomputed.gap, recomputed.step), (None, Step::Same), "{}", record.cycle);
    }
}

#[test]
fn an_altered_bit_is_found_in_its_cycle() {
    let (_, first, _) = moved();
    let mut replay = begun(&first);
    for (index, mut record) in cycles(&first).enumerate() {
        if index == 100 {
            record.feedback.as_mut().expect("a reply").gauge_counts[2] ^= 1;
        }
        let step = replay.cycle(&record).expect("sound").step;
        match index {
            0..100 => assert_eq!(step, Step::Same),
            100 => return assert!(matches!(step, Step::Different(_)), "{step:?}"),
            _ => unreachable!("cycle 100 has returned"),
        }
    }
}

#[test]
fn cycles_of_an_unknown_controller_are_left_out_and_the_next_keyframe_ends_the_gap() {
    let (_, first, second) = moved();
    let keyframe = second.cycles[0].cycle;
    let mut replay = ContinuousReplay::default();
    replay.keyframe(first.cycles[0].cycle, first.origin.state).expect("sound");
    for (index, record) in cycles(&first).take_while(|record| record.cycle < keyframe).enumerate() {
        if index == 10 {
            announce(&mut replay, &first);
        }
        let expected = if index < 10 { Step::UnknownController(0) } else { Step::Waiting };
        assert_eq!(replay.cycle(&record).expect("sound").step, expected, "{}", record.cycle);
    }
    assert_eq!(replay.keyframe(keyframe, second.origin.state), Ok(true));
    assert!(cycles(&second).all(|record| replay.cycle(&record).expect("sound").step == Step::Same));
}

#[test]
fn data_that_no_servo_records_is_refused() {
    let (_, first, _) = moved();
    let all: Vec<CycleRecord> = cycles(&first).collect();
    let number = all[0].cycle;
    let mut replay = begun(&first);
    replay.cycle(&all[0]).expect("sound");
    assert_eq!(replay.cycle(&all[0]), Err(Unsound::Order(number)));
    let mut skips = all[1];
    skips.control.as_mut().expect("control").input.skipped = u64::MAX;
    let refused = replay.cycle(&skips).expect_err("refused").to_string();
    assert!(refused.starts_with(&format!("cycle {}: control.input.skipped: is 1844", number + 1)), "{refused}");

    let mut source = first.origin.controllers[0].clone();
    source.finger.geometry.links[1] = -1.0;
    let refused = replay.controller(source, first.origin.hand.clone()).expect_err("refused").to_string();
    assert!(refused.starts_with("controller 0: geometry.links: "), "{refused}");
    let mut hand = first.origin.hand.clone();
    hand.rate = 1.0;
    let refused = replay.controller(first.origin.controllers[0].clone(), hand).expect_err("refused").to_string();
    assert!(refused.starts_with("hand.rate: "), "{refused}");
}

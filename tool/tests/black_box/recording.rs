//! The contents of a black box after a run, and their replay.

use crate::rig::{RATE, cycles, eventful, own_board, replayed, turn, wait_until};
use std::fs;
use std::path::{Path, PathBuf};
use sun2xp::board::protocol::Status;
use sun2xp::calibration::{Progress, Task};
use sun2xp::finger::Recording;
use sun2xp::hand::{Calibrating, CalibrationState, Hand};
use sun2xp::model::configuration::{Configuration, Scheme, ZeroingMethod};

/// The black box files in a folder. A file that is being written has another name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let paths = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    paths.filter(|path| path.extension().is_some_and(|extension| extension == "jsonl")).collect()
}

fn controls(recording: &Recording) -> impl Iterator<Item = &sun2xp::finger::ControlRecord> {
    recording.cycles.iter().filter_map(|cycle| cycle.control.as_ref())
}

#[test]
fn an_eventful_run_that_ends_in_a_fault_is_written_and_replayed() {
    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::StateFeedback] {
        let (board, hand) = own_board(scheme, Some(folder.path()));
        eventful(&board, &hand);
        assert!(files(folder.path()).is_empty(), "no finger has faulted");
        board.with_finger(2, |finger| finger.set_faults(Status::EMERGENCY_STOP)).expect("finger 2");
        wait_until("written", || !files(folder.path()).is_empty());
        let [file] = &files(folder.path())[..] else { panic!("one file") };

        let recording = Recording::open(file).expect("a recording");
        assert_eq!(recording.origin.finger, 2);
        assert!(recording.cycles.len() > 500, "{}", recording.cycles.len());
        let last = recording.cycles.last().expect("cycles");
        assert!(last.stage.starts_with("faulted: ") && last.control.is_none(), "{last:?}");
        assert!(Status(last.status).has(Status::EMERGENCY_STOP) && last.feedback.is_some(), "{last:?}");
        let lost = recording.cycles.iter().filter(|cycle| cycle.feedback.is_none()).count();
        assert!(lost > 10, "{lost}");
        let adjusted = controls(&recording).filter(|control| control.previous != control.controller).count();
        assert_eq!(adjusted, 3);
        assert!(controls(&recording).any(|control| control.input.anew_from.is_some()), "never restarted");
        assert!(
            controls(&recording).any(|control| control.input.fading.is_some_and(|fading| fading.left == 0.0)),
            "never faded"
        );

        let (status, reported) = replayed(file);
        assert_eq!(status, Some(0), "{reported}");
        assert!(reported.contains("every motor command the same to the last bit"), "{reported}");
        assert!(reported.contains("emergency stop") || reported.contains("status"), "{reported}");
        fs::remove_file(file).expect("removed");
    }
}

#[test]
fn two_seconds_are_kept_and_those_before_a_fault_stay() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::Figure10, None);
    cycles(&hand, (3.0 * RATE) as u64);
    let kept = |recording: &Recording| recording.cycles.len() as f64 / RATE;
    let recording = hand.recording(1).expect("a recording");
    assert!((2.0..2.2).contains(&kept(&recording)), "{} s", kept(&recording));
    board.with_finger(1, |finger| finger.set_faults(Status::EMERGENCY_STOP)).expect("finger 1");
    wait_until("faulted", || hand.position(1).is_err());
    cycles(&hand, (3.0 * RATE) as u64);
    let after = hand.recording(1).expect("a recording");
    assert!((2.0..2.2).contains(&kept(&after)), "{} s", kept(&after));
    assert!(after.cycles.last().expect("cycles").stage.starts_with("faulted: "));
    // The other fingers continue.
    let other = hand.recording(3).expect("a recording");
    assert!(other.cycles.last().expect("cycles").cycle > after.cycles.last().expect("cycles").cycle + 1000);
    assert_eq!(other.replay().expect("replayable").different, 0);
}

#[test]
fn refused_and_superseded_adjustments_are_not_kept() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::Figure10, None);
    let kept = |finger| hand.recording(finger).expect("a recording").origin.controllers.len();
    // An adjustment is refused if the set point is outside of the new limits, or if the finger is faulted.
    for _ in 0..10 {
        let error = hand.adjust(1, "joints.minimum_degrees = [30, 60, 90]").expect_err("refused");
        assert_eq!(error.errno(), libc::ERANGE, "{error}");
    }
    assert_eq!(kept(1), 1);
    board.with_finger(1, |finger| finger.set_faults(Status::EMERGENCY_STOP)).expect("finger 1");
    wait_until("faulted", || hand.position(1).is_err());
    for _ in 0..10 {
        assert_eq!(hand.adjust(1, "tendon.minimum = 6").expect_err("refused").errno(), libc::EIO);
        assert_eq!(Calibrating::begin(&hand, 1, Task::Zero).expect_err("refused").errno(), libc::EIO);
    }
    assert_eq!(kept(1), 1);
    // A finger that is being calibrated does not compute with later adjustments. A second calibration is refused.
    let mut calibrating = Calibrating::begin(&hand, 2, Task::Zero).expect("begun");
    for step in 0..20 {
        hand.adjust(2, &format!("tendon.minimum = {}", 5 + step % 2)).expect("adjusted");
        assert_eq!(Calibrating::begin(&hand, 2, Task::Zero).expect_err("refused").errno(), libc::EBUSY);
        cycles(&hand, 5);
    }
    // At most these controllers are kept: the one before the order to calibrate, the one that the servo took in the
    // same cycle as this order, the one with which the calibration computes, the newest one, and the one that the
    // newest one replaced.
    assert!(kept(2) <= 5, "{}", kept(2));
    wait_until("calibrated", || matches!(calibrating.poll(&hand), Ok(CalibrationState::Done(_))));
    hand.send_position(2, [0.1, 0.5, 1.0]).expect("sent");
    cycles(&hand, 50);
    assert_eq!(hand.recording(2).expect("a recording").replay().expect("replayable").different, 0);
}

#[test]
fn opening_calibrating_and_closing_are_replayed() {
    let _turn = turn();
    let mut configuration = Configuration::default();
    configuration.hand.rate = RATE;
    configuration.fingers[0].gauge.zero = [200.0; 4];
    configuration.hand.gravity = [0.0, 0.0, -0.1];
    configuration.fingers[0].zeroing.method = Some(ZeroingMethod::Pose);
    configuration.fingers[0].zeroing.pose_degrees = [0.0, 30.0, 60.0];
    let hand = Hand::open(configuration).expect("the simulated hand");
    let opened = hand.recording(1).expect("a recording");
    assert_eq!(opened.cycles[0].stage, "opening");
    let mut calibrating = None;
    let half_way = |progress: Progress| {
        if progress.part > 0.5 && calibrating.is_none() {
            calibrating = Some(hand.recording(1).expect("a recording"));
        }
    };
    hand.zero(1, half_way).expect("zeroed");
    let calibrating = calibrating.expect("taken half way");
    assert!(calibrating.cycles.iter().any(|cycle| cycle.stage == "calibrating"));
    let calibrated = hand.recording(1).expect("a recording");
    let adopted = calibrated.origin.controllers.last().expect("a controller");
    // Controller 0 opened the finger, and the calibration computed with controller 1, so the new values are in
    // controller 2.
    assert!(adopted.number == 2 && adopted.gravity.norm() > 0.0, "{adopted:?}");
    for recording in [&opened, &calibrating, &calibrated] {
        let replayed = recording.replay().expect("replayable");
        assert_eq!((replayed.different, replayed.first), (0, None));
        assert!(replayed.cycles > 10);
    }
}

//! The black box: what is recorded while a hand runs is computed again to the last bit, and a changed bit is found.

#[allow(dead_code)]
#[path = "../../tests/common/pauses.rs"]
mod pauses;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::calibration::{Progress, Task};
use sun2xp::finger::{CycleRecord, Recording, RecordingError};
use sun2xp::hand::{Calibrating, Hand, Standing};
use sun2xp::model::configuration::{Configuration, Scheme, ZeroingMethod};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

const RATE: f64 = 500.0;

/// A hand whose fingers are on one board in this process, so that things can happen to it.
fn own_board(scheme: Scheme, folder: Option<&Path>) -> (SimulatedPort, Hand) {
    let board = SimulatedBoard::new(&Configuration::default(), &[0, 1, 2]).expect("a board");
    let port = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None })
        .expect("a pseudo-terminal");
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.watchdog_ms) = (RATE, 1000);
    configuration.hand.black_box = folder.map(|folder| folder.to_string_lossy().into_owned());
    for finger in &mut configuration.fingers {
        finger.port = port.path().to_string_lossy().into_owned();
        (finger.baud, finger.thread, finger.controller.scheme) = (2_000_000, 1, Some(scheme));
    }
    let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"));
    (port, hand)
}

/// One hand at a time: its servos and boards want the machine.
fn turn() -> MutexGuard<'static, ()> {
    pauses::name_pauses();
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

fn wait_until(what: &str, mut wanted: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !wanted() {
        assert!(begun.elapsed() < Duration::from_secs(20), "not {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Lets a number of cycles pass.
fn cycles(hand: &Hand, count: u64) {
    let now = || hand.report(2).expect("a report").losses.cycles;
    let end = now() + count;
    wait_until("so many cycles", || now() >= end);
}

/// Set points, stiffnesses, adjustments, replies lost for a moment and for long.
fn eventful(board: &SimulatedPort, hand: &Hand) {
    for (step, angle) in [0.9, 1.2, 1.0].into_iter().enumerate() {
        hand.send_position(2, [0.1, 0.5, angle]).expect("sent");
        cycles(hand, 60);
        hand.send_stiffness(2, [[2.0, 0.0, 0.0], [0.0, 3.0 - 0.5 * step as f64, 0.0], [0.0, 0.0, 1.5]]).expect("sent");
        hand.adjust(2, &format!("tendon.minimum = {}", 5 + step % 2)).expect("adjusted");
        cycles(hand, 60);
    }
    // The board says nothing for so long; the second time the servo lets the motors go, and begins anew.
    for silence in [3.0, 30.0] {
        board.with_board(|_| std::thread::sleep(Duration::from_secs_f64(silence / RATE)));
        cycles(hand, 40);
    }
}

fn replayed(file: &Path) -> (Option<i32>, String) {
    let run = Command::new(env!("CARGO_BIN_EXE_sun2xp")).arg("replay").arg(file).output().expect("the tool runs");
    let Output { status, stdout, stderr } = run;
    (status.code(), [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat())
}

/// The black boxes in a folder. While one is written it has another name.
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
        assert!(controls(&recording).any(|control| control.input.anew_from.is_some()), "never begun anew");
        assert!(
            controls(&recording).any(|control| control.input.fading.is_some_and(|fading| fading.left == 0.0)),
            "never at rest"
        );

        let (status, told) = replayed(file);
        assert_eq!(status, Some(0), "{told}");
        assert!(told.contains("every motor command the same to the last bit"), "{told}");
        assert!(told.contains("emergency stop") || told.contains("status"), "{told}");
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
    // The others go on.
    let other = hand.recording(3).expect("a recording");
    assert!(other.cycles.last().expect("cycles").cycle > after.cycles.last().expect("cycles").cycle + 1000);
    assert_eq!(other.replay().expect("replayable").different, 0);
}

#[test]
fn of_adjustments_that_are_refused_or_overtaken_nothing_is_kept() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::Figure10, None);
    let kept = |finger| hand.recording(finger).expect("a recording").origin.controllers.len();
    // Outside of what was sent; and on a finger that has faulted.
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
    // One that is being calibrated takes none of them that comes after the order; and a second calibration is refused.
    let mut calibrating = Calibrating::begin(&hand, 2, Task::Zero).expect("begun");
    for step in 0..20 {
        hand.adjust(2, &format!("tendon.minimum = {}", 5 + step % 2)).expect("adjusted");
        assert_eq!(Calibrating::begin(&hand, 2, Task::Zero).expect_err("refused").errno(), libc::EBUSY);
        cycles(&hand, 5);
    }
    // Before it, with the order, its own that has not taken over yet, the newest and the one it overtook.
    assert!(kept(2) <= 5, "{}", kept(2));
    wait_until("calibrated", || matches!(calibrating.poll(&hand), Ok(Standing::Done(_))));
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
    // 0 opened the finger, 1 is what calibration computes with.
    assert!(adopted.number == 2 && adopted.gravity.norm() > 0.0, "{adopted:?}");
    for recording in [&opened, &calibrating, &calibrated] {
        let replayed = recording.replay().expect("replayable");
        assert_eq!((replayed.different, replayed.first), (0, None));
        assert!(replayed.cycles > 10);
    }
}

#[test]
fn one_bit_of_feedback_is_found_where_it_was_changed() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::StateFeedback, None);
    eventful(&board, &hand);
    let recording = hand.recording(2).expect("a recording");
    assert_eq!(recording.replay().expect("replayable").different, 0);
    let place = recording.cycles.iter().rposition(|cycle| cycle.feedback.is_some()).expect("a reply") - 100;
    let place = (place..).find(|&place| recording.cycles[place].feedback.is_some()).expect("a reply");
    for motor in 0..4 {
        for encoder in [true, false] {
            let mut altered = recording.clone();
            let feedback = altered.cycles[place].feedback.as_mut().expect("a reply");
            match encoder {
                true => feedback.motor_counts[motor] ^= 1,
                false => feedback.gauge_counts[motor] ^= 1,
            }
            let first = altered.replay().expect("replayable").first.expect("found");
            assert_eq!(first.index, place, "motor {motor}, encoder {encoder}");
            assert_ne!(first.recorded.command, first.replayed.command, "motor {motor}, encoder {encoder}");
        }
    }

    // The same through a file and the tool.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-2.jsonl");
    let mut altered = recording.clone();
    altered.cycles[place].feedback.as_mut().expect("a reply").gauge_counts[3] ^= 1;
    altered.save(&file).expect("written");
    let (status, told) = replayed(&file);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains(&format!("cycle {}, line {}", recording.cycles[place].cycle, place + 2)), "{told}");
}

#[test]
fn a_file_comes_back_as_it_was_and_a_damaged_one_is_refused_with_its_reason() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::StateFeedback, None);
    eventful(&board, &hand);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-2.jsonl");
    hand.write_black_box(2, &file).expect("written");
    let recording = Recording::open(&file).expect("read");
    let again = folder.path().join("again.jsonl");
    recording.save(&again).expect("written");
    let text = fs::read_to_string(&file).expect("text");
    let cycles = |text: &str| text.split_once('\n').expect("a header").1.to_string();
    assert_eq!(cycles(&text), cycles(&fs::read_to_string(&again).expect("text")));

    let refusal = |text: &str| {
        fs::write(&file, text).expect("written");
        Recording::open(&file).expect_err("refused")
    };
    let whole: Vec<&str> = text.lines().collect();
    let short = whole[..whole.len() - 1].join("\n");
    assert!(matches!(refusal(&short), RecordingError::Short { .. }));
    let gap = [&whole[..4], &whole[5..]].concat().join("\n");
    assert!(matches!(refusal(&gap), RecordingError::Line { line: 5, .. }));
    let newer = text.replacen("\"sun2xp_black_box\":1", "\"sun2xp_black_box\":2", 1);
    assert!(matches!(refusal(&newer), RecordingError::Version { found: 2, .. }));
    assert!(matches!(refusal("{}\n"), RecordingError::Foreign(..)));
    assert!(matches!(refusal(""), RecordingError::Foreign(..)));
    let (status, told) = replayed(&file);
    assert!(status == Some(1) && told.contains("not a black box"), "{told}");
    assert_eq!(replayed(&folder.path().join("none")).0, Some(1));

    let refused = hand.write_black_box(2, &folder.path().join("none/file")).expect_err("no such folder");
    assert_eq!(refused.errno(), libc::ENOENT, "{refused}");
    let refused = hand.write_black_box(2, Path::new("/dev/null")).expect_err("no regular file");
    assert_eq!(refused.errno(), libc::EINVAL, "{refused}");
    assert_eq!(hand.write_black_box(4, &file).expect_err("no such finger").errno(), libc::EINVAL);
}

#[test]
fn a_folder_that_is_not_there_is_refused_when_the_hand_is_opened() {
    let mut configuration = Configuration::default();
    configuration.hand.black_box = Some("/no/such/folder".into());
    let error = Hand::open(configuration).err().expect("refused");
    assert_eq!(error.errno(), libc::EINVAL);
    assert!(error.to_string().contains("hand.black_box: /no/such/folder is no folder"), "{error}");
}

/// One cycle without a finger, to see that nothing of it is lost in a file.
#[test]
fn numbers_come_back_to_the_last_bit() {
    let third = |sign: f64| sign / 3.0;
    let mut record: CycleRecord<String> = serde_json::from_str(
        r#"{"cycle":1,"began":18446744073709551615,"stage":"running","timing":[1,null,4294967295,0,0,0,0,0],
            "feedback":{"motor_counts":[-2147483648,2147483647,0,-1],"gauge_counts":[0,65535,1,2]},"status":65535,"control":null}"#,
    )
    .expect("a record");
    record.began -= 1;
    let text = serde_json::to_string(&record).expect("text");
    assert_eq!(serde_json::from_str::<CycleRecord<String>>(&text).expect("a record"), record);
    for number in [third(1.0), third(-1e-300), f64::MIN_POSITIVE, -0.0, f64::MAX, 5e-324, 0.1 + 0.2] {
        let text = serde_json::to_string(&number).expect("text");
        assert_eq!(serde_json::from_str::<f64>(&text).expect("a number").to_bits(), number.to_bits(), "{text}");
    }
}

//! `sun2xp record`: what the recording contains, also after the tool was interrupted or killed, and what other programs
//! read from it.

#[allow(dead_code)]
#[path = "../common/terminal.rs"]
mod terminal;

#[allow(dead_code)]
#[path = "../../../tests/common/tools.rs"]
mod tools;

mod contents;
mod conversion;

use contents::{Contents, contents};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, ConfiguredObject};

fn name(test: &str) -> String {
    format!("record-{}-{test}", std::process::id())
}

fn open(name: &str) -> Hand {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = name.into();
    configuration.hand.simulated_object = Some(ConfiguredObject::default());
    Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"))
}

fn record(name: &str, folder: &Path, options: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    command.args(["record", "--hand", name]).args(options).current_dir(folder);
    command
}

/// Ends a recorder as Ctrl-C does. Returns what it has printed and its exit status.
fn interrupt(recorder: Child) -> (String, String, Option<i32>) {
    // SAFETY: the call takes numbers only. The process has not been waited for, so its number is still its own.
    assert_eq!(unsafe { libc::kill(recorder.id() as i32, libc::SIGINT) }, 0);
    let run = recorder.wait_with_output().expect("it ends");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
    (text(run.stdout), text(run.stderr), run.status.code())
}

fn start(mut command: Command) -> Child {
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the tool runs")
}

/// Waits until a file has at least this size.
fn wait_for(path: &Path, bytes: u64) {
    let limit = Instant::now() + Duration::from_secs(20);
    while fs::metadata(path).map_or(0, |metadata| metadata.len()) < bytes {
        assert!(Instant::now() < limit, "{} does not grow", path.display());
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Checks that every cycle of every finger is in the recording, or is marked as lost.
fn assert_complete(contents: &Contents) {
    for finger in 0..3 {
        let (cycles, lost) = (&contents.cycles[finger], contents.lost[finger]);
        let (first, last) = (cycles[0], *cycles.last().expect("cycles"));
        assert!(cycles.is_sorted());
        assert_eq!(cycles.len() as u64 + lost, last - first + 1, "finger {}: {lost} lost", finger + 1);
        assert_eq!(contents.replayed[finger], cycles.len(), "finger {}", finger + 1);
    }
}

#[test]
fn an_interrupted_recorder_leaves_a_complete_file() {
    let (name, folder) = (name("interrupted"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let file = folder.path().join("hand.mcap");
    let recorder = start(record(&name, folder.path(), &["-o", "hand.mcap"]));
    wait_for(&file, 200_000);
    let (said, progress, status) = interrupt(recorder);
    assert_eq!(status, Some(0), "{said}{progress}");
    assert!(said.starts_with("hand.mcap, ") && said.contains(" cycles, ") && said.contains(" 0 cycles lost"), "{said}");
    assert!(progress.contains("recording into hand.mcap"), "{progress}");
    let contents = contents(&fs::read(&file).expect("the file"));
    assert!(contents.finished);
    assert_complete(&contents);
    for topic in ["/description", "/object", "/status", "/finger2/cycle", "/finger3/replay"] {
        assert!(contents.topics.contains_key(topic), "{topic} is missing: {:?}", contents.topics);
    }
    drop(hand);
}

#[test]
fn the_poses_of_the_object_become_a_table() {
    let (name, folder) = (name("object"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let recorder = start(record(&name, folder.path(), &["-o", "hand.mcap"]));
    wait_for(&folder.path().join("hand.mcap"), 200_000);
    let object = hand.object().expect("an object");
    interrupt(recorder);
    drop(hand);
    let mut export = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = export.args(["export", "hand.mcap"]).current_dir(folder.path()).output().expect("the tool runs");
    assert!(run.status.success() && String::from_utf8_lossy(&run.stdout).contains("hand-object.csv"), "{run:?}");
    let table = fs::read_to_string(folder.path().join("hand-object.csv")).expect("a table");
    let (header, rows) = table.split_once('\n').expect("a header");
    let names: Vec<&str> = header.split(',').collect();
    assert_eq!(names[..3], ["time_s", "simulated_time_s", "position_x_cm"]);
    assert_eq!(names.len(), 2 + 3 + 9 + 3 + 3 + 3 * 3, "{header}");
    let rows: Vec<Vec<f64>> =
        rows.lines().map(|row| row.split(',').map(|field| field.parse().expect("a number")).collect()).collect();
    assert!(rows.len() > 5 && rows.iter().all(|row| row.len() == names.len()), "{table}");
    // Neither of the two clocks runs backwards, and the object rests where the hand reports it.
    assert!(rows.is_sorted_by(|one, next| one[0] <= next[0] && one[1] <= next[1]), "{table}");
    let last = rows.last().expect("a row");
    assert!((0..3).all(|axis| (last[2 + axis] - object.position[axis]).abs() < 0.01), "{last:?} {object:?}");
}

#[test]
fn a_closed_hand_ends_the_recording() {
    let (name, folder) = (name("closed"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let recorder = start(record(&name, folder.path(), &["-o", "hand.mcap", "--seconds", "100"]));
    wait_for(&folder.path().join("hand.mcap"), 200_000);
    drop(hand);
    let run = recorder.wait_with_output().expect("it ends");
    assert!(run.status.success(), "{run:?}");
    assert!(String::from_utf8_lossy(&run.stdout).contains("(the hand was closed)"), "{run:?}");
    assert_complete(&contents(&fs::read(folder.path().join("hand.mcap")).expect("the file")));
}

#[test]
fn a_killed_recorder_loses_less_than_a_second() {
    let (name, folder) = (name("killed"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let file = folder.path().join("hand.mcap");
    let mut recorder = start(record(&name, folder.path(), &["-o", "hand.mcap"]));
    wait_for(&file, 1_000_000);
    // A chunk is written about every 0.5 s. The recorder has collected a part of the next chunk when it is killed.
    std::thread::sleep(Duration::from_millis(230));
    let newest: Vec<u64> = (1..=3).map(|finger| hand.report(finger).expect("report").losses.cycles).collect();
    recorder.kill().expect("killed");
    recorder.wait().expect("ended");
    let contents = contents(&fs::read(&file).expect("the file"));
    assert!(!contents.finished);
    assert_complete(&contents);
    for (newest, cycles) in newest.iter().zip(&contents.cycles) {
        let last = cycles.last().expect("cycles");
        assert!(newest.saturating_sub(*last) < 1000, "the last {} cycles are lost", newest - last);
    }
    drop(hand);
}

#[test]
fn files_rotate_and_the_oldest_are_deleted() {
    let (name, folder) = (name("rotated"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let options = ["-o", "hand.mcap", "--max-age", "0.6", "--keep", "2", "--seconds", "3.1"];
    let run = record(&name, folder.path(), &options).output().expect("the tool runs");
    drop(hand);
    assert!(run.status.success(), "{run:?}");
    let mut files: Vec<_> =
        fs::read_dir(folder.path()).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    assert_eq!(files.len(), 2, "{files:?} {run:?}");
    let mut both: Vec<Contents> = files.iter().map(|file| contents(&fs::read(file).expect("the file"))).collect();
    both.sort_by_key(|contents| contents.cycles[0][0]);
    for contents in &both {
        assert!(contents.finished && contents.first_topic == "/description");
        assert_complete(contents);
    }
    for finger in 0..3 {
        assert_eq!(both[0].cycles[finger].last().expect("cycles") + 1, both[1].cycles[finger][0], "no cycle between");
    }
}

#[test]
fn wrong_usage_and_missing_hands_are_explained() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |options: &[&str]| {
        let run = record("no-such-hand", folder.path(), options).output().expect("the tool runs");
        (String::from_utf8_lossy(&run.stderr).into_owned(), run.status.code())
    };
    let (said, status) = run(&[]);
    assert!(status == Some(1) && said.contains("no hand of this user has the name \"no-such-hand\""), "{said}");
    for options in [["--seconds", "-1"], ["--max-size", "0"], ["--max-age", "soon"], ["--keep", "2"]] {
        let (said, status) = run(&options);
        assert_eq!(status, Some(2), "{options:?}: {said}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0, "nothing was created");
}

#[test]
fn an_existing_file_is_not_overwritten() {
    let (name, folder) = (name("existing"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    fs::write(folder.path().join("kept.mcap"), "kept").expect("written");
    let run = record(&name, folder.path(), &["-o", "kept.mcap", "--seconds", "1"]).output().expect("the tool runs");
    drop(hand);
    let said = String::from_utf8_lossy(&run.stderr);
    assert!(run.status.code() == Some(1) && said.contains("cannot create kept.mcap"), "{said}");
    assert_eq!(fs::read_to_string(folder.path().join("kept.mcap")).expect("the file"), "kept");
}

#[test]
fn python_reads_the_same_samples() {
    let Some(python) = tools::python("the MCAP reader for Python") else { return };
    let (name, folder) = (name("python"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    let run = record(&name, folder.path(), &["-o", "hand.mcap", "--seconds", "1.5"]).output().expect("the tool runs");
    drop(hand);
    assert!(run.status.success(), "{run:?}");
    let file = folder.path().join("hand.mcap");
    let mut program = Command::new(python);
    let run = program.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/record/read.py")).arg(&file).output();
    let run = run.expect("Python starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let read: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let contents = contents(&fs::read(&file).expect("the file"));
    assert_eq!(read["cycles"], serde_json::json!(contents.cycles.each_ref().map(Vec::len)));
    assert_eq!(read["description"]["name"], name.as_str());
    // Python has decoded the last cycle of finger 1 from the topic `/finger1/cycle`. Its values, except `fault` and
    // `reserved`, must be those that `contents` computes from `/finger1/replay`.
    let last = contents.last[0].as_ref().expect("a sample");
    let sample = serde_json::to_value(last).expect("numbers");
    let fields = read["last"].as_object().expect("a message");
    for (field, value) in fields {
        let expected = match field.as_str() {
            "fault" | "reserved" => continue,
            "stage" => serde_json::json!(last.stage_name()),
            "kx" | "stiffness" | "stiffness_in_palm" => {
                let rows = sample[field].as_array().expect("rows").iter();
                rows.flat_map(|row| row.as_array().expect("a row").clone()).collect()
            }
            name => sample[name].clone(),
        };
        assert_eq!(*value, expected, "{field}");
    }
    assert!(fields.len() > 25, "{fields:?}");
}

/// Ten minutes of three fingers at 1000 Hz, with a planner that moves them. The test takes so long that it runs only on
/// request.
#[test]
#[ignore = "takes ten minutes"]
fn ten_minutes_are_recorded_with_every_cycle() {
    let (name, folder) = (name("long"), tempfile::tempdir().expect("a folder"));
    let hand = open(&name);
    let recorder = start(record(&name, folder.path(), &["-o", "hand.mcap", "--seconds", "600"]));
    let end = Instant::now() + Duration::from_secs(600);
    let mut phase = 0.0_f64;
    while Instant::now() < end {
        phase += 0.1;
        for finger in 1..=3 {
            let joints = [0.1 * phase.sin(), 0.6 + 0.2 * phase.cos(), 0.9 + 0.2 * (0.7 * phase).sin()];
            hand.send_position(finger, joints).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let run = recorder.wait_with_output().expect("it ends");
    println!("{}{}", String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    let losses: Vec<_> = (1..=3).map(|finger| hand.losses(finger).expect("losses")).collect();
    drop(hand);
    let contents = contents(&fs::read(folder.path().join("hand.mcap")).expect("the file"));
    println!("cycles {:?}, lost {:?}", contents.cycles.each_ref().map(Vec::len), contents.lost);
    println!("{losses:?}");
    assert!(contents.finished);
    assert_complete(&contents);
}

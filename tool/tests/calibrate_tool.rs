//! `sun2xp calibrate`, started by a person and by a script.

#[path = "common/board_at_port.rs"]
mod board_at_port;

use board_at_port::Board;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A configuration file in a temporary folder.
struct Desk {
    folder: TempDir,
    text: String,
}

impl Desk {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("hand.toml"), text).expect("written");
        Self { folder, text: text.into() }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("hand.toml")
    }

    fn unchanged(&self) -> bool {
        fs::read_to_string(self.file()).expect("there") == self.text
    }

    /// Runs the tool with `input` on standard input.
    fn calibrate(&self, arguments: &[&str], input: &str) -> Output {
        let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        tool.args(["calibrate", "--config"]).arg(self.file()).args(arguments);
        tool.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut tool = tool.spawn().expect("the tool runs");
        // The tool may end before it reads.
        let _ = tool.stdin.take().expect("a pipe").write_all(input.as_bytes());
        tool.wait_with_output().expect("the tool ends")
    }
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn the_file_of_a_hand_on_another_machine_is_refused_and_stays() {
    let desk = Desk::new("[remote]\nendpoint = \"tcp/127.0.0.1:9\"\nhand = \"left\"\n");
    let output = desk.calibrate(&["--finger", "1", "--yes"], "");
    assert!(!output.status.success() && said(&output).contains("has a table [remote]"), "{}", said(&output));
    assert!(desk.unchanged());
}

fn contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}

/// The ports of the other fingers do not exist.
#[test]
fn a_person_is_asked_to_hold_one_finger_in_its_pose() {
    let links = tempfile::tempdir().expect("a folder");
    let link = links.path().join("board");
    let _board = Board::start(1, &link);
    let desk = Desk::new(&format!(
        "[hand]\nrate = 500\n[finger.1]\nport = \"{}\"\n[finger.1.zeroing]\npose_degrees = [0.0, -10.0, 60.0]\n\
         [finger.2]\nport = \"/dev/sun2xp-none-2\"\n[finger.3]\nport = \"/dev/sun2xp-none-3\"\n",
        link.display()
    ));
    let output = desk.calibrate(&["--finger", "1", "--zero"], "");
    assert_eq!(output.status.code(), Some(1));
    contains(
        &said(&output),
        &[
            "finger 1 is zeroed at a pose, because zeroing.lower_stop_degrees and zeroing.upper_stop_degrees are \
             not both set",
            "0.0 degrees, straight ahead",
            "-10.0 degrees, bent back",
            "60.0 degrees, bent inward",
            "Press Enter when you hold it there",
            "standard input ended before Enter was pressed",
            "--yes",
        ],
    );
    assert!(desk.unchanged());
}

/// A built-in simulated finger is in its pose, but nothing holds it there.
#[test]
fn a_finger_that_nobody_holds_is_refused_with_what_to_do() {
    let desk = Desk::new("[hand]\nrate = 500\n[finger]\nport = \"simulated\"\n[finger.zeroing]\nmethod = \"pose\"\n");
    for (arguments, input) in [(["--yes"].as_slice(), ""), (&[], "\n")] {
        let arguments = [&["--finger", "2", "--finger", "3", "--zero", "--identify"], arguments].concat();
        let output = desk.calibrate(&arguments, input);
        assert_eq!(output.status.code(), Some(1));
        contains(
            &said(&output),
            &[
                "finger 2 is zeroed at a pose, because zeroing.method is \"pose\"",
                "finger 2, zeroing:",
                "the calibration of finger 2 failed (its motors are off, and its previous calibration is in force): \
                 nothing holds the finger in its pose",
                "--finger 2 --zero --identify; then for the remaining fingers:",
                "--finger 3 --zero --identify\n",
            ],
        );
        assert!(!said(&output).contains("\\n"), "{}", said(&output));
        assert_eq!(said(&output).contains("Press Enter"), !input.is_empty());
        // The command with which to continue has the option --yes if this run had it.
        assert_eq!(said(&output).contains(" --yes --finger 2 --zero"), input.is_empty(), "{}", said(&output));
        assert!(desk.unchanged());
    }
}

/// The tool prints a command with which to continue. This command does not search for the signs again, so the file must
/// contain them.
#[test]
fn signs_are_stored_before_a_zero_that_is_refused() {
    let links = tempfile::tempdir().expect("a folder");
    let link = links.path().join("board");
    let _board = Board::start(1, &link);
    let desk = Desk::new(&format!(
        "[hand]\nrate = 500\n[finger.1]\nport = \"{}\"\n[finger.1.encoder]\nsign = [-1, 1, 1, 1]\n\
         [finger.1.zeroing]\npose_degrees = [0.0, -10.0, 60.0]\n\
         [finger.2]\nport = \"simulated\"\n[finger.3]\nport = \"simulated\"\n",
        link.display()
    ));
    let output = desk.calibrate(&["--finger", "1"], "");
    assert_eq!(output.status.code(), Some(1));
    contains(&said(&output), &["standard input ended before Enter was pressed"]);
    let stored = fs::read_to_string(desk.file()).expect("there");
    contains(&stored, &["[finger.1.encoder]\nsign = [1, 1, 1, 1]"]);
}

#[test]
fn a_finger_whose_stops_are_known_is_zeroed_against_them() {
    let desk = Desk::new(
        "[hand]\nrate = 500\n[finger]\nport = \"simulated\"\n[finger.gauge]\nzero = [204.0, 204.0, 204.0, 204.0]\n\
         [finger.zeroing]\nspeed = 3.0\nlower_stop_degrees = [-63.0, -33.0, 2.0]\n\
         upper_stop_degrees = [63.0, 103.0, 123.0]\n",
    );
    let output = desk.calibrate(&["--finger", "1", "--zero"], "");
    assert!(output.status.success(), "{}", said(&output));
    let text = said(&output);
    contains(&text, &["finger 1, zeroing:", "moving the joints against their stops"]);
    assert!(!text.contains("Press Enter"), "{text}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("measured minus configured range"), "{output:?}");
    assert!(!desk.unchanged());

    // With --json, other programs receive one JSON object. With --dry-run, the file does not change.
    let stored = fs::read_to_string(desk.file()).expect("there");
    let output = desk.calibrate(&["--finger", "1", "--zero", "--json", "--dry-run"], "");
    assert_eq!(fs::read_to_string(desk.file()).expect("there"), stored);
    let reported: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"));
    assert_eq!((&reported["written"], reported["fingers"].as_array().map(Vec::len)), (&Value::Null, Some(1)));
    let finger = &reported["fingers"][0];
    let error = &finger["measured"][0];
    assert_eq!(error["name"], "joint angle errors before zeroing, degrees");
    let degrees = |of: &Value| of.as_f64().is_some_and(|degrees| degrees.abs() < 1.0);
    assert!(
        error["values"].as_array().is_some_and(|joints| joints.len() == 3 && joints.iter().all(degrees)),
        "{reported:#}"
    );
    let value = |key: &str| finger["values"].as_array().and_then(|all| all.iter().find(|value| value["key"] == key));
    let zero = value("encoder.zero").expect("a value");
    assert!(zero["found"].as_array().is_some_and(|zeros| zeros.len() == 4), "{zero:#}");
    let signs = value("motor.sign").expect("a value");
    assert_eq!((&signs["configured"], &signs["unit"]), (&signs["found"], &Value::from("")));
}

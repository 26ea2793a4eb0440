//! Tests of `sun2xp commission` and `sun2xp health`, started as by a script: files, refusals and last messages.

#[path = "common/board_at_port.rs"]
mod board_at_port;

use board_at_port::Board;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// A folder with a configuration file.
struct Desk(TempDir);

impl Desk {
    fn new(text: &str) -> Self {
        let desk = Self(tempfile::tempdir().expect("a folder"));
        fs::write(desk.file(), text).expect("written");
        desk
    }

    fn file(&self) -> PathBuf {
        self.0.path().join("hand.toml")
    }

    fn commission(&self, arguments: &[&str]) -> Output {
        let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        tool.args(["commission", "--yes", "--config"]).arg(self.file()).args(arguments);
        tool.stdin(Stdio::null()).output().expect("the tool runs")
    }
}

fn contains(text: &[u8], parts: &[&str]) {
    let text = String::from_utf8_lossy(text);
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}

const SIMULATED: &str = "[hand]\nfingers = [1]\n[finger.1]\nport = \"simulated\"\n";

#[test]
fn after_one_step_the_steps_left_are_listed() {
    let desk = Desk::new(SIMULATED);
    let output = desk.commission(&["--step", "board"]);
    assert!(output.status.success(), "{output:?}");
    let left = "not commissioned yet. Steps left: computer, encoders, gauges, motors, zeros, tendons, bound, spring. ";
    contains(&output.stdout, &["Step 1 of 9: board", left, "To continue: sun2xp commission --config"]);
    assert!(!String::from_utf8_lossy(&output.stdout).contains("is commissioned."), "{output:?}");
}

#[test]
fn a_failure_is_one_line_with_the_command_to_continue() {
    let desk = Desk::new("[hand]\nfingers = [1]\n[finger.1]\nport = \"/dev/sun2xp-none\"\n");
    let output = desk.commission(&["--step", "board"]);
    assert_eq!(output.status.code(), Some(1));
    contains(&output.stderr, &["sun2xp-none", ". The motors are off. To continue: sun2xp commission --config"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(!text.contains("\\n") && text.lines().count() == 1, "{text}");
}

#[test]
fn the_command_to_continue_keeps_the_weights() {
    let desk = Desk::new(SIMULATED);
    let output = desk.commission(&["--step", "board", "--weights", "0.2,0.45"]);
    assert!(output.status.success(), "{output:?}");
    contains(&output.stdout, &[" --finger 1 --weights 0.2,0.45\n"]);
    let output = desk.commission(&["--step", "board"]);
    assert!(!String::from_utf8_lossy(&output.stdout).contains("--weights"), "{output:?}");
}

#[test]
fn an_open_fault_blocks_the_steps_that_move_the_finger() {
    let desk = Desk::new(SIMULATED);
    let motors = r#""motors": { "when": "today", "found": ["motors 1 and 2 are swapped. Swap their cables"] }"#;
    let journal = format!(r#"{{ "fingers": {{ "1": {{ "failed": {{ {motors} }} }} }} }}"#);
    fs::write(desk.0.path().join("hand.commission.json"), journal).expect("written");
    let output = desk.commission(&["--step", "zeros"]);
    assert_eq!(output.status.code(), Some(1));
    contains(&output.stdout, &["failed motors, today: motors 1 and 2 are swapped"]);
    contains(
        &output.stderr,
        &["the step \"motors\" failed on today: motors 1 and 2 are swapped. Swap their cables. Remove"],
    );
}

/// The fault was found after the finger was commissioned.
#[test]
fn health_does_not_move_a_finger_with_an_open_fault() {
    let desk = Desk::new(SIMULATED);
    let health = |failed: &str, steps: &str| {
        let vitals = r#"{ "tendon_stiffness": [300.0, 300.0, 300.0, 300.0] }"#;
        let finger = format!(r#"{{ "steps": {{ {steps} }}, "failed": {{ {failed} }}, "vitals": {vitals} }}"#);
        let journal = format!(r#"{{ "fingers": {{ "1": {finger} }} }}"#);
        fs::write(desk.0.path().join("hand.commission.json"), journal).expect("written");
        let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
        let output = tool.args(["health", "--yes", "--config"]).arg(desk.file()).output().expect("the tool runs");
        assert_eq!(output.status.code(), Some(1));
        output.stderr
    };
    let motors = r#""motors": { "when": "today", "found": ["tendons 1 and 2 are swapped"] }"#;
    let both = r#""zeros": { "when": "", "found": [] }, "tendons": { "when": "", "found": [] }"#;
    contains(&health(motors, both), &["the step \"motors\" failed on today: tendons 1 and 2 are swapped"]);
    contains(
        &health("", ""),
        &["the step \"zeros\" or \"tendons\" of finger 1 does not count as passed", "sun2xp commission --config"],
    );
}

/// The tool creates the file with one finger, and then adds a second finger. It finds the board of each finger.
#[test]
fn a_finger_that_the_file_does_not_have_is_added_with_its_board() {
    let desk = Desk(tempfile::tempdir().expect("a folder"));
    let ports = desk.0.path().join("board*").to_string_lossy().into_owned();
    let _boards = [1, 2].map(|finger| Board::start(finger, &desk.0.path().join(format!("board{finger}"))));
    for finger in ["1", "2"] {
        let output = desk.commission(&["--finger", finger, "--port", &ports, "--step", "board"]);
        assert!(output.status.success(), "{output:?}");
        let reasons = ["its address is the number of the finger", "the others that answer belong to other fingers"];
        contains(&output.stdout, &["Took the board ", reasons[usize::from(finger == "2")], "board 73"]);
        let text = fs::read_to_string(desk.file()).expect("a file");
        assert!(text.contains(&format!("[finger.{finger}]\nboard = \"")), "{text}");
    }
    let text = fs::read_to_string(desk.file()).expect("a file");
    assert!(text.contains("fingers = [1, 2]") && text.starts_with("# Created by sun2xp commission."), "{text}");
    let output = desk.commission(&["--finger", "3", "--step", "board"]);
    assert_eq!(output.status.code(), Some(2));
    contains(&output.stderr, &["has no finger 3, and only boards of other fingers answer"]);
    assert_eq!(fs::read_to_string(desk.file()).expect("a file"), text);
}

/// The configuration file was deleted, and the notes beside it were not. They say that every step has passed.
#[test]
fn a_new_finger_does_not_inherit_the_notes_about_an_earlier_one() {
    let desk = Desk(tempfile::tempdir().expect("a folder"));
    let ports = desk.0.path().join("board*").to_string_lossy().into_owned();
    let _boards = [1, 2].map(|finger| Board::start(finger, &desk.0.path().join(format!("board{finger}"))));
    let names = ["board", "computer", "encoders", "gauges", "motors", "zeros", "tendons", "bound", "spring"];
    let steps = names.map(|step| format!(r#""{step}": {{ "when": "long ago", "found": [] }}"#)).join(", ");
    let fingers = [1, 2].map(|finger| format!(r#""{finger}": {{ "steps": {{ {steps} }} }}"#)).join(", ");
    fs::write(desk.0.path().join("hand.commission.json"), format!(r#"{{ "fingers": {{ {fingers} }} }}"#))
        .expect("written");
    for finger in ["1", "2"] {
        let output = desk.commission(&["--finger", finger, "--port", &ports, "--step", "board"]);
        assert!(output.status.success(), "{output:?}");
        contains(&output.stdout, &["not commissioned yet. Steps left: computer, encoders, gauges, motors, zeros"]);
    }
}

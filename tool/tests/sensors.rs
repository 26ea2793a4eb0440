//! `sun2xp sensors` shows what the encoders and gauges of a board measure.

use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use tempfile::TempDir;

const TOOL: &str = env!("CARGO_BIN_EXE_sun2xp");

/// A running program, with pipes to its standard input and standard output. Dropping this value kills the program.
struct Program {
    process: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Program {
    fn start(arguments: &[&str]) -> Self {
        let mut command = Command::new(TOOL);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = command.spawn().expect("the tool starts");
        let input = process.stdin.take().expect("a pipe");
        let output = BufReader::new(process.stdout.take().expect("a pipe"));
        Self { process, input, output }
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("a line");
        line
    }

    fn reading(&mut self) -> Value {
        let line = self.line();
        serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line:?}"))
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn four(reading: &Value, key: &str) -> [f64; 4] {
    [0, 1, 2, 3].map(|place| reading[key][place].as_f64().unwrap_or_else(|| panic!("{key}: {reading}")))
}

/// Starts a board with finger 2, and `sun2xp sensors` for it.
fn board_and_sensors(folder: &TempDir) -> (Program, Program) {
    let link = folder.path().join("board");
    let link = link.to_str().expect("a name");
    let mut board = Program::start(&["board", "--finger", "2", "--patient", "500", "--link", link]);
    board.line();
    let file = folder.path().join("hand.toml");
    let port = format!("[hand]\nwatchdog_ms = 1000\n[finger]\nport = \"simulated\"\n[finger.2]\nport = \"{link}\"\n");
    std::fs::write(&file, port).expect("written");
    let file = file.to_str().expect("a name");
    let sensors = Program::start(&["sensors", "--config", file, "--finger", "2", "--json"]);
    (board, sensors)
}

#[test]
fn a_fault_ends_the_readings() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut board, mut sensors) = board_and_sensors(&folder);
    sensors.reading();
    writeln!(board.input, "unplug").expect("an order");
    // The program writes lines until the fault ends it. Its pipe then has no more lines.
    while !sensors.line().is_empty() {}
    assert_eq!(sensors.process.wait().expect("ended").code(), Some(1));
    let mut said = String::new();
    sensors.process.stderr.take().expect("a pipe").read_to_string(&mut said).expect("text");
    assert!(said.contains("finger 2: "), "{said}");
}

#[test]
fn turned_encoders_and_loaded_gauges_are_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut board, mut sensors) = board_and_sensors(&folder);
    let first = sensors.reading();
    assert_eq!((four(&first, "turns"), four(&first, "tensions")), ([0.0; 4], [0.0; 4]));

    // The count of encoder 3 rises at once by a quarter of a turn.
    writeln!(board.input, "jump 2 3 500").expect("an order");
    // A gauge of 12 bits with a range of 100 N has 41 counts per newton.
    writeln!(board.input, "dead-gauge 2 1 410").expect("an order");
    let turned = |reading: &Value| (four(reading, "turns")[2] - 0.25).abs() < 0.02;
    let loaded = |reading: &Value| (four(reading, "tensions")[0] - 10.0).abs() < 0.2;
    let shown = (0..20).map(|_| sensors.reading()).find(|reading| turned(reading) && loaded(reading));
    let shown = shown.expect("the turned encoder and the loaded gauge are shown");
    assert!([0, 1, 3].iter().all(|&motor| four(&shown, "turns")[motor].abs() < 0.02), "{shown}");
    assert!([1, 2, 3].iter().all(|&gauge| four(&shown, "tensions")[gauge].abs() < 0.5), "{shown}");
}

#[test]
fn lines_have_a_title_for_every_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hand.toml");
    std::fs::write(&file, "[finger]\nport = \"simulated\"\n").expect("written");
    let run = Command::new(TOOL).args(["sensors", "--seconds", "1", "--config"]).arg(&file).output().expect("it runs");
    let text = String::from_utf8(run.stdout).expect("text");
    let lines: Vec<&str> = text.lines().collect();
    assert!(run.status.success() && lines.len() >= 2, "{text}");
    assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
    assert_eq!(lines[1].split_whitespace().count(), 16, "{text}");
}

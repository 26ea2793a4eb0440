//! Two boards in C: the second board (`tests/c/second_board`), which was written from docs/board-protocol.md alone, and
//! the reference firmware, from which laboratories start. If the library settles the fingers of the second board,
//! docs/board-protocol.md contains everything that a board needs.

#[path = "common/attempts.rs"]
mod attempts;
#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;
#[allow(dead_code)]
#[path = "common/priority.rs"]
mod priority;
#[path = "common/settling.rs"]
mod settling;
#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use attempts::attempts;
use pauses::Part;
use settling::{Settling, distance};
use sun2xp::hand::{Hand, HandError, read_configuration};
use sun2xp::model::configuration::Configuration;

const SOURCES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/c/second_board");
const FIRMWARE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/firmware");
const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/board-protocol.md");

/// Largest distance of a finger from its target, rad.
const CLOSE: f64 = 0.02;
/// Time after which a wait fails. On a busy machine the finger moves more slowly than it would in real time.
const PATIENCE: Duration = Duration::from_secs(20);

fn succeeds(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    assert!(output.status.success(), "{command:?}:\n{said}");
}

/// Compiles the board into the folder. Every warning is an error.
fn compile(folder: &Path) -> PathBuf {
    let program = folder.join("second_board");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_string());
    let sources =
        std::fs::read_dir(SOURCES).expect("the folder of the board").map(|entry| entry.expect("a file").path());
    let sources = sources.filter(|path| path.extension().is_some_and(|extension| extension == "c"));
    succeeds(
        Command::new(&compiler)
            .args(["-std=c99", "-D_XOPEN_SOURCE=700", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-o"])
            .arg(&program)
            .args(sources)
            .arg("-lm"),
    );
    program
}

/// A running board. Dropping it kills its process, so the process ends even if the test fails.
struct Board {
    process: Child,
    output: BufReader<ChildStdout>,
    port: String,
}

impl Board {
    fn start(program: &Path, address: usize) -> Self {
        let mut command = Command::new(program);
        let mut process = priority::runs_first(&mut command)
            .arg(address.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the board starts");
        let output = BufReader::new(process.stdout.take().expect("the board's output is a pipe"));
        let mut board = Self { process, output, port: String::new() };
        board.port = board.line();
        board
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("the board's output is text");
        assert!(!line.is_empty(), "the board ended by itself");
        line.trim_end().to_string()
    }

    /// The true joint angles. The library infers them from encoders and gauges.
    fn joints(&mut self) -> [f64; 3] {
        let input = self.process.stdin.as_mut().expect("the board's input is a pipe");
        input.write_all(b"\n").expect("the board reads its input");
        let line = self.line();
        let angles: Vec<f64> = line.split(' ').map(|angle| angle.parse().expect("the board prints angles")).collect();
        angles.try_into().expect("the board prints three angles")
    }

    fn kill(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        self.kill();
    }
}

/// The result of an attempt. Errors are texts, because a fault and a finger in a wrong place count alike here.
type Attempt = Result<(), String>;

fn text(error: HandError) -> String {
    error.to_string()
}

/// Sends all fingers to their targets and waits until all have stayed there for a while.
fn settle(hand: &Hand, targets: [[f64; 3]; 3]) -> Attempt {
    for (finger, target) in (1..).zip(targets) {
        hand.send_position(finger, target).map_err(text)?;
    }
    let settling = Settling { tolerance: CLOSE, rest: Duration::from_millis(200), patience: PATIENCE };
    settling.wait(hand, &[(1, targets[0]), (2, targets[1]), (3, targets[2])]).map(drop)
}

#[test]
fn a_second_board_settles_three_fingers() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    settles_three_fingers_and_notices_a_dead_board(&compile(folder.path()), folder.path());
}

#[test]
fn the_reference_firmware_settles_three_fingers() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    make(folder.path(), &["host"]);
    settles_three_fingers_and_notices_a_dead_board(&folder.path().join("peer"), folder.path());
}

#[test]
fn the_reference_firmware_passes_the_vectors_and_survives_noise() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    // On Debian, the sanitizers are installed with gcc, but not with clang.
    if tools::available("gcc", "under gcc, with sanitizers") {
        let sanitize = "SANITIZE=-fsanitize=address,undefined -fno-sanitize-recover=all";
        make(folder.path(), &["check", "CC=gcc", sanitize]);
    }
    if tools::available("clang", "under clang") {
        make(&folder.path().join("clang"), &["check", "CC=clang"]);
    }
}

/// Runs make in firmware/ and places the products in `folder`.
fn make(folder: &Path, arguments: &[&str]) {
    succeeds(Command::new("make").args(["-C", FIRMWARE]).arg(format!("BUILD={}", folder.display())).args(arguments));
}

fn settles_three_fingers_and_notices_a_dead_board(program: &Path, folder: &Path) {
    attempts("a hand on three boards in C", TOLERATED_PAUSE, |watch| {
        let mut boards = [1, 2, 3].map(|address| Board::start(program, address));
        for board in &boards {
            watch.also(board.process.id(), Part::Board);
        }
        let hand = Hand::open(configuration(&boards, folder)).map_err(text)?;
        let settled = hold_and_settle(&hand, &mut boards);
        settled.and_then(|()| notices_a_dead_board(&hand, &mut boards[1])).map_err(|failure| {
            let losses = [1, 2, 3].map(|finger| hand.losses(finger).expect("a finger"));
            format!("{failure}; {losses:?}")
        })
    });
}

/// A servo that receives nothing for 10 ms lets the motors go and starts again (docs/architecture.md). A hand survives
/// that, but the frictionless fingers of these boards may not survive a pause of five times that length.
const TOLERATED_PAUSE: Duration = Duration::from_millis(50);

fn configuration(boards: &[Board; 3], folder: &Path) -> Configuration {
    // The boards let a finger move for at most 2 ms after a Command, so a late Command is harmless at this rate. A busy
    // machine may delay servo or board by more than the default watchdog time, so this configuration has a longer one.
    let mut text = "[hand]\nrate = 500.0\nwatchdog_ms = 1000\n[finger.controller]\nset_point_speed = 1.0\n".to_string();
    for (finger, board) in (1..).zip(boards) {
        text += &format!("[finger.{finger}]\nport = \"{}\"\n", board.port);
    }
    let path = folder.join("sun2xp.toml");
    std::fs::write(&path, text).expect("the configuration is written");
    read_configuration(&path).expect("the configuration is good")
}

fn hold_and_settle(hand: &Hand, boards: &mut [Board; 3]) -> Attempt {
    // The hand holds the pose in which it found the fingers.
    for finger in 1..=3 {
        let position = hand.position(finger).map_err(text)?;
        let start = [0.0, 30.0_f64.to_radians(), 60.0_f64.to_radians()];
        if distance(position, start) > CLOSE {
            return Err(format!("finger {finger} begins at {position:?} instead of {start:?}"));
        }
    }
    for targets in
        [[[0.1, 0.4, 0.9], [-0.1, 0.6, 1.1], [0.0, 0.7, 0.8]], [[-0.15, 0.7, 1.2], [0.15, 0.3, 0.8], [0.1, 0.4, 1.3]]]
    {
        settle(hand, targets)?;
        for (board, target) in boards.iter_mut().zip(targets) {
            let joints = board.joints();
            if distance(joints, target) > CLOSE {
                return Err(format!("the true joints are {joints:?} instead of {target:?}"));
            }
        }
    }
    Ok(())
}

fn notices_a_dead_board(hand: &Hand, board: &mut Board) -> Attempt {
    board.kill();
    let begin = Instant::now();
    let error = loop {
        match hand.position(2) {
            Err(error) => break error,
            Ok(_) if begin.elapsed() > PATIENCE => return Err("a dead board was not noticed".into()),
            Ok(_) => std::thread::sleep(Duration::from_millis(5)),
        }
    };
    let reason = error.to_string();
    if !(reason.contains("finger 2 is faulted") && reason.contains("port")) {
        return Err(reason);
    }
    // The other fingers are on boards of their own.
    [1, 3].into_iter().try_for_each(|finger| hand.position(finger).map(drop).map_err(text))
}

#[test]
fn the_examples_of_the_page_agree_with_the_second_board() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let output = Command::new(compile(folder.path())).arg("--check").arg(PAGE).output().expect("the check runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

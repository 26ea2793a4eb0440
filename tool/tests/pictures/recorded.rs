//! A recording of a finger that moves, is pushed, loses replies and faults.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use sun2xp::board::protocol::Status;
use sun2xp::finger::Recording;
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{LineFault, Pace, SimulatedBoard, SimulatedPort};
use tempfile::TempDir;

/// Rate of the servos, Hz.
const RATE: f64 = 500.0;

/// A black box of finger 2 in a folder of its own.
pub struct Recorded {
    pub folder: TempDir,
    pub recording: Recording,
}

impl Recorded {
    pub fn file(&self) -> PathBuf {
        self.folder.path().join("finger-2.jsonl")
    }

    /// Cycles in which the controller ran.
    pub fn computed(&self) -> usize {
        self.recording.cycles.iter().filter(|cycle| cycle.control.is_some()).count()
    }
}

pub fn recorded() -> &'static Recorded {
    static RECORDED: OnceLock<Recorded> = OnceLock::new();
    RECORDED.get_or_init(record)
}

fn record() -> Recorded {
    let board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).expect("a board");
    let port = SimulatedPort::start(board, Pace::patient(RATE), Priority { fifo: 20, core: None }).expect("a port");
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.watchdog_ms) = (RATE, 1000);
    for finger in &mut configuration.fingers {
        finger.port = port.path().to_string_lossy().into_owned();
        (finger.baud, finger.thread) = (2_000_000, 1);
    }
    let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"));
    hand.send_position(2, [0.0, 0.6, 0.9]).expect("sent");
    cycles(&hand, 700);
    hand.send_position(2, [0.15, 0.4, 1.2]).expect("sent");
    cycles(&hand, 400);
    hand.send_stiffness(2, [[3.0, 0.5, 0.0], [0.5, 2.0, 0.0], [0.0, 0.0, 4.0]]).expect("sent");
    let push = |force: [f64; 3]| port.with_finger(2, |finger| finger.plant().set_external_force(force.into()));
    push([0.8, -0.6, 0.3]).expect("finger 2");
    cycles(&hand, 250);
    port.inject(LineFault::Drop, 0.3, 60_000_000, 7);
    cycles(&hand, 100);
    port.with_finger(2, |finger| finger.set_faults(Status::EMERGENCY_STOP)).expect("finger 2");
    wait_until(|| hand.fingertip(2).is_err());
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-2.jsonl");
    hand.write_black_box(2, &file).expect("written");
    let recording = Recording::open(&file).expect("read");
    Recorded { folder, recording }
}

fn wait_until(mut wanted: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !wanted() {
        assert!(begun.elapsed() < Duration::from_secs(30), "the hand does not run");
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn cycles(hand: &Hand, count: u64) {
    let now = || hand.report(2).expect("a report").losses.cycles;
    let end = now() + count;
    wait_until(|| now() >= end);
}

/// Runs the tool in a folder.
pub fn tool(folder: &Path, arguments: &[&str]) -> Output {
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    tool.args(arguments).current_dir(folder).output().expect("the tool runs")
}

/// Runs the tool. It must succeed.
pub fn done(folder: &Path, arguments: &[&str]) -> String {
    let output = tool(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
    String::from_utf8(output.stdout).expect("text")
}

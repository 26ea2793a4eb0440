//! A hand on a board in this process, and a run with set points, adjustments and lost replies for its black box.

use crate::pauses;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, Scheme};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

pub const RATE: f64 = 500.0;

/// A hand whose fingers are on one board in this process, so that a test can cause events.
pub fn own_board(scheme: Scheme, folder: Option<&Path>) -> (SimulatedPort, Hand) {
    let board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).expect("a board");
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

/// Waits until no other test has a turn. Only one hand runs at a time, because its servos and boards need the whole
/// machine.
pub fn turn() -> MutexGuard<'static, ()> {
    pauses::name_pauses();
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

pub fn wait_until(what: &str, mut wanted: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !wanted() {
        assert!(begun.elapsed() < Duration::from_secs(20), "not {what}");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Waits for a number of cycles.
pub fn cycles(hand: &Hand, count: u64) {
    let now = || hand.report(2).expect("a report").losses.cycles;
    let end = now() + count;
    wait_until("so many cycles", || now() >= end);
}

/// Sends set points and stiffnesses, adjusts the finger, and loses replies for a short and a long time.
pub fn eventful(board: &SimulatedPort, hand: &Hand) {
    for (step, angle) in [0.9, 1.2, 1.0].into_iter().enumerate() {
        hand.send_position(2, [0.1, 0.5, angle]).expect("sent");
        cycles(hand, 60);
        hand.send_stiffness(2, [[2.0, 0.0, 0.0], [0.0, 3.0 - 0.5 * step as f64, 0.0], [0.0, 0.0, 1.5]]).expect("sent");
        hand.adjust(2, &format!("tendon.minimum = {}", 5 + step % 2)).expect("adjusted");
        cycles(hand, 60);
    }
    // The board is silent for 3 cycles, and later for 30. In the second silence the motor torques fade to their final
    // values, so the controller restarts at the first reply afterwards.
    for silence in [3.0, 30.0] {
        board.with_board(|_| std::thread::sleep(Duration::from_secs_f64(silence / RATE)));
        cycles(hand, 40);
    }
}

pub fn replayed(file: &Path) -> (Option<i32>, String) {
    replayed_with(file, &[])
}

pub fn replayed_with(file: &Path, options: &[&str]) -> (Option<i32>, String) {
    let mut tool = Command::new(env!("CARGO_BIN_EXE_sun2xp"));
    let run = tool.arg("replay").arg(file).args(options).output().expect("the tool runs");
    let Output { status, stdout, stderr } = run;
    (status.code(), [stdout, stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat())
}

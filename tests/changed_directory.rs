//! A planner may change its working directory, as a daemon does. Calibrations and black boxes must still be written
//! where the configuration says, and the ports that it names must still be found. The tests have a process of their
//! own, because they change the working directory.

#[path = "common/attempts.rs"]
mod attempts;
#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;
#[allow(dead_code)]
#[path = "common/recoveries.rs"]
mod recoveries;

use recoveries::recovers_despite_pauses;
use std::env::set_current_dir;
use std::fs;
use std::os::unix::fs::symlink;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::hand::{Fingers, Hand, read_configuration, stop_all};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

/// The process has one working directory.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

const LIMIT: Duration = Duration::from_secs(20);

#[test]
fn a_relative_port_is_opened_again_from_another_working_directory() {
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().expect("a folder");
    set_current_dir(folder.path()).expect("the working directory can be changed");
    let board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).expect("a board");
    let board = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None }).expect("a port");
    symlink(board.path(), "board").expect("a link");
    let mut configuration = Configuration::default();
    (configuration.hand.rate, configuration.hand.watchdog_ms) = (500.0, 1000);
    configuration.hand.open_timeout_ms = 20_000;
    configuration.hand.fingers = Fingers::one(FingerNumber::ONE);
    (configuration.fingers[0].port, configuration.fingers[0].reconnect) = ("board".into(), true);
    let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("{error}"));
    set_current_dir("/").expect("the working directory can be changed");

    board.unplug();
    let begun = Instant::now();
    while !matches!(hand.report(1).expect("a report").stage, Stage::Faulted(_)) {
        assert!(begun.elapsed() < LIMIT, "the port has not vanished");
        std::thread::sleep(Duration::from_millis(2));
    }
    board.plug_in().expect("a new port");
    fs::remove_file(folder.path().join("board")).expect("removed");
    symlink(board.path(), folder.path().join("board")).expect("a link");
    recovers_despite_pauses(&hand, 1, &[]);
    hand.close();
}

#[test]
fn relative_paths_keep_the_working_directory_of_the_opening() {
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().expect("a folder");
    set_current_dir(folder.path()).expect("the working directory can be changed");
    fs::create_dir("boxes").expect("made");
    let file = "[hand]\nrate = 500\nblack_box = \"boxes\"\n[finger]\nport = \"simulated\"\n";
    fs::write("hand.toml", file).expect("written");
    let hand = Hand::open_limp(
        read_configuration("hand.toml".as_ref()).expect("usable"),
        Some("hand.toml".into()),
        Fingers::ALL,
    )
    .expect("open");
    set_current_dir("/").expect("the working directory can be changed");

    hand.find_signs(1, |_| {}).expect("signs");
    assert!(hand.store_calibration(1).unwrap_or_else(|error| panic!("{error}")));
    stop_all();
    let begun = Instant::now();
    let boxes = || fs::read_dir(folder.path().join("boxes")).expect("there").flatten();
    while boxes().filter(|file| file.path().extension().is_some_and(|name| name == "jsonl")).count() < 3 {
        assert!(begun.elapsed() < LIMIT, "fewer than three black boxes were written");
        std::thread::sleep(Duration::from_millis(10));
    }
}

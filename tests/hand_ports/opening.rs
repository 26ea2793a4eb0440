//! Refusals of `Hand::open`, with their error numbers and texts.

use crate::rig::{Board, TARGET, close, goes, on_boards, on_one_port, on_ports, open, three_boards, turn};
use serialport::{SerialPort, TTYPort};
use std::io::Write;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use sun2xp::board::protocol::Status;
use sun2xp::hand::{Hand, HandError};
use sun2xp::model::configuration::Configuration;

fn refusal(configuration: Configuration) -> HandError {
    match Hand::open(configuration) {
        Ok(_) => panic!("opened"),
        Err(error) => error,
    }
}

/// The refusal of a hand whose finger 2 is on an unusable port.
fn refusal_of_finger_2(port: &str) -> HandError {
    let (first, third) = (Board::start(&["1"]), Board::start(&["3"]));
    let mut configuration = on_ports([&first.port, port, &third.port]);
    configuration.hand.open_timeout_ms = 400;
    refusal(configuration)
}

fn assert_names(error: &HandError, errno: i32, parts: &[&str]) {
    let text = error.to_string();
    assert_eq!(error.errno(), errno, "{text}");
    for part in parts {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
}

#[test]
fn a_rate_that_one_port_cannot_carry_for_three_fingers() {
    let _turn = turn();
    let board = Board::start(&["1", "2", "3"]);
    let mut configuration = on_one_port(&board.port, 1_000_000);
    configuration.hand.rate = 1000.0;
    let error = refusal(configuration.clone());
    assert_names(&error, libc::EINVAL, &["baud", "1110 us in all", "800 us", "baud = 1500000", "hand.rate = 720"]);
    // The remedy that the refusal names.
    configuration.hand.rate = 720.0;
    goes(&open(configuration), 3, TARGET);
}

#[test]
fn a_port_in_use() {
    let _turn = turn();
    let mut boards = three_boards();
    let first = open(on_boards(&boards));
    goes(&first, 1, TARGET);
    let own = Board::start(&["1"]);
    // The refusal comes half-way: finger 1 of the second hand has already been reached.
    let error = refusal(on_ports([&own.port, &boards[1].port, &boards[2].port]));
    assert_names(&error, libc::EBUSY, &["finger 2", &boards[1].port, "in use"]);
    goes(&first, 2, TARGET);
    // The hand that opened only partly has released its port.
    drop(first);
    goes(&open(on_ports([&own.port, &boards[1].port, &boards[2].port])), 1, TARGET);
    assert!(boards[0].state(1).has(Status::ENDED));
}

#[test]
fn a_wrong_address() {
    let _turn = turn();
    let other = Board::start(&["3"]);
    let error = refusal_of_finger_2(&other.port);
    assert_names(&error, libc::ENXIO, &["finger 2", "no finger address 2; it has 3", "finger.address"]);
}

#[test]
fn a_silent_device() {
    let _turn = turn();
    let (_silent, port) = TTYPort::pair().expect("a pseudo-terminal");
    let name = port.name().expect("its name");
    drop(port);
    let error = refusal_of_finger_2(&name);
    assert_names(&error, libc::ETIMEDOUT, &["finger 2", "no byte was received", "switched on", "receive input"]);
}

#[test]
fn a_device_with_another_protocol() {
    let _turn = turn();
    let (mut device, port) = TTYPort::pair().expect("a pseudo-terminal");
    let name = port.name().expect("its name");
    drop(port);
    let ended = AtomicBool::new(false);
    let error = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !ended.load(Ordering::Relaxed) {
                // A device like a GPS receiver or a modem. Perhaps nothing reads its bytes.
                let _ = device.write(b"$GPGGA,123519,4807.038,N,01131.000,E*47\r\n\0");
                std::thread::sleep(Duration::from_millis(2));
            }
        });
        let error = refusal_of_finger_2(&name);
        ended.store(true, Ordering::Relaxed);
        error
    });
    assert_names(&error, libc::EPROTO, &["finger 2", "no valid frame", "baud rate"]);
}

#[test]
fn files_that_are_no_port() {
    let _turn = turn();
    let file = tempfile::NamedTempFile::new().expect("a file");
    for path in ["/dev/null", &file.path().to_string_lossy()] {
        assert_names(&refusal_of_finger_2(path), libc::ENOTTY, &["finger 2", path, "not a serial port"]);
    }
    assert_names(&refusal_of_finger_2("/dev/no-such-port"), libc::ENOENT, &["finger 2", "/dev/no-such-port", "cable"]);
}

#[test]
fn a_tendon_that_stays_slack_closes_the_whole_hand_again() {
    let _turn = turn();
    let mut boards = three_boards();
    let mut configuration = on_boards(&boards);
    // Even a busy machine finds the slack tendon in this time.
    configuration.hand.open_timeout_ms = 3000;
    // The motor unwinds its tendon instead of winding it.
    configuration.fingers[2].motor.sign = [1, 1, 1, -1];
    let error = refusal(configuration);
    assert_names(&error, libc::EIO, &["finger 3", "tendon 4", "sign or zero of a motor or gauge"]);
    for (index, board) in boards.iter_mut().enumerate() {
        let state = board.state(index + 1);
        assert!(state.has(Status::ENDED) && state.limp(), "finger {}: {state:?}", index + 1);
        assert!(!state.has(Status::WATCHDOG_TRIPPED), "finger {} left to the watchdog: {state:?}", index + 1);
    }
    // The ports of the refused hand are free again.
    boards[2] = Board::start(&["3"]);
    let hand = open(on_boards(&boards));
    goes(&hand, 1, TARGET);
    close(hand);
}

//! A board that sends valid frames without end: OpenHand refuses it, its finger faults, and no other finger is delayed.

use crate::priority::run_first;
use crate::recoveries::recovers_despite_pauses;
use crate::rig::{TARGET, close, goes, on_ports, open, three_boards, turn, wait_until};
use serialport::{SerialPort, TTYPort};
use std::io::{Read, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};
use sun2xp::board::protocol::{Frame, Message, Reply, Stopped, WireFrame};
use sun2xp::finger::{FaultKind, Stage};
use sun2xp::hand::{Hand, stop_all};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::now;
use sun2xp::simulated::{Pace, PacedTime, SimulatedBoard};

/// Longest time by which a board that sends without end may delay a call. Most of this time is a reserve for a busy
/// machine. If the servo read without a bound, a flood would block it for longer than this time.
const PROMPT: Duration = Duration::from_secs(1);

/// A board with finger 2 that repeats one frame on request, and sends no answers meanwhile.
struct FloodingBoard {
    port: String,
    flooding: Arc<AtomicBool>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl FloodingBoard {
    fn start(frame: Frame, flooding: bool) -> Self {
        let (mut device, port) = TTYPort::pair().expect("a pseudo-terminal");
        device.set_timeout(Duration::from_millis(1)).expect("set");
        let name = port.name().expect("its name");
        let [flooding, ended] = [flooding, false].map(|set| Arc::new(AtomicBool::new(set)));
        // The frame is of another finger, because a Reply of finger 2 could match a Command by chance.
        let wire = WireFrame::new(&Message { address: 9, sequence: 200, frame }).as_bytes().repeat(100);
        let thread = {
            let (flooding, ended) = (flooding.clone(), ended.clone());
            // `PauseWatch` recognises board threads by this name.
            let thread = std::thread::Builder::new().name("sun2xp board".into());
            thread.spawn(move || {
                run_first();
                // This thread keeps the port open. So the pseudo-terminal remains usable when the host closes the port.
                let _port = port;
                let mut board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::TWO]).expect("a board");
                let mut clock = PacedTime::new(Pace::patient(500.0), now());
                let mut input = [0; 512];
                // Position at which the flood continues after a partial write, so that every frame is whole.
                let mut place = 0;
                while !ended.load(Ordering::Relaxed) {
                    let flooding = flooding.load(Ordering::Relaxed);
                    let taken = match flooding && device.bytes_to_read().is_ok_and(|count| count == 0) {
                        true => 0,
                        false => device.read(&mut input).unwrap_or(0),
                    };
                    let time = clock.wake(now(), taken > 0);
                    let mut answers = Vec::new();
                    board.receive(time, &input[..taken], &mut |answer| answers.extend(answer));
                    if flooding || place > 0 {
                        place = (place + device.write(&wire[place..]).unwrap_or(0)) % wire.len();
                    } else {
                        // Bytes that find no room are lost, as in a UART.
                        let _ = device.write(&answers);
                    }
                }
            })
        };
        Self { port: name, flooding, ended, thread: Some(thread.expect("a thread")) }
    }

    fn flood(&self, flooding: bool) {
        self.flooding.store(flooding, Ordering::Relaxed);
    }
}

impl Drop for FloodingBoard {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let thread = self.thread.take().expect("it is joined here only");
        thread.join().expect("no panic");
    }
}

/// Returns the frames of the floods: one of the type for which a servo waits, and one of a type that the link discards.
fn floods() -> [Frame; 2] {
    [Frame::Reply(Reply::default()), Frame::Stopped(Stopped::default())]
}

fn fault(hand: &Hand, finger: i32) -> Option<FaultKind> {
    match hand.report(finger).expect("a report").stage {
        Stage::Faulted(fault) => Some(fault.kind),
        _ => None,
    }
}

#[test]
fn a_flooding_board_is_refused_in_time() {
    let _turn = turn();
    for frame in floods() {
        let mut boards = three_boards();
        let board = FloodingBoard::start(frame, true);
        let mut configuration = on_ports([&boards[0].port, &board.port, &boards[2].port]);
        configuration.hand.open_timeout_ms = 400;
        let begun = Instant::now();
        let error = Hand::open(configuration).err().expect("refused");
        let lasted = begun.elapsed();
        assert!(error.to_string().contains("does not answer a Hello frame"), "{error}");
        assert!(lasted < Duration::from_millis(400) + PROMPT, "{lasted:?}");
        assert!(boards[0].state(1).limp());
    }
}

#[test]
fn a_board_that_begins_to_flood_faults_its_finger_only() {
    let _turn = turn();
    for frame in floods() {
        for one_thread in [false, true] {
            let boards = three_boards();
            let board = FloodingBoard::start(frame, false);
            let mut configuration = on_ports([&boards[0].port, &board.port, &boards[2].port]);
            // This time is longer than the usual pauses of a busy machine, and the test still ends soon.
            configuration.hand.watchdog_ms = 300;
            if one_thread {
                configuration.fingers.iter_mut().for_each(|finger| finger.thread = 1);
            }
            let hand = open(configuration);
            goes(&hand, 2, TARGET);
            board.flood(true);
            wait_until("faulted", || fault(&hand, 2).is_some());
            assert_eq!(fault(&hand, 2), Some(FaultKind::LostReplies), "{frame:?}");
            goes(&hand, 1, TARGET);
            goes(&hand, 3, TARGET);

            let begun = Instant::now();
            let error = hand.recover(2).expect_err("it floods");
            assert!(error.to_string().contains("does not answer a Hello frame"), "{error}");
            assert!(begun.elapsed() < Duration::from_millis(300) + PROMPT, "{:?}", begun.elapsed());
            goes(&hand, 1, TARGET);

            board.flood(false);
            recovers_despite_pauses(&hand, 2, &[]);
            goes(&hand, 2, TARGET);

            // The hand is stopped during the flood.
            board.flood(true);
            let begun = Instant::now();
            stop_all();
            wait_until("stopped", || (1..=3).all(|finger| fault(&hand, finger).is_some()));
            assert!(begun.elapsed() < PROMPT, "{:?}", begun.elapsed());
            let begun = Instant::now();
            close(hand);
            assert!(begun.elapsed() < PROMPT, "{:?}", begun.elapsed());
        }
    }
}

#[test]
fn a_hand_closes_while_a_board_floods() {
    let _turn = turn();
    for frame in floods() {
        let mut boards = three_boards();
        let board = FloodingBoard::start(frame, false);
        let hand = open(on_ports([&boards[0].port, &board.port, &boards[2].port]));
        let ramp = Duration::from_millis(200);
        board.flood(true);
        let begun = Instant::now();
        close(hand);
        assert!(begun.elapsed() < ramp + PROMPT, "{:?}", begun.elapsed());
        assert!(boards[0].state(1).limp());
    }
}

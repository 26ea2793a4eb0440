//! Requests and answers in a row, from power-up: the state diagram as a board must live it.

use super::frames::sealed;
use super::json::{hex, list, object, text};
use sun2xp::board::protocol::*;
use sun2xp::model::configuration::{Configuration, EndState};
use sun2xp::simulated::SimulatedBoard;

/// What is done to the board, and what must follow.
enum Step {
    /// Bytes, and the answer; none where the board must be silent.
    Send(Vec<u8>, Option<Answer>),
    /// Nothing for so long, ms.
    Wait(u64),
    /// Faults that are present from now on.
    Faults(Status),
    /// What the motors give now, torque units.
    Torques([i16; 4]),
}

enum Answer {
    Identity,
    /// In these three, the status: *zero valid* depends on the board and is left out.
    Configured(Status),
    Reply(Status),
    Stopped(Status),
    Refused {
        reason: u8,
        detail: u16,
    },
}

const READY: Status = Status::CONFIGURED;
const ENDED: Status = Status(Status::CONFIGURED.0 | Status::ENDED.0);
const ENABLED: Status = Status(Status::CONFIGURED.0 | Status::ENABLED.0);
const NO_TORQUE: Step = Step::Torques([0; 4]);

/// All boards under test must be able to keep these.
const TERMS: Configure = Configure {
    version: 1,
    watchdog_ms: 20,
    end_state: EndState::Release,
    hold_time_ms: 60,
    hold_torque_limit: 500,
    torque_limits: [10_000, 10_000, 10_000, 9_000],
    torque_constants: [23_400; 4],
};
const HOLD: Configure = Configure { end_state: EndState::Hold, ..TERMS };

fn sent(frame: Frame, answer: Answer) -> Step {
    // The sequence number is any; it comes back.
    let wire = WireFrame::new(&Message { address: 1, sequence: 0xA5, frame });
    Step::Send(wire.as_bytes().to_vec(), Some(answer))
}

fn raw(content: &[u8], reason: u8, detail: u16) -> Step {
    Step::Send(sealed(content), Some(Answer::Refused { reason, detail }))
}

fn refused(reason: u8, detail: u16) -> Answer {
    Answer::Refused { reason, detail }
}

fn configure(terms: Configure, answer: Answer) -> Step {
    sent(Frame::Configure(terms), answer)
}

fn stop(status: Status) -> Step {
    sent(Frame::Stop(Stop), Answer::Stopped(status))
}

fn command(torques: [i16; 4], status: Status) -> Step {
    sent(Frame::Command(Command { toggle: true, enable: true, torques }), Answer::Reply(status))
}

fn disabled(torques: [i16; 4], status: Status) -> Step {
    sent(Frame::Command(Command { toggle: false, enable: false, torques }), Answer::Reply(status))
}

fn hello(lowest_version: u8, highest_version: u8, answer: Answer) -> Step {
    sent(Frame::Hello(Hello { lowest_version, highest_version }), answer)
}

fn conversations() -> Vec<(&'static str, Vec<Step>)> {
    let command_frame = Frame::Command(Command { toggle: false, enable: true, torques: [1; 4] });
    let ready = || configure(TERMS, Answer::Configured(READY));
    let ready_to_hold = || configure(HOLD, Answer::Configured(READY));
    let tripped = ENDED | Status::WATCHDOG_TRIPPED;
    let stopped = ENDED | Status::EMERGENCY_STOP;
    // A Configure whose end state means nothing: no codec of ours writes one.
    let mut end_state_2 = vec![0x21, 9, 1, 20, 0, 2];
    end_state_2.resize(34, 0);
    vec![
        (
            "idle: says who it is, refuses commands",
            vec![
                NO_TORQUE,
                hello(1, 1, Answer::Identity),
                hello(0, 255, Answer::Identity),
                hello(2, 3, refused(1, 0x0101)),
                sent(command_frame, refused(3, 0)),
                stop(Status::default()),
                sent(command_frame, refused(3, 0)),
                NO_TORQUE,
            ],
        ),
        (
            "configured, enabled, disabled",
            vec![
                ready(),
                NO_TORQUE,
                disabled([100; 4], READY),
                NO_TORQUE,
                ready(),
                command([100, -200, 0, 9000], ENABLED),
                Step::Torques([100, -200, 0, 9000]),
                hello(1, 1, Answer::Identity),
                Step::Torques([100, -200, 0, 9000]),
                configure(TERMS, refused(4, 0)),
                Step::Torques([100, -200, 0, 9000]),
                disabled([100; 4], READY),
                NO_TORQUE,
                ready(),
            ],
        ),
        (
            "torques are clipped, and only what is obeyed",
            vec![
                ready(),
                command([10_001, -10_001, i16::MAX, i16::MIN], ENABLED | Status::TORQUE_CLIPPED),
                Step::Torques([10_000, -10_000, 10_000, -9_000]),
                command([10_000, -10_000, 1, 9_000], ENABLED),
                Step::Torques([10_000, -10_000, 1, 9_000]),
                disabled([i16::MAX; 4], READY),
                stop(ENDED),
                command([i16::MAX; 4], ENDED),
                NO_TORQUE,
            ],
        ),
        (
            "the watchdog releases",
            vec![
                ready(),
                Step::Wait(100),
                command([100; 4], ENABLED),
                Step::Wait(19),
                command([100; 4], ENABLED),
                Step::Wait(19),
                hello(1, 1, Answer::Identity),
                Step::Wait(3),
                NO_TORQUE,
                command([100; 4], tripped),
                disabled([0; 4], tripped),
                stop(tripped),
                NO_TORQUE,
                ready(),
                command([100; 4], ENABLED),
            ],
        ),
        (
            "only a command with enable set restarts the watchdog",
            vec![
                ready(),
                command([100; 4], ENABLED),
                Step::Wait(15),
                raw(&[0x31, 0, 2, 0, 0], 6, 3),
                configure(TERMS, refused(4, 0)),
                Step::Wait(7),
                command([100; 4], tripped),
                NO_TORQUE,
            ],
        ),
        (
            "a stop holds, for its time and within its limit",
            vec![
                ready_to_hold(),
                command([1000, -1000, 100, 0], ENABLED),
                stop(ENDED | Status::HOLDING),
                Step::Torques([500, -500, 100, 0]),
                command([100; 4], ENDED | Status::HOLDING),
                Step::Torques([500, -500, 100, 0]),
                Step::Wait(40),
                stop(ENDED | Status::HOLDING),
                Step::Wait(22),
                NO_TORQUE,
                command([100; 4], ENDED),
                NO_TORQUE,
            ],
        ),
        (
            "the watchdog holds; a configure ends that",
            vec![
                ready_to_hold(),
                command([1000, -1000, 100, 0], ENABLED),
                Step::Wait(22),
                Step::Torques([500, -500, 100, 0]),
                command([100; 4], tripped | Status::HOLDING),
                configure(TERMS, Answer::Configured(READY)),
                NO_TORQUE,
            ],
        ),
        (
            "there is nothing to hold before the first torque, and no time in a hold of 0 ms",
            vec![
                ready_to_hold(),
                stop(ENDED),
                NO_TORQUE,
                configure(Configure { hold_time_ms: 0, ..HOLD }, Answer::Configured(READY)),
                command([1000; 4], ENABLED),
                stop(ENDED),
                NO_TORQUE,
            ],
        ),
        (
            "terms that cannot be kept leave those before",
            vec![
                configure(Configure { version: 2, ..TERMS }, refused(2, 2)),
                sent(command_frame, refused(3, 0)),
                ready(),
                configure(Configure { version: 0, ..TERMS }, refused(2, 2)),
                configure(Configure { watchdog_ms: 0, ..TERMS }, refused(2, 3)),
                configure(Configure { watchdog_ms: 0, torque_limits: [u16::MAX; 4], ..TERMS }, refused(2, 3)),
                raw(&end_state_2, 2, 5),
                configure(Configure { torque_limits: [1, u16::MAX, 1, u16::MAX], ..HOLD }, refused(2, 12)),
                command([10_000, 0, 0, 9_001], ENABLED | Status::TORQUE_CLIPPED),
                Step::Torques([10_000, 0, 0, 9_000]),
                raw(&end_state_2, 4, 0),
            ],
        ),
        (
            "types and lengths that it does not know",
            vec![
                raw(&[0x71, 1], 6, 0),
                // For a board without tactile sensors.
                raw(&[0x61, 1, 0], 6, 1),
                raw(&[0x01, 1, 2], 6, 1),
                raw(&[0x51, 1, 2, 3], 6, 2),
                raw(&[0x41, 1, 2], 6, 1),
                raw(&[0x11, 1, 1], 6, 1),
                raw(&[0x31, 1, 2, 0, 0, 0, 0, 0, 0, 0], 6, 8),
                ready(),
                command([100; 4], ENABLED),
                raw(&[0x21, 1, 1], 6, 1),
                Step::Torques([100; 4]),
            ],
        ),
        (
            "damage is told in the next reply",
            vec![
                Step::Send(vec![3, 0x31, 7, 0], None),
                ready(),
                disabled([0; 4], READY | Status::DAMAGED_INPUT),
                disabled([0; 4], READY),
                // A Command in two pieces, with a delimiter between them.
                Step::Send(vec![8, 0x31, 7, 3, 0, 0xA4, 4, 0x52, 0], None),
                stop(ENDED),
                command([0; 4], ENDED | Status::DAMAGED_INPUT),
                // Not damaged: for another finger, an answer, delimiters.
                Step::Send(sealed(&[0x42, 1]), None),
                Step::Send(sealed(&[0xC1, 1, 0, 0]), None),
                Step::Send(vec![0, 0], None),
                command([0; 4], ENDED),
            ],
        ),
        (
            "an emergency stop takes the torque off and is remembered",
            vec![
                ready_to_hold(),
                command([100; 4], ENABLED),
                Step::Faults(Status::EMERGENCY_STOP),
                Step::Wait(1),
                NO_TORQUE,
                command([100; 4], stopped),
                configure(HOLD, refused(5, 0x40)),
                configure(Configure { version: 2, ..HOLD }, refused(5, 0x40)),
                Step::Faults(Status::default()),
                Step::Wait(1),
                command([100; 4], stopped),
                stop(stopped),
                NO_TORQUE,
                ready(),
                command([100; 4], ENABLED),
                Step::Torques([100; 4]),
            ],
        ),
        (
            "a fault ends a hold, and a fault in idle keeps it idle",
            vec![
                Step::Faults(Status::SUPPLY_FAULT),
                Step::Wait(1),
                hello(1, 1, Answer::Identity),
                configure(TERMS, refused(5, 0x80)),
                sent(command_frame, refused(3, 0)),
                stop(Status::SUPPLY_FAULT),
                Step::Faults(Status::default()),
                ready_to_hold(),
                command([1000; 4], ENABLED),
                stop(ENDED | Status::HOLDING),
                Step::Faults(Status::DRIVER_FAULT | Status::SENSOR_FAULT),
                Step::Wait(1),
                NO_TORQUE,
                command([0; 4], ENDED | Status::DRIVER_FAULT | Status::SENSOR_FAULT),
            ],
        ),
    ]
}

fn step_line(step: &Step) -> String {
    let number = |value: u16| value.to_string();
    match step {
        Step::Send(wire, answer) => {
            let mut pairs = vec![("send", hex(wire))];
            let (kind, fields) = match answer {
                None => ("none", vec![]),
                Some(Answer::Identity) => ("Identity", vec![]),
                Some(Answer::Configured(status)) => ("Configured", vec![("status", number(status.0))]),
                Some(Answer::Reply(status)) => ("Reply", vec![("status", number(status.0))]),
                Some(Answer::Stopped(status)) => ("Stopped", vec![("status", number(status.0))]),
                Some(Answer::Refused { reason, detail }) => {
                    ("Refused", vec![("reason", reason.to_string()), ("detail", number(*detail))])
                }
            };
            pairs.push(("answer", text(kind)));
            pairs.extend(fields);
            object(&pairs)
        }
        Step::Wait(milliseconds) => object(&[("wait_ms", milliseconds.to_string())]),
        Step::Faults(faults) => object(&[("faults", number(faults.0))]),
        Step::Torques(torques) => object(&[("torques", list(torques))]),
    }
}

pub fn listed() -> Vec<String> {
    conversations()
        .iter()
        .map(|(name, steps)| {
            let steps: Vec<String> = steps.iter().map(step_line).collect();
            format!("{{\"name\": {}, \"steps\": [\n{}\n]}}", text(name), steps.join(",\n"))
        })
        .collect()
}

/// Whether this is the answer, to a request with this sequence number.
fn check_answer(place: &str, answer: &Answer, sequence: u8, message: &Message) {
    assert_eq!((message.address, message.sequence), (1, sequence), "{place}");
    let known = |status: Status| Status(status.0 & !Status::ZERO_VALID.0);
    match (answer, message.frame) {
        (Answer::Identity, Frame::Identity(_)) => {}
        (Answer::Configured(wanted), Frame::Configured(found)) => assert_eq!(known(found.status), *wanted, "{place}"),
        (Answer::Reply(wanted), Frame::Reply(found)) => assert_eq!(known(found.status), *wanted, "{place}"),
        (Answer::Stopped(wanted), Frame::Stopped(found)) => assert_eq!(known(found.status), *wanted, "{place}"),
        (Answer::Refused { reason, detail }, Frame::Refused(found)) => {
            assert_eq!((found.reason.number(), found.detail), (*reason, *detail), "{place}");
        }
        (_, other) => panic!("{place}: {other:?}"),
    }
}

#[test]
fn the_simulated_board_holds_every_conversation() {
    for (name, steps) in conversations() {
        let mut board = SimulatedBoard::new(&Configuration::default(), &[0]).unwrap();
        let mut now = 0;
        board.advance(now);
        for (number, step) in steps.iter().enumerate() {
            let place = format!("{name}, step {}", number + 1);
            match step {
                Step::Send(wire, answer) => {
                    let mut answers = Vec::new();
                    board.receive(now, wire, &mut |bytes| answers.extend_from_slice(bytes));
                    let mut rest = &answers[..];
                    let mut decoder = Decoder::default();
                    let found = decoder.next(&mut rest).map(|packet| Message::read(&packet).unwrap());
                    match answer {
                        Some(answer) => {
                            let mut request = &wire[..];
                            let sequence = Decoder::default().next(&mut request).unwrap().sequence();
                            check_answer(&place, answer, sequence, &found.expect(&place));
                        }
                        None => assert_eq!(found, None, "{place}"),
                    }
                    assert!(rest.is_empty(), "{place}: more than one answer");
                }
                Step::Wait(milliseconds) => {
                    now += milliseconds * 1_000_000;
                    board.advance(now);
                }
                Step::Faults(faults) => board.finger(1).unwrap().set_faults(*faults),
                Step::Torques(torques) => {
                    let finger = board.finger(1).unwrap();
                    let Frame::Identity(identity) = identity(finger.address(), &mut board) else { unreachable!() };
                    let found = board.finger(1).unwrap().motor_torques();
                    for (found, &wanted) in found.iter().zip(torques) {
                        assert!((found - identity.torque(wanted)).abs() < 1e-9, "{place}");
                    }
                }
            }
        }
    }
}

/// A Hello changes nothing, so it can be asked between any two steps.
fn identity(address: u8, board: &mut SimulatedBoard) -> Frame {
    let mut answers = Vec::new();
    let hello = Frame::Hello(Hello { lowest_version: 1, highest_version: 1 });
    let wire = WireFrame::new(&Message { address, sequence: 0, frame: hello });
    board.receive(0, wire.as_bytes(), &mut |bytes| answers.extend_from_slice(bytes));
    let mut decoder = Decoder::default();
    Message::read(&decoder.next(&mut &answers[..]).unwrap()).unwrap().frame
}

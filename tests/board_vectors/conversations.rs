//! Formats the conversations as lines of protocol/vectors.json, and tests the simulated board with each of them. The
//! conversations follow the state diagram in docs/board-protocol.md.

use super::json::{hex, list, object, text};
use super::scripts::conversations;
use super::steps::{Answer, Step};
use sun2xp::board::protocol::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::simulated::SimulatedBoard;

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

/// Checks that `message` is the expected `answer` to a request with the sequence number `sequence`.
fn check_answer(place: &str, answer: &Answer, sequence: u8, message: &Message) {
    assert_eq!((message.address, message.sequence), (1, sequence), "{place}");
    // A status in a conversation leaves out ZERO_VALID, because this bit depends on the board.
    let without_zero_valid = |status: Status| Status(status.0 & !Status::ZERO_VALID.0);
    match (answer, message.frame) {
        (Answer::Identity, Frame::Identity(_)) => {}
        (Answer::Configured(wanted), Frame::Configured(found)) => {
            assert_eq!(without_zero_valid(found.status), *wanted, "{place}");
        }
        (Answer::Reply(wanted), Frame::Reply(found)) => {
            assert_eq!(without_zero_valid(found.status), *wanted, "{place}");
        }
        (Answer::Stopped(wanted), Frame::Stopped(found)) => {
            assert_eq!(without_zero_valid(found.status), *wanted, "{place}");
        }
        (Answer::Refused { reason, detail }, Frame::Refused(found)) => {
            assert_eq!((found.reason.number(), found.detail), (*reason, *detail), "{place}");
        }
        (_, other) => panic!("{place}: {other:?}"),
    }
}

#[test]
fn the_simulated_board_passes_every_conversation() {
    for (name, steps) in conversations() {
        let mut board = SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).unwrap();
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

/// Returns the answer to a Hello. A Hello changes nothing, so it can be sent between any two steps.
fn identity(address: u8, board: &mut SimulatedBoard) -> Frame {
    let mut answers = Vec::new();
    let hello = Frame::Hello(Hello { lowest_version: 1, highest_version: 1 });
    let wire = WireFrame::new(&Message { address, sequence: 0, frame: hello });
    board.receive(0, wire.as_bytes(), &mut |bytes| answers.extend_from_slice(bytes));
    let mut decoder = Decoder::default();
    Message::read(&decoder.next(&mut &answers[..]).unwrap()).unwrap().frame
}

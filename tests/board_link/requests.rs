//! Tests how a board answers commands for three fingers, and requests that are repeated, damaged, impossible or
//! unknown.

use crate::rig::{board, in_time, link, pull, read, terms};
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::configuration::EndState;
use sun2xp::simulated::*;

#[test]
fn three_fingers_on_one_port_answer_in_the_order_of_their_commands() {
    let mut link = link(&[2, 3, 1]);
    for address in 1..=3 {
        let deadline = in_time(&mut link, 500);
        let (identity, _) = link.shake_hands(address, &terms(EndState::Release), deadline).unwrap();
        assert_eq!(identity.addresses, 0b1110);
    }
    let commands = [1, 2, 3].map(|address| OutgoingCommand { address, sequence: 40 + address, command: pull(1000) });
    link.send(&commands).unwrap();
    for address in 1..=3 {
        let deadline = in_time(&mut link, 1);
        let received = link.receive(deadline).unwrap().expect("a reply");
        assert_eq!((received.address, received.sequence), (address, 40 + address));
    }
    let deadline = in_time(&mut link, 1);
    assert_eq!(link.receive(deadline).unwrap(), None);
    assert_eq!(link.transport().now(), deadline);
}

#[test]
fn duplicates_are_answered_and_damaged_frames_are_only_reported() {
    let mut board = board(&[1]);
    let mut answers = Vec::new();
    let mut send = |board: &mut SimulatedBoard, bytes: &[u8]| {
        answers.clear();
        board.receive(0, bytes, &mut |answer| answers.push(answer.to_vec()));
        answers.iter().map(|answer| read(answer)).collect::<Vec<_>>()
    };
    let wire = |sequence, frame| WireFrame::new(&Message { address: 1, sequence, frame }).as_bytes().to_vec();
    let configure = Configure { version: 1, watchdog_ms: 20, torque_limits: [100; 4], ..Default::default() };
    assert_eq!(send(&mut board, &wire(1, Frame::Configure(configure))).len(), 1);
    let command = wire(7, Frame::Command(pull(50)));
    assert_eq!(send(&mut board, &[command.clone(), command.clone()].concat()).len(), 2);
    let mut damaged = command.clone();
    damaged[5] ^= 0x10;
    assert!(send(&mut board, &damaged).is_empty());
    let status = |messages: &[Message]| match messages {
        [Message { frame: Frame::Reply(reply), .. }] => reply.status,
        other => panic!("not one reply: {other:?}"),
    };
    assert!(status(&send(&mut board, &command)).has(Status::DAMAGED_INPUT));
    assert!(!status(&send(&mut board, &command)).has(Status::DAMAGED_INPUT));
    // Half a frame, followed by a delimiter and a whole frame.
    assert_eq!(send(&mut board, &[&command[..9], &[0], &command[..]].concat()).len(), 1);
    // The board ignores a frame of a type that only boards send, a frame for another finger, and a frame for address 0
    // that is not a Hello.
    assert!(send(&mut board, &wire(1, Frame::Stopped(Stopped::default()))).is_empty());
    let to = |address, frame| WireFrame::new(&Message { address, sequence: 1, frame }).as_bytes().to_vec();
    assert!(send(&mut board, &to(2, Frame::Stop(Stop))).is_empty());
    assert!(send(&mut board, &to(0, Frame::Stop(Stop))).is_empty());
}

#[test]
fn a_board_refuses_what_it_cannot_carry_out() {
    let good = Configure { version: 1, watchdog_ms: 20, torque_limits: [100; 4], ..Default::default() };
    let refusal = |terms: Configure| {
        let mut board = board(&[1]);
        let mut answer = None;
        let message = Message { address: 1, sequence: 5, frame: Frame::Configure(terms) };
        board.receive(0, WireFrame::new(&message).as_bytes(), &mut |bytes| answer = Some(read(bytes)));
        match answer.expect("an answer").frame {
            Frame::Refused(refused) => Some((refused.reason, refused.detail)),
            _ => None,
        }
    };
    assert_eq!(refusal(good), None);
    assert_eq!(refusal(Configure { version: 2, ..good }), Some((Reason::Value, 2)));
    assert_eq!(refusal(Configure { watchdog_ms: 1, ..good }), Some((Reason::Value, 3)));
    assert_eq!(refusal(Configure { torque_limits: [0, 0, 40_000, 0], ..good }), Some((Reason::Value, 14)));
}

#[test]
fn a_board_refuses_what_it_does_not_understand() {
    let mut board = board(&[1]);
    let mut refusal = |content: &[u8]| {
        let mut answer = None;
        let check = check(content).to_le_bytes();
        let mut wire = [0; MAX_WIRE];
        let length = cobs::encode(&[content, &check].concat(), &mut wire) + 1;
        board.receive(0, &wire[..length], &mut |bytes| answer = Some(read(bytes)));
        match answer {
            Some(Message { address: 1, sequence: 77, frame: Frame::Refused(refused) }) => refused,
            other => panic!("{other:?}"),
        }
    };
    // The board refuses versions 2 to 9, an unassigned type, a Hello to address 0 without the highest version, a Stop
    // with a body, and a third end state.
    assert_eq!(refusal(&[0x11, 77, 2, 9]), Refused { request: 1, reason: Reason::Version, detail: 0x0101 });
    assert_eq!(refusal(&[0x71, 77, 1, 2, 3]), Refused { request: 7, reason: Reason::UnknownFrame, detail: 3 });
    assert_eq!(refusal(&[0x10, 77, 1]), Refused { request: 1, reason: Reason::UnknownFrame, detail: 1 });
    assert_eq!(refusal(&[0x41, 77, 0]), Refused { request: 4, reason: Reason::UnknownFrame, detail: 1 });
    let mut configure = vec![0x21, 77, 1, 20, 0, 2];
    configure.resize(34, 0);
    assert_eq!(refusal(&configure), Refused { request: 2, reason: Reason::Value, detail: 5 });
}

//! Frames that a board must ignore: damaged ones, and good ones that are not requests to its finger.

use super::frames::{all_found, sealed, with_check};
use super::json::{hex, object, text};
use super::stuffing::stuffed;
use sun2xp::board::protocol::*;

/// Damaged frames, most of them made from a Command to finger 1. Each has a name, the reason why the receiver drops it,
/// and its bytes on the wire.
fn damaged() -> Vec<(&'static str, &'static str, Vec<u8>)> {
    let content = [0x31, 7, 3, 0xA4, 4, 0x52, 2, 0, 0, 0xFF, 0xFF];
    let good = sealed(&content);
    let changed = |place: usize, value: u8| {
        let mut wire = good.clone();
        wire[place] ^= value;
        wire
    };
    let without = |place: usize| [&good[..place], &good[place + 1..]].concat();
    let mut wrong_check = with_check(&content);
    wrong_check[content.len()] ^= 0x80;
    let swapped: Vec<u8> = content.iter().copied().chain(check(&content).to_be_bytes()).collect();
    let unfinished = |initial: u32| {
        // The CRC without its final exclusive-or.
        let frame: Vec<u8> = content.iter().copied().chain((check(&content) ^ initial).to_le_bytes()).collect();
        stuffed(&frame)
    };
    vec![
        ("one bit of a torque", "check", changed(4, 0x10)),
        ("one bit of the sequence number", "check", changed(2, 1)),
        ("one bit of the check", "check", stuffed(&wrong_check)),
        ("the check in the other byte order", "check", stuffed(&swapped)),
        ("the check without its last exclusive-or", "check", unfinished(u32::MAX)),
        ("a check of zero", "check", stuffed(&[&content[..], &[0; 4]].concat())),
        ("a byte lost", "check", without(5)),
        ("a byte doubled", "check", [&good[..5], &good[4..]].concat()),
        ("cut short by a delimiter", "check", [&good[..9], &[0]].concat()),
        ("two frames without the delimiter between them", "check", [&good[..good.len() - 1], &good[..]].concat()),
        ("the first distance lost", "stuffing", without(0)),
        ("a distance beyond the end", "stuffing", vec![9, 0x41, 3, 0]),
        ("a distance beyond the end of a whole frame", "stuffing", changed(0, 0x40)),
        ("nothing but a distance", "short", vec![1, 0]),
        ("one byte", "short", vec![2, 0x41, 0]),
        ("five bytes, of which four are their check", "short", sealed(&[0x41])),
        ("four bytes, the check of nothing", "short", sealed(&[])),
        ("129 bytes whose check is right", "long", sealed(&[0x41; 125])),
        ("200 bytes whose check is right", "long", sealed(&[0x41; 196])),
        ("300 bytes without a zero", "long", [vec![0x55; 300], vec![0]].concat()),
        ("half a Stop, then half a Command", "stuffing", [&sealed(&[0x41, 3])[..4], &good[8..]].concat()),
        ("text", "stuffing", b"login: \0".to_vec()),
    ]
}

pub fn bad() -> Vec<String> {
    let line = |(name, reason, wire): (&str, &str, Vec<u8>)| {
        object(&[("reason", text(reason)), ("name", text(name)), ("wire", hex(&wire))])
    };
    damaged().into_iter().map(line).collect()
}

/// Frames, and delimiters without a frame, that a board whose only finger is 1 must ignore.
fn not_for_finger_1() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("a Stop for finger 2", sealed(&[0x42, 1])),
        ("a Hello for finger 15", sealed(&[0x1F, 1, 1, 1])),
        ("a Stop for address 0", sealed(&[0x40, 1])),
        ("a Command for address 0", sealed(&[0x30, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0])),
        ("an unknown type for finger 2", sealed(&[0x72, 1, 9])),
        ("a Stopped, which is an answer", sealed(&[0xC1, 1, 0, 0])),
        ("a Refused, which is an answer", sealed(&[0xD1, 1, 3, 3, 0, 0])),
        ("a free type with the top bit set", sealed(&[0xF1, 1])),
        ("a delimiter", vec![0]),
        ("three delimiters", vec![0; 3]),
    ]
}

pub fn ignored() -> Vec<String> {
    let line = |(name, wire): (&str, Vec<u8>)| object(&[("name", text(name)), ("wire", hex(&wire))]);
    not_for_finger_1().into_iter().map(line).collect()
}

#[test]
fn bad_frames_are_dropped_and_counted_and_cost_no_other_frame() {
    let next = Message { address: 1, sequence: 8, frame: Frame::Stop(Stop) };
    for (name, _, wire) in damaged() {
        let mut decoder = Decoder::default();
        assert_eq!(all_found(&mut decoder, &wire), [], "{name}");
        assert_eq!(decoder.counters().damaged, 1, "{name}");
        assert_eq!(all_found(&mut decoder, WireFrame::new(&next).as_bytes()), [next], "{name}");
    }
}

#[test]
fn reasons_are_correct() {
    for (name, reason, wire) in damaged() {
        let mut frame = [0; 512];
        let stuffed = &wire[..wire.len() - 1];
        let length = cobs::decode(stuffed, &mut frame).map(|report| report.frame_size());
        let found = match length {
            _ if stuffed.len() > MAX_WIRE - 1 => "long",
            Err(_) => "stuffing",
            Ok(0..6) => "short",
            Ok(length) => match Packet::checked(&frame[..length]) {
                None => "check",
                Some(_) => "none",
            },
        };
        assert_eq!(found, reason, "{name}");
    }
}

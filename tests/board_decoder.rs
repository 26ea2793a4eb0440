//! Tests the decoder against anything that a cable can deliver.

#[path = "board_vectors/stuffing.rs"]
mod stuffing;

use proptest::prelude::*;
use stuffing::stuffed;
use sun2xp::board::protocol::*;

/// Encodes a frame as docs/board-protocol.md describes it, independently of the library: a bitwise checksum, and
/// stuffing by splitting at zeros.
fn sealed(content: &[u8]) -> Vec<u8> {
    let mut register = u32::MAX;
    for &byte in content {
        register ^= u32::from(byte);
        for _ in 0..8 {
            register = register >> 1 ^ if register & 1 == 1 { 0xEDB8_8320 } else { 0 };
        }
    }
    stuffed(&[content, &(!register).to_le_bytes()].concat())
}

/// Header, sequence number and body of every frame found when the stream arrives `chunk` bytes at a time.
fn decoded(decoder: &mut Decoder, stream: &[u8], chunk: usize) -> Vec<Vec<u8>> {
    let mut found = Vec::new();
    for mut bytes in stream.chunks(chunk.max(1)) {
        while let Some(packet) = decoder.next(&mut bytes) {
            let prefix = [packet.kind() << 4 | packet.address(), packet.sequence()];
            found.push([&prefix, packet.body()].concat());
        }
    }
    found
}

fn content() -> impl Strategy<Value = Vec<u8>> {
    // Many zeros, as in real frames, so that the stuffing is exercised.
    prop::collection::vec(prop_oneof![1 => Just(0u8), 2 => any::<u8>()], 2..=MAX_FRAME - 4)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases.max(2000)))]

    #[test]
    fn whole_frames_are_found_in_any_pieces(contents in prop::collection::vec(content(), 1..5), chunk in 1usize..40) {
        let stream: Vec<u8> = contents.iter().flat_map(|content| sealed(content)).collect();
        let mut decoder = Decoder::default();
        prop_assert_eq!(&decoded(&mut decoder, &stream, chunk), &contents);
        let counters = decoder.counters();
        prop_assert_eq!((counters.frames, counters.damaged), (contents.len() as u64, 0));
        prop_assert_eq!(counters.bytes, stream.len() as u64);
    }

    #[test]
    fn the_decoder_survives_any_stream_and_finds_the_next_frame(
        rubbish in prop::collection::vec(any::<u8>(), 0..600), content in content(), chunk in 1usize..40
    ) {
        let mut decoder = Decoder::default();
        // One in four thousand million random frames passes the checksum. None does here.
        prop_assert!(decoded(&mut decoder, &rubbish, chunk).is_empty());
        // The first frame may be lost, because the rubbish need not end with a delimiter.
        let stream = [sealed(&content), sealed(&content)].concat();
        let found = decoded(&mut decoder, &stream, chunk);
        prop_assert_eq!(found.last(), Some(&content));
    }

    #[test]
    fn damage_is_found(
        content in content(),
        hits in prop::collection::vec((any::<prop::sample::Index>(), 1u8..), 1..4),
    ) {
        let good = sealed(&content);
        let mut bad = good.clone();
        for (place, change) in hits {
            let place = place.index(bad.len());
            bad[place] ^= change;
        }
        prop_assume!(bad != good);
        let mut decoder = Decoder::default();
        prop_assert!(decoded(&mut decoder, &bad, 64).is_empty());
        // The delimiter ends any open frame, so the next frame is complete.
        bad = [&[0], &good[..]].concat();
        prop_assert_eq!(decoded(&mut decoder, &bad, 64), vec![content]);
        prop_assert!(decoder.counters().damaged >= 1);
    }

    #[test]
    fn a_byte_lost_or_doubled_is_found(content in content(), place in any::<prop::sample::Index>(), doubled: bool) {
        let mut stream = sealed(&content);
        // `place` is never the last byte, which is the delimiter. A doubled delimiter is harmless.
        let place = place.index(stream.len() - 1);
        if doubled {
            stream.insert(place, stream[place]);
        } else {
            stream.remove(place);
        }
        prop_assert!(decoded(&mut Decoder::default(), &stream, 64).is_empty());
    }

    #[test]
    fn every_frame_is_read_as_it_was_written(
        address in 0u8..16, sequence: u8, kind in prop::sample::select(&Kind::ALL[..]),
        body in prop::collection::vec(any::<u8>(), MAX_FRAME)
    ) {
        let content = [&[(kind as u8) << 4 | address, sequence], &body[..kind.body_length()]].concat();
        let mut decoder = Decoder::default();
        let wire = sealed(&content);
        let mut bytes = &wire[..];
        let packet = decoder.next(&mut bytes).expect("whole");
        if let Ok(message) = Message::read(&packet) {
            prop_assert_eq!((message.address, message.sequence, message.frame.kind()), (address, sequence, kind));
            let again = WireFrame::new(&message);
            prop_assert_eq!(again.as_bytes().len(), wire.len());
            // The flags of a Command have reserved bits, which are dropped. All other frames must be encoded to the
            // same bytes again.
            if kind != Kind::Command {
                prop_assert_eq!(again.as_bytes(), &wire[..]);
            }
        } else {
            // Only an undefined number of the end state makes an undamaged frame unreadable.
            prop_assert!(matches!(kind, Kind::Configure | Kind::Configured) && body[3] > 1);
        }
    }
}

#[test]
fn frames_of_other_types_and_lengths_are_told_apart() {
    let read = |content: &[u8]| {
        let mut decoder = Decoder::default();
        Message::read(&decoder.next(&mut &sealed(content)[..]).unwrap())
    };
    assert_eq!(read(&[0xF1, 0, 1, 2, 3]), Err(Malformed::UnknownKind(0xF)));
    assert_eq!(read(&[0x41, 0, 9]), Err(Malformed::Length { kind: Kind::Stop, expected: 0, found: 1 }));
}

#[test]
fn encoder_counts_wrap() {
    let reply = |encoders| Reply { encoders, ..Reply::default() };
    let before = [32_767, -1, i32::MAX, 65_536];
    assert_eq!(reply([32_768, 0, 0, 65_535]).counts_after(before), [32_768, 0, i32::MIN, 65_535]);
    assert_eq!(reply([0, 0x8000, 0xFFFE, 100]).counts_after([0; 4]), [0, -32_768, -2, 100]);
}

//! Random and mutated byte streams for the decoder: it must not panic, must accept nothing that was not sent
//! completely, and must find the next frame.
//!
//! `SUN2XP_STREAMS=10000000 cargo test --test board_streams -- --nocapture` runs ten million of them.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::board::protocol::{Command, Decoder, Frame, Message, Reply, WireFrame};

struct Dice(Pcg64);

impl Dice {
    /// Returns a random number from 0 to `sides` - 1.
    fn throw(&mut self, sides: u64) -> usize {
        (self.0.next_u64() >> 16) as usize % sides as usize
    }

    fn frame(&mut self) -> Vec<u8> {
        let bits = self.0.next_u64();
        let parts = [bits as u16, (bits >> 16) as u16, (bits >> 32) as u16, (bits >> 48) as u16];
        let frame = match self.throw(2) {
            0 => Frame::Command(Command { toggle: bits & 1 == 0, enable: true, torques: parts.map(u16::cast_signed) }),
            _ => Frame::Reply(Reply { encoders: parts, gauges: parts, ..Reply::default() }),
        };
        let message = Message { address: 1 + self.throw(15) as u8, sequence: bits as u8, frame };
        WireFrame::new(&message).as_bytes().to_vec()
    }

    /// Random bytes, or frames with up to three errors: a byte changed, inserted or removed, the end cut off, or the
    /// bytes rotated.
    fn stream(&mut self) -> Vec<u8> {
        if self.throw(3) == 0 {
            let length = self.throw(80);
            return (0..length).map(|_| (self.0.next_u64() >> 24) as u8).collect();
        }
        let count = 1 + self.throw(3);
        let mut stream: Vec<u8> = (0..count).flat_map(|_| self.frame()).collect();
        for _ in 0..self.throw(4) {
            let place = self.throw(stream.len() as u64);
            let byte = (self.0.next_u64() >> 24) as u8;
            match self.throw(6) {
                0 => stream[place] ^= 1 << (byte % 8),
                1 => stream[place] = byte,
                2 => stream.insert(place, byte),
                3 => stream.truncate(place.max(1)),
                4 => stream.rotate_left(place),
                _ => drop((stream.len() > 1).then(|| stream.remove(place))),
            }
        }
        stream
    }
}

fn contains(stream: &[u8], part: &[u8]) -> bool {
    stream.windows(part.len()).any(|window| window == part)
}

#[test]
fn nothing_is_accepted_that_was_not_sent_and_the_next_frame_is_found() {
    let streams: u64 = std::env::var("SUN2XP_STREAMS").map_or(100_000, |streams| streams.parse().expect("a number"));
    let mut dice = Dice(Pcg64::seed_from_u64(5));
    let (mut accepted, mut bytes) = (0u64, 0u64);
    for _ in 0..streams {
        let stream = dice.stream();
        let mut decoder = Decoder::default();
        let mut left = &stream[..];
        while !left.is_empty() {
            let Some(packet) = decoder.next(&mut left) else { continue };
            accepted += 1;
            if let Ok(message) = Message::read(&packet) {
                // A frame whose checksum holds must occur in the stream exactly as it would be sent.
                let wire = WireFrame::new(&message);
                assert!(contains(&stream, wire.as_bytes()), "{message:?} from {stream:02x?}");
            }
        }
        bytes += stream.len() as u64;
        // If the stream ends within a frame, the next frame may be lost, but no further one.
        let frame = dice.frame();
        let after = [&frame[..], &frame[..]].concat();
        let mut found = 0;
        let mut left = &after[..];
        while !left.is_empty() {
            found += u32::from(decoder.next(&mut left).is_some());
        }
        assert!(found >= 1, "no frame after {stream:02x?}");
    }
    println!("{streams} streams, {bytes} bytes, {accepted} frames accepted, each as it was sent");
    assert!(accepted > streams / 10);
}

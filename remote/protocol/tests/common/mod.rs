//! Random and damaged payloads.

use std::path::Path;
use sun2xp_remote_protocol::{Answer, Event, Request, State, Status, Target};

/// A small generator of random numbers (SplitMix64).
pub struct Noise(pub u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }

    /// Writes random bytes, or one of the messages with damage: changed bytes, a wrong length, or a part of another
    /// message.
    pub fn payload(&mut self, messages: &[Vec<u8>], payload: &mut Vec<u8>) {
        payload.clear();
        let message = &messages[self.below(messages.len())];
        match self.below(8) {
            0 => (0..self.below(400)).for_each(|_| payload.push(self.next() as u8)),
            // Random fields behind a good type and version.
            1 => {
                payload.extend_from_slice(&message[..2]);
                (2..message.len()).for_each(|_| payload.push(self.next() as u8));
            }
            2 => payload.extend_from_slice(&message[..self.below(message.len() + 1)]),
            3 => {
                payload.extend_from_slice(message);
                (0..1 + self.below(64)).for_each(|_| payload.push(self.next() as u8));
            }
            4 => {
                let other = &messages[self.below(messages.len())];
                payload.extend_from_slice(&message[..self.below(message.len() + 1)]);
                payload.extend_from_slice(&other[self.below(other.len() + 1)..]);
            }
            _ => {
                payload.extend_from_slice(message);
                for _ in 0..1 + self.below(4) {
                    let at = self.below(payload.len());
                    payload[at] = if self.below(2) == 0 { self.next() as u8 } else { payload[at] ^ 1 << self.below(8) };
                }
            }
        }
    }
}

/// Decodes a payload as every type. Returns whether one of them accepts it. A message that is accepted must encode to a
/// payload of the same length.
pub fn decode_every_kind(payload: &[u8]) -> bool {
    [
        Target::decode(payload).ok().map(|message| (message.encode(), "Target")),
        State::decode(payload).ok().map(|message| (message.encode(), "State")),
        Event::decode(payload).ok().map(|message| (message.encode(), "Event")),
        Status::decode(payload).ok().map(|message| (message.encode(), "Status")),
        Request::decode(payload).ok().map(|message| (message.encode(), "Request")),
        Answer::decode(payload).ok().map(|message| (message.encode(), "Answer")),
    ]
    .into_iter()
    .flatten()
    .inspect(|(encoded, kind)| {
        let encoded = encoded.as_ref().expect("what can be decoded can be encoded");
        assert_eq!(encoded.len(), payload.len(), "{kind} {payload:x?}");
    })
    .count()
        > 0
}

/// The good messages of remote/vectors.json.
pub fn messages() -> Vec<Vec<u8>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../vectors.json");
    let file = std::fs::read_to_string(path).expect("remote/vectors.json can be read");
    let vectors: serde_json::Value = serde_json::from_str(&file).expect("JSON");
    let pair = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).expect("ASCII"), 16).expect("hex");
    let payload =
        |vector: &serde_json::Value| vector["payload"].as_str().expect("hex").as_bytes().chunks(2).map(pair).collect();
    vectors["messages"].as_array().expect("messages").iter().map(payload).collect()
}

//! Payloads that no server may take as a Target: noise, and good Targets that are spoiled in one of many ways.

use super::raw::joints;
use super::shaper::Random;
use sun2xp_remote_protocol::{Place, Target};

/// Offsets of fields in a Target and in its first part, from docs/remote-protocol.md.
const COUNT: usize = 2;
const VALIDITY: usize = 4;
const EPOCH: usize = 8;
const SEQUENCE: usize = 16;
const SEEN: usize = 32;
const PART: usize = 40;
const PLACE: usize = PART + 1;
const POSES: usize = PART + 3;
const COMMAND: usize = PART + 4;
const ANGLES: usize = PART + 8;
const KX: usize = PART + 32;

/// A source of payloads. Equal seeds give equal payloads.
pub struct Noise {
    random: Random,
    /// The command number that [`Noise::good`] used last. If a test sends a Target that the server should take, the
    /// Target has a smaller command number.
    command: u32,
}

impl Noise {
    pub fn new(seed: u64) -> Self {
        Self { random: Random(seed), command: 1_000_000 }
    }

    /// Returns the next payload. `next` is a Target that the server would take: fresh, without parts, and with the
    /// epoch in force. `newest` is the sequence number of the newest Target that the server has taken.
    pub fn payload(&mut self, next: &Target, newest: u64) -> Vec<u8> {
        match self.random.below(5) {
            0 => self.bytes(700),
            1 => self.with_a_good_beginning(),
            2 => self.of_another_epoch(next),
            3 => self.replayed(next, newest),
            _ => self.spoiled(next),
        }
    }

    fn bytes(&mut self, most: usize) -> Vec<u8> {
        let length = self.random.below(most);
        (0..length).map(|_| self.random.bits() as u8).collect()
    }

    /// A correct type and version, a number of parts, and then noise.
    fn with_a_good_beginning(&mut self) -> Vec<u8> {
        [vec![1, 1, self.random.below(5) as u8, 0], self.bytes(500)].concat()
    }

    /// A Target that moves a finger, and would be taken.
    fn good(&mut self, next: &Target) -> Vec<u8> {
        self.command += 1;
        let mut part = joints(1 + self.random.below(3) as i32, self.command, [0.2, 0.8, 0.7]);
        part.stiffness = Some([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]);
        if self.random.below(4) == 0 {
            part.place = Place::Tip([1.0, 2.0, 6.0]);
        }
        Target { parts: vec![part], ..next.clone() }.encode().expect("a good Target")
    }

    /// Changes up to eight bits outside the field `kept`. This field is the reason why the server must drop the Target.
    fn flip(&mut self, payload: &mut [u8], kept: std::ops::Range<usize>) {
        for _ in 0..self.random.below(9) {
            let at = self.random.below(payload.len());
            if !kept.contains(&at) {
                payload[at] ^= 1 << self.random.below(8);
            }
        }
    }

    fn of_another_epoch(&mut self, next: &Target) -> Vec<u8> {
        let mut payload = self.good(next);
        let epoch = next.epoch ^ (self.random.bits() | 1);
        payload[EPOCH..SEQUENCE].copy_from_slice(&epoch.to_le_bytes());
        self.flip(&mut payload, EPOCH..SEQUENCE);
        payload
    }

    fn replayed(&mut self, next: &Target, newest: u64) -> Vec<u8> {
        let mut payload = self.good(next);
        let sequence = self.random.below(newest as usize + 1) as u64;
        payload[SEQUENCE..SEQUENCE + 8].copy_from_slice(&sequence.to_le_bytes());
        self.flip(&mut payload, SEQUENCE..SEQUENCE + 8);
        payload
    }

    /// A Target with the epoch in force. Either it has a field that the protocol or the hand does not allow, or its end
    /// is missing.
    fn spoiled(&mut self, next: &Target) -> Vec<u8> {
        let mut payload = self.good(next);
        let number = |payload: &mut Vec<u8>, at: usize, value: f64| {
            payload[at..at + 8].copy_from_slice(&value.to_le_bytes());
        };
        let far = 100.0 + 1e6 * self.random.fraction();
        let axis = self.random.below(3);
        match self.random.below(12) {
            0 => payload[COUNT] = 2 + self.random.below(254) as u8,
            1 => payload[VALIDITY..EPOCH].fill(if self.random.below(2) == 0 { 0 } else { 0xFF }),
            2 => payload[SEEN..PART].fill(0xFF),
            3 => payload[PART] = 4 + self.random.below(252) as u8,
            4 => payload[PLACE] = 4 + self.random.below(252) as u8,
            5 => payload[POSES] = 1 + self.random.below(255) as u8,
            6 => payload[COMMAND..ANGLES].fill(0),
            7 => number(&mut payload, ANGLES + 8 * axis, f64::NAN),
            8 => number(&mut payload, ANGLES + 8 * axis, if self.random.below(2) == 0 { far } else { -far }),
            // Case 9 makes Kx asymmetric, and case 10 makes a diagonal element too stiff.
            9 => number(&mut payload, KX + 8, 0.5),
            10 => number(&mut payload, KX + 32 * axis, 1e4 * far),
            _ => {
                let length = self.random.below(payload.len());
                payload.truncate(length);
            }
        }
        payload
    }
}

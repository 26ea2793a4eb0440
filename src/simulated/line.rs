//! One direction of a simulated cable. It receives frames, and delivers them as its faults permit. The same seed gives
//! the same result.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::collections::VecDeque;

/// A fault of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineFault {
    /// A frame is lost.
    Drop,
    /// One bit of a frame is inverted.
    Corrupt,
    /// A frame is delayed by this time, ns. Later frames may overtake it.
    Delay(u64),
    /// A frame arrives twice.
    Duplicate,
    /// A frame arrives after the one that follows it.
    Reorder,
    /// No frame arrives until the fault ends. Then all frames that were held up arrive at once.
    Stall,
}

/// The last byte of every frame.
pub(super) const DELIMITER: u8 = 0;

/// A fault that occurs at random for a limited time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Injected {
    fault: LineFault,
    /// Probability for each frame, 0 to 1.
    probability: f64,
    /// End of the fault, ns.
    until: u64,
}

/// A frame on its way.
#[derive(Clone, Debug)]
struct Waiting {
    due: u64,
    bytes: Vec<u8>,
}

/// One direction of a cable.
#[derive(Debug)]
pub(super) struct SimulatedLine {
    injected: Vec<Injected>,
    random: Pcg64,
    waiting: VecDeque<Waiting>,
    /// The frame that arrives after the next one.
    held: Option<Vec<u8>>,
    /// The bytes of an incomplete frame.
    begun: Vec<u8>,
}

impl SimulatedLine {
    pub fn new() -> Self {
        Self {
            injected: Vec::new(),
            random: Pcg64::seed_from_u64(0),
            waiting: VecDeque::new(),
            held: None,
            begun: Vec::new(),
        }
    }

    /// Applies a fault to each frame with this probability. The fault ends at the time `until`, ns. A stall ignores the
    /// probability. `seed` restarts the random numbers.
    pub fn inject(&mut self, fault: LineFault, probability: f64, until: u64, seed: u64) {
        self.random = Pcg64::seed_from_u64(seed);
        self.injected.push(Injected { fault, probability, until });
    }

    /// Removes all faults. Frames that are still delayed become due at once.
    pub fn clear(&mut self) {
        self.injected.clear();
        self.waiting.iter_mut().for_each(|waiting| waiting.due = 0);
    }

    /// Discards everything that is on its way.
    pub fn cut(&mut self) {
        self.waiting.clear();
        self.begun.clear();
        self.held = None;
    }

    /// Transports the bytes of consecutive frames, in pieces of any size, at `now`, ns. Apart from that, it does the
    /// same as [`SimulatedLine::carry`].
    pub fn carry_bytes(&mut self, now: u64, bytes: &[u8], deliver: &mut dyn FnMut(&[u8])) {
        if self.begun.is_empty() && self.is_good(now) {
            return deliver(bytes);
        }
        for &byte in bytes {
            self.begun.push(byte);
            if byte == DELIMITER {
                let frame = std::mem::take(&mut self.begun);
                self.carry(now, &frame, deliver);
            }
        }
    }

    fn is_good(&mut self, now: u64) -> bool {
        self.injected.retain(|injected| injected.until > now);
        self.injected.is_empty() && self.held.is_none() && self.waiting.is_empty()
    }

    /// Transports a frame at `now`, ns, and passes every frame that has arrived by then to `deliver`.
    pub fn carry(&mut self, now: u64, frame: &[u8], deliver: &mut dyn FnMut(&[u8])) {
        if self.is_good(now) {
            return deliver(frame);
        }
        let mut bytes = frame.to_vec();
        let (mut copies, mut due, mut hold) = (1, now, false);
        for index in 0..self.injected.len() {
            let Injected { fault, probability, until } = self.injected[index];
            let hit = f64::from(self.random.next_u32()) < probability * 4_294_967_296.0;
            match fault {
                LineFault::Stall => due = due.max(until),
                _ if !hit => {}
                LineFault::Drop => copies = 0,
                LineFault::Corrupt => {
                    let bit = self.random.next_u32() as usize % (8 * bytes.len().max(1));
                    bytes.iter_mut().skip(bit / 8).take(1).for_each(|byte| *byte ^= 1 << (bit % 8));
                }
                LineFault::Delay(time) => due = due.max(now.saturating_add(time)),
                LineFault::Duplicate => copies *= 2,
                LineFault::Reorder => hold = self.held.is_none(),
            }
        }
        if hold && copies > 0 {
            self.held = Some(bytes);
        } else {
            for _ in 0..copies {
                self.waiting.push_back(Waiting { due, bytes: bytes.clone() });
            }
            if let Some(held) = self.held.take() {
                self.waiting.push_back(Waiting { due, bytes: held });
            }
        }
        self.arrive(now, deliver);
    }

    /// Passes everything that has arrived by `now`, ns, to `deliver`, in the order of arrival.
    pub fn arrive(&mut self, now: u64, deliver: &mut dyn FnMut(&[u8])) {
        while let Some(index) = self.next().filter(|&index| self.waiting[index].due <= now) {
            if let Some(frame) = self.waiting.remove(index) {
                deliver(&frame.bytes);
            }
        }
    }

    /// Returns when the next frame arrives, ns.
    pub fn next_arrival(&self) -> Option<u64> {
        self.next().map(|index| self.waiting[index].due)
    }

    /// Returns the index of the frame that arrives next. Of frames due at the same time, it is the first.
    fn next(&self) -> Option<usize> {
        (0..self.waiting.len()).min_by_key(|&index| self.waiting[index].due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sends one byte per microsecond through a line, and returns each byte that arrives, with the time of its arrival.
    fn out(line: &mut SimulatedLine, bytes: u8) -> Vec<(u64, u8)> {
        let mut came = Vec::new();
        for byte in 0..bytes {
            let now = 1000 * u64::from(byte);
            line.arrive(now, &mut |frame| came.push((now, frame[0])));
            line.carry(now, &[byte], &mut |frame| came.push((now, frame[0])));
        }
        came
    }

    fn bytes(came: &[(u64, u8)]) -> Vec<u8> {
        came.iter().map(|&(_, byte)| byte).collect()
    }

    #[test]
    fn a_line_without_faults_delivers_everything_at_once() {
        let came = out(&mut SimulatedLine::new(), 5);
        assert_eq!(came, [(0, 0), (1000, 1), (2000, 2), (3000, 3), (4000, 4)]);
    }

    #[test]
    fn each_fault_has_its_effect_until_its_end() {
        let with = |fault| {
            let mut line = SimulatedLine::new();
            line.inject(fault, 1.0, 2000, 1);
            out(&mut line, 4)
        };
        assert_eq!(bytes(&with(LineFault::Drop)), [2, 3]);
        assert_eq!(bytes(&with(LineFault::Duplicate)), [0, 0, 1, 1, 2, 3]);
        assert_eq!(with(LineFault::Delay(1500)), [(2000, 0), (2000, 2), (3000, 1), (3000, 3)]);
        assert_eq!(with(LineFault::Stall), [(2000, 0), (2000, 1), (2000, 2), (3000, 3)]);
        assert_eq!(bytes(&with(LineFault::Reorder))[..2], [1, 0]);
        let corrupt = with(LineFault::Corrupt);
        assert!((0..2).all(|place| (corrupt[place].1 ^ place as u8).count_ones() == 1), "{corrupt:?}");
        assert_eq!(bytes(&corrupt)[2..], [2, 3]);
    }

    #[test]
    fn a_delay_without_end_delivers_nothing() {
        let mut line = SimulatedLine::new();
        line.inject(LineFault::Delay(u64::MAX), 1.0, u64::MAX, 1);
        assert_eq!(out(&mut line, 4), []);
    }

    #[test]
    fn bytes_are_split_into_frames_at_delimiters() {
        let mut line = SimulatedLine::new();
        let mut came = Vec::new();
        let mut put = |line: &mut SimulatedLine, now: u64, bytes: &[u8]| {
            line.carry_bytes(now, bytes, &mut |piece| came.push(piece.to_vec()));
        };
        // A line without faults delivers incomplete frames too.
        put(&mut line, 0, &[1, 0, 2]);
        line.inject(LineFault::Duplicate, 1.0, 3000, 1);
        for (now, bytes) in [(1000, &[0, 3, 4, 0, 5][..]), (2000, &[6]), (4000, &[0, 7, 0])] {
            put(&mut line, now, bytes);
        }
        let expected: [&[u8]; 7] = [&[1, 0, 2], &[0], &[0], &[3, 4, 0], &[3, 4, 0], &[5, 6, 0], &[7, 0]];
        assert_eq!(came, expected);
    }

    #[test]
    fn the_same_seed_gives_the_same_losses() {
        let lossy = |seed| {
            let mut line = SimulatedLine::new();
            line.inject(LineFault::Drop, 0.5, u64::MAX, seed);
            bytes(&out(&mut line, 100))
        };
        assert_eq!(lossy(3), lossy(3));
        assert_ne!(lossy(3), lossy(4));
        assert!((30..70).contains(&lossy(3).len()));
    }
}

//! Converts events to and from words, because the log stores them in atomic words.

use super::{Event, EventKind};
use crate::model::{FingerNumber, Part};

/// Number of words of an event.
pub(super) const WORDS: usize = 7;

impl Event {
    /// Returns the event in words.
    pub(super) fn to_words(self) -> [u64; WORDS] {
        let (kind_of_part, number) = match self.part {
            Part::Finger => (0, 0),
            Part::Joint(number) => (1, number),
            Part::Tendon(number) => (2, number),
            Part::Motor(number) => (3, number),
            Part::Gauge(number) => (4, number),
            Part::Encoder(number) => (5, number),
        };
        let finger = self.finger.index() as u8;
        let place = u64::from(u32::from_le_bytes([finger, self.kind.number(), kind_of_part, number]));
        let [first, second, third, fourth] = self.values.map(f64::to_bits);
        [place, self.cycle, self.time, first, second, third, fourth]
    }

    /// Returns the event with these words; none if no event has them.
    pub(super) fn from_words(words: &[u64; WORDS]) -> Option<Self> {
        let [finger, kind, kind_of_part, number] = (words[0] as u32).to_le_bytes();
        let part = match kind_of_part {
            0 => Part::Finger,
            1 => Part::Joint(number),
            2 => Part::Tendon(number),
            3 => Part::Motor(number),
            4 => Part::Gauge(number),
            5 => Part::Encoder(number),
            _ => return None,
        };
        Some(Self {
            finger: *FingerNumber::ALL.get(usize::from(finger))?,
            cycle: words[1],
            time: words[2],
            kind: EventKind::from_number(kind)?,
            part,
            values: [words[3], words[4], words[5], words[6]].map(f64::from_bits),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_event_survives_the_conversion_to_words() {
        let parts = [Part::Finger, Part::joint(2), Part::tendon(3), Part::motor(0), Part::gauge(1), Part::encoder(2)];
        for (&kind, part) in EventKind::ALL.iter().zip(parts.into_iter().cycle()) {
            let event = Event {
                finger: FingerNumber::TWO,
                cycle: u64::MAX,
                time: 7,
                kind,
                part,
                values: [f64::MIN, -0.0, f64::INFINITY, 1e-300],
            };
            assert_eq!(Event::from_words(&event.to_words()), Some(event));
        }
        assert_eq!(Event::from_words(&[u64::MAX; WORDS]), None);
    }
}

//! Configurations for programs that provide the hardware of some fingers. The ports and boards of these fingers are
//! ignored, and are not checked against those of the other fingers.

use super::text::{Said, parse_with};
use super::wrong::Wrong;
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, ConfiguredFinger, FINGERS};

/// The fingers whose hardware the program provides. The default is no finger.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct FingersWithIo([bool; FINGERS]);

impl FingersWithIo {
    /// Selects the fingers that have hardware. `hardware` is the hardware of fingers 1, 2 and 3.
    pub fn of<T>(hardware: &[Option<T>; FINGERS]) -> Self {
        Self(hardware.each_ref().map(Option::is_some))
    }

    /// Returns the fingers whose hardware the program provides in an open hand with this configuration.
    pub fn of_open_hand(configuration: &Configuration) -> Self {
        Self(configuration.fingers.each_ref().map(ConfiguredFinger::has_io))
    }

    /// Returns the fingers that are in at least one of the two selections.
    pub fn and(self, other: Self) -> Self {
        Self(std::array::from_fn(|finger| self.0[finger] || other.0[finger]))
    }

    /// Reads and checks the text of a configuration file.
    pub(super) fn parse(self, text: &str) -> Result<(Configuration, Said), Wrong> {
        parse_with(text, None, &|number: FingerNumber, finger: &mut ConfiguredFinger| {
            let provided = self.0[number.index()];
            if provided {
                finger.provide(number);
            }
            provided
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Finger 1 has hardware of the program.
    fn first() -> FingersWithIo {
        FingersWithIo::of(&[Some(()), None, None])
    }

    #[test]
    fn the_port_of_a_finger_with_hardware_of_the_program_is_not_checked() {
        let shared = "[hand]\nfingers = [1, 2]\n[finger]\nport = '/dev/a'\n";
        let missing = "[finger.2]\nport = '/dev/a'\n[finger.3]\nport = '/dev/b'\n";
        let board = "[hand]\nfingers = [1]\n[finger]\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n";
        for text in [shared, missing, board, "", "[finger.3]\nport = 'simulated'\n"] {
            let (hand, _) = first().parse(text).unwrap_or_else(|wrong| panic!("{text}: {wrong}"));
            assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::has_io), [true, false, false]);
            assert_eq!(hand.fingers[0].board, None);
        }
        for text in [shared, missing] {
            assert!(FingersWithIo::default().parse(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_ports_of_the_other_fingers_are_checked() {
        let text = "[finger.2]\nport = '/dev/a'\n";
        let refusal = first().parse(text).expect_err("finger 3 has no port").to_string();
        assert!(refusal.contains("finger.3.port: is missing"), "{refusal}");
    }
}

//! The configurations of simulated hands and boards.

use super::text::{Said, parse_with};
use super::{Configured, invalid_text, parse_configuration};
use crate::hand::ConfigurationError;
use crate::model::FingerNumber;
use crate::model::configuration::{ConfiguredFinger, FINGERS};
use std::path::Path;
use toml_edit::Value;

impl Configured {
    /// Reads and checks the configuration of a simulated hand with this name and this rate, Hz. `text` has further keys
    /// of the configuration. Its keys `simulation.hand`, `hand.rate`, `port` and `board` and its table `remote` have no
    /// effect.
    ///
    /// # Errors
    /// Returns [`ConfigurationError::Invalid`] if there is no such name or rate, or if the text is wrong.
    pub fn simulated(name: &str, rate: f64, text: &str) -> Result<Self, ConfigurationError> {
        // Name and rate are checked as a text of their own, so that an error names their key.
        let (named, at_rate) = (Value::from(name), Value::from(rate));
        parse_configuration(&format!("hand.rate = {at_rate}\n[finger.simulation]\nhand = {named}\n"))?;
        let simulate = |_: FingerNumber, finger: &mut ConfiguredFinger| {
            finger.simulate();
            true
        };
        let parsed = parse_with(text, Some((name, rate)), &simulate);
        let (configuration, _) = parsed.map_err(|wrong| invalid_text(text, &wrong))?;
        Ok(Self { configuration, file: None, said: Said { ports: [true; FINGERS], remote: false } })
    }

    /// Reads and checks one configuration file for a simulated board with these fingers. Their ports and boards are
    /// ignored. The values of their simulation are checked in the same way as those of a finger without a port.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read or used.
    pub fn read_for_board(path: &Path, fingers: &[FingerNumber]) -> Result<Self, ConfigurationError> {
        let simulate = |number: FingerNumber, finger: &mut ConfiguredFinger| {
            let of_board = fingers.contains(&number);
            if of_board {
                finger.simulate();
            }
            of_board
        };
        Self::read_with(path, |text| parse_with(text, None, &simulate))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::NamedHand;

    #[test]
    fn a_simulated_hand_has_no_port_and_no_board() {
        let board = "[finger]\nthread = 1\nbaud = 2000000\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n\
                     [finger.2]\nport = '/dev/ttyUSB0'\n";
        // A real hand could not have the ports of the last two texts.
        let shared = "[finger]\nport = '/dev/ttyUSB0'\n";
        for text in [board, shared, "[finger.2]\nport = '/dev/ttyUSB0'\n"] {
            let hand = Configured::simulated("nominal", 1000.0, text).expect("usable").configuration;
            assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::simulated), [true; 3], "{text}");
        }
    }

    #[test]
    fn the_name_replaces_that_of_the_text_and_keeps_its_other_keys() {
        let text = "[hand]\nrate = 500\n[finger.1.simulation]\nhand = 'worn'\nstart_degrees = [1, 20, 30]\n";
        for name in ["nominal", "cheap"] {
            let hand = Configured::simulated(name, 1000.0, text).expect("usable").configuration;
            let named = Configured::simulated(name, 1000.0, "").expect("usable").configuration;
            assert_eq!(hand.hand.rate, 1000.0);
            let mut expected = named.fingers[0].simulation.clone();
            expected.start_degrees = [1.0, 20.0, 30.0];
            assert_eq!(hand.fingers[0].simulation, expected, "{name}");
            assert_eq!(hand.fingers[1], named.fingers[1], "{name}");
        }
        assert_eq!(NamedHand::default().name(), "nominal");
    }

    #[test]
    fn the_text_is_checked_with_the_rate_of_the_call() {
        // The bound of Kx depends on the rate.
        let bound = |rate| ConfiguredFinger::default().stiffness_bound(rate);
        let stiff = (bound(500.0) + bound(1000.0)) / 2.0;
        let text =
            format!("finger.stiffness.initial = [[{stiff}, 0.0, 0.0], [0.0, {stiff}, 0.0], [0.0, 0.0, {stiff}]]");
        for rate in [500.0, 1000.0] {
            assert_eq!(Configured::simulated("nominal", rate, &text).is_ok(), stiff < bound(rate), "{rate} Hz");
        }
        // The rate of the text is ignored even if no hand can have it.
        for rate in ["7", "\"fast\""] {
            let hand = Configured::simulated("nominal", 500.0, &format!("[hand]\nrate = {rate}\n"));
            assert_eq!(hand.map(|hand| hand.configuration.hand.rate).ok(), Some(500.0), "{rate}");
        }
    }

    #[test]
    fn a_rate_or_a_name_that_no_hand_has_is_refused_with_its_key() {
        for rate in [0.0, 1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let refused = Configured::simulated("nominal", rate, "").expect_err("no hand has this rate");
            assert!(refused.to_string().contains("hand.rate: "), "{rate}: {refused}");
        }
        for name in ["broken", "a\"b'c", "a\nb", "\u{7f}", "\u{0}"] {
            let refused = Configured::simulated(name, 1000.0, "").expect_err("no hand has this name");
            assert!(refused.to_string().contains("simulation.hand: must be one of"), "{name:?}: {refused}");
        }
    }
}

//! The configuration of a simulated hand: its name, its rate, and further keys as text.

use super::text::{Said, parse_with};
use super::{Configured, invalid_text, parse_configuration};
use crate::hand::ConfigurationError;
use crate::model::FingerNumber;
use crate::model::configuration::{ConfiguredFinger, FINGERS};

impl Configured {
    /// Reads and checks the configuration of a simulated hand with this name and this rate, Hz. `text` has further keys
    /// of the configuration. Its names, rate, ports, boards and table `remote` are ignored.
    ///
    /// # Errors
    /// Returns [`ConfigurationError::Invalid`] if there is no such name or rate, or if the text is wrong.
    pub fn simulated(name: &str, rate: f64, text: &str) -> Result<Self, ConfigurationError> {
        // Name and rate are checked as a text of their own, so that an error names their key.
        parse_configuration(&format!("hand.rate = {rate:?}\n[finger.simulation]\nhand = {name:?}\n"))?;
        let simulate = |_: FingerNumber, finger: &mut ConfiguredFinger| {
            finger.simulate();
            true
        };
        let parsed = parse_with(text, Some(name), &simulate);
        let (mut configuration, _) = parsed.map_err(|wrong| invalid_text(text, &wrong))?;
        configuration.hand.rate = rate;
        Ok(Self { configuration, file: None, said: Said { ports: [true; FINGERS], remote: false } })
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
}

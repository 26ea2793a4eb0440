//! The unique number of a finger, which differs for every finger of every board. A configuration can give it instead of
//! a port: the hand then opens the port at which a board reports this number.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The unique number in the Identity of a finger. The text has two hexadecimal digits for each byte; spaces, colons and
/// hyphens between them are permitted.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(try_from = "String", into = "String")]
pub struct BoardNumber(pub [u8; 12]);

impl FromStr for BoardNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            "must have 24 hexadecimal digits, two for each byte of the unique number, as `sun2xp boards` prints it"
                .to_owned()
        };
        let digits = text.chars().filter(|character| !matches!(character, ' ' | ':' | '-'));
        let mut digits = digits.map(|character| character.to_digit(16));
        let mut number = [0; 12];
        for byte in &mut number {
            let (high, low) = digits.next().flatten().zip(digits.next().flatten()).ok_or_else(wrong)?;
            // Both digits are below 16.
            *byte = (high << 4 | low) as u8;
        }
        if digits.next().is_some() { Err(wrong()) } else { Ok(Self(number)) }
    }
}

impl TryFrom<String> for BoardNumber {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<BoardNumber> for String {
    fn from(number: BoardNumber) -> Self {
        number.to_string()
    }
}

/// Writes the bytes in hexadecimal, with spaces between them.
impl fmt::Display for BoardNumber {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        let bytes = self.0.map(|byte| format!("{byte:02X}"));
        formatter.write_str(&bytes.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_number_is_that_number() {
        let number = BoardNumber([0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0xAB, 0xFF]);
        assert_eq!(number.to_string(), "00 01 02 03 04 05 06 07 08 09 AB FF");
        for text in [&*number.to_string(), "00010203-04050607-0809abff", "00:01:02:03:04:05:06:07:08:09:ab:FF"] {
            assert_eq!(text.parse(), Ok(number), "{text}");
        }
        for wrong in ["", "00 01", "00010203040506070809abf", "00010203040506070809abff0", "g0010203040506070809abff"] {
            assert!(wrong.parse::<BoardNumber>().is_err(), "{wrong}");
        }
    }
}

//! Text from a file in a message for a person: short, and without characters that change what a terminal shows.

use std::fmt::{Display, Formatter, Result, Write};

/// How many characters of a text are shown.
const MOST: usize = 60;

/// Shows a text that somebody else has written: control characters and other characters that cannot be seen are escaped, and what goes
/// beyond 60 characters is left out.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a>(pub &'a str);

impl Display for Shown<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        for character in self.0.chars().take(MOST) {
            match character {
                // Of these, escape_debug would also escape what is plain to see.
                '\'' | '"' => formatter.write_char(character)?,
                _ => write!(formatter, "{}", character.escape_debug())?,
            }
        }
        match self.0.chars().nth(MOST) {
            Some(_) => formatter.write_str("..."),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_can_be_seen_stays_and_the_rest_is_escaped() {
        for (text, shown) in [
            ("tendon.minimum", "tendon.minimum"),
            ("/dev/tty\"ü'", "/dev/tty\"ü'"),
            ("two\nlines\r\t", "two\\nlines\\r\\t"),
            ("\u{1b}[31mred\u{7f}\u{9b}0m", "\\u{1b}[31mred\\u{7f}\\u{9b}0m"),
            // Right-to-left override, zero-width space, a byte order mark.
            ("\u{202e}\u{200b}\u{feff}", "\\u{202e}\\u{200b}\\u{feff}"),
        ] {
            assert_eq!(Shown(text).to_string(), shown);
        }
    }

    #[test]
    fn a_long_text_is_cut() {
        assert_eq!(Shown(&"x".repeat(60)).to_string(), "x".repeat(60));
        assert_eq!(Shown(&"x".repeat(1_000_000)).to_string(), "x".repeat(60) + "...");
        assert!(Shown(&"\0".repeat(100)).to_string().len() <= 60 * 10 + 3);
    }
}

//! Displays external text in messages: short, and without characters that change the state of a terminal.

use std::fmt::{Display, Formatter, Result, Write};
use std::path::Path;

/// Largest number of characters of a text that are shown.
const MOST: usize = 60;

/// Largest number of characters of a path that are shown completely. Of a longer path, the beginning and the end are
/// shown.
const MOST_OF_PATH: usize = 240;
const BEGINNING_OF_PATH: usize = 120;
const END_OF_PATH: usize = 60;

/// Displays a text from an external source. Backslashes, control characters, other invisible characters and combining
/// marks are escaped. At most 60 characters are shown.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a>(pub &'a str);

impl Display for Shown<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        for character in self.0.chars().take(MOST) {
            write_visible(character, formatter)?;
        }
        match self.0.chars().nth(MOST) {
            Some(_) => formatter.write_str("..."),
            None => Ok(()),
        }
    }
}

/// Displays a path. Characters are escaped in the same way as in [`Shown`]. Of a long path the beginning and the end
/// are shown, because a message must leave room for cause and remedy.
#[derive(Clone, Copy, Debug)]
pub struct ShownPath<'a>(pub &'a Path);

impl Display for ShownPath<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        let path = self.0.to_string_lossy();
        let length = path.chars().count();
        let left_out = match length {
            0..=MOST_OF_PATH => 0..0,
            _ => BEGINNING_OF_PATH..length - END_OF_PATH,
        };
        for (place, character) in path.chars().enumerate() {
            if place == left_out.start && !left_out.is_empty() {
                write!(formatter, "[... {} characters ...]", left_out.len())?;
            }
            if !left_out.contains(&place) {
                write_visible(character, formatter)?;
            }
        }
        Ok(())
    }
}

/// Returns a message on one line, with invisible characters and combining marks escaped. All other characters are
/// unchanged, also backslashes.
pub fn one_line(message: &str) -> String {
    let mut line = String::with_capacity(message.len());
    // Writing to a string cannot fail.
    let _ = OneLine(&mut line).write_str(message);
    line
}

/// Writes a message without making a copy of it. Characters are escaped in the same way as in [`one_line`].
pub struct OneLine<'a, W>(pub &'a mut W);

impl<W: Write> Write for OneLine<'_, W> {
    fn write_str(&mut self, message: &str) -> Result {
        message.chars().try_for_each(|character| match character {
            '\\' => self.0.write_char(character),
            _ => write_visible(character, self.0),
        })
    }
}

fn write_visible(character: char, to: &mut impl Write) -> Result {
    match character {
        // `escape_debug` would also escape these visible characters.
        '\'' | '"' => to.write_char(character),
        _ => write!(to, "{}", character.escape_debug()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;

    #[test]
    fn visible_characters_stay_and_the_rest_is_escaped() {
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

    #[test]
    fn a_path_has_its_beginning_and_its_end() {
        let shown = |path: &str| ShownPath(Path::new(path)).to_string();
        let usual = "/dev/serial/by-id/usb-FTDI_TTL232R-3V3_FTAAAAAA-if00-port0";
        assert_eq!(shown(usual), usual);
        assert_eq!(shown(&"x".repeat(MOST_OF_PATH)), "x".repeat(MOST_OF_PATH));
        let long = shown(&format!("/begin/{}/end", "x".repeat(10_000)));
        assert!(long.starts_with("/begin/xxx") && long.ends_with("xxx/end") && long.len() < 250, "{long}");
        assert!(long.contains("[... 9831 characters ...]"), "{long}");
        assert!(shown(&"\n".repeat(100_000)).len() < 1000);
        assert_eq!(shown("a\nb\u{1b}[2J\u{202e}"), r"a\nb\u{1b}[2J\u{202e}");
        assert_eq!(ShownPath(Path::new(OsStr::from_bytes(b"a\xffb\n"))).to_string(), "a\u{fffd}b\\n");
    }

    #[test]
    fn a_message_is_one_line() {
        assert_eq!(one_line("a call: \"ü\" \\ '\n\t\0\u{1b}[31m"), r#"a call: "ü" \ '\n\t\0\u{1b}[31m"#);
    }
}

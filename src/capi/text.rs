//! The text of a refused call, in memory that every thread has from its beginning: a refusal allocates nothing.

use crate::model::OneLine;
use std::ffi::c_char;
use std::fmt::{self, Write};

/// Longer texts are cut. Those of the library are shorter: what they quote is shortened before.
const CAPACITY: usize = 2048;

/// One line of text with a zero byte behind it.
pub(super) struct Text {
    bytes: [u8; CAPACITY],
    /// Without the zero byte.
    length: usize,
}

impl Text {
    pub const EMPTY: Self = Self { bytes: [0; CAPACITY], length: 0 };

    /// Replaces the text by these arguments on one line.
    pub fn compose(&mut self, arguments: fmt::Arguments<'_>) {
        self.length = 0;
        // Where it is cut the rest is left out.
        let _ = OneLine(self).write_fmt(arguments);
        self.bytes[self.length] = 0;
    }

    pub fn as_str(&self) -> &str {
        // Only whole characters are in it.
        std::str::from_utf8(&self.bytes[..self.length]).unwrap_or_default()
    }

    /// Valid until the text is replaced.
    pub fn as_c_string(&self) -> *const c_char {
        self.bytes.as_ptr().cast()
    }
}

impl Write for Text {
    fn write_str(&mut self, part: &str) -> fmt::Result {
        // The last byte is for the zero.
        let room = CAPACITY - 1 - self.length;
        let whole = part.len() <= room;
        let end = room.min(part.len());
        let taken = (0..=end).rev().find(|&end| part.is_char_boundary(end)).unwrap_or_default();
        self.bytes[self.length..self.length + taken].copy_from_slice(&part.as_bytes()[..taken]);
        self.length += taken;
        if whole { Ok(()) } else { Err(fmt::Error) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::CStr;

    fn kept(text: &Text) -> &str {
        // SAFETY: composed before, and not changed meanwhile.
        unsafe { CStr::from_ptr(text.as_c_string()) }.to_str().expect("UTF-8")
    }

    #[test]
    fn it_is_one_line_and_the_newest() {
        let mut text = Text::EMPTY;
        text.compose(format_args!("{}: two\nlines", "a longer text than the next"));
        assert_eq!(kept(&text), "a longer text than the next: two\\nlines");
        text.compose(format_args!("short"));
        assert_eq!((kept(&text), text.as_str()), ("short", "short"));
    }

    #[test]
    fn a_long_text_is_cut_between_characters() {
        let mut text = Text::EMPTY;
        // Two bytes each, from an odd place on.
        text.compose(format_args!("a{}", "\u{e9}".repeat(CAPACITY)));
        assert_eq!(kept(&text).len(), CAPACITY - 1);
        text.compose(format_args!("{}", "\u{e9}".repeat(CAPACITY)));
        assert_eq!(kept(&text).len(), CAPACITY - 2);
        assert_eq!(kept(&text), text.as_str());
    }
}

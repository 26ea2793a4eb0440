//! Texts in memory of fixed size, so that a refusal allocates nothing.

use crate::model::OneLine;
use std::ffi::c_char;
use std::fmt::{self, Write};

/// One line of text, terminated by a zero byte. A text of more than `CAPACITY` - 1 bytes is truncated.
pub(super) struct Text<const CAPACITY: usize> {
    bytes: [u8; CAPACITY],
    /// Length of the text, bytes, without the zero byte.
    length: usize,
}

impl<const CAPACITY: usize> Text<CAPACITY> {
    pub const EMPTY: Self = Self { bytes: [0; CAPACITY], length: 0 };

    /// Replaces the text by the formatted arguments, on one line.
    pub fn compose(&mut self, arguments: fmt::Arguments<'_>) {
        self.length = 0;
        // An error means only that the text was truncated.
        let _ = OneLine(self).write_fmt(arguments);
        self.bytes[self.length] = 0;
    }

    pub fn as_str(&self) -> &str {
        // The text contains only whole characters.
        std::str::from_utf8(&self.bytes[..self.length]).unwrap_or_default()
    }

    /// Returns a pointer that is valid until the text is replaced.
    pub fn as_c_string(&self) -> *const c_char {
        self.bytes.as_ptr().cast()
    }
}

impl<const CAPACITY: usize> Write for Text<CAPACITY> {
    fn write_str(&mut self, part: &str) -> fmt::Result {
        // The last byte is reserved for the zero.
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

    const CAPACITY: usize = 64;

    fn read_back(text: &Text<CAPACITY>) -> &str {
        // SAFETY: the text was composed before and does not change meanwhile.
        unsafe { CStr::from_ptr(text.as_c_string()) }.to_str().expect("UTF-8")
    }

    #[test]
    fn a_text_is_one_line_and_replaces_the_previous_one() {
        let mut text = Text::<CAPACITY>::EMPTY;
        text.compose(format_args!("{}: two\nlines", "a longer text than the next"));
        assert_eq!(read_back(&text), "a longer text than the next: two\\nlines");
        text.compose(format_args!("short"));
        assert_eq!((read_back(&text), text.as_str()), ("short", "short"));
    }

    #[test]
    fn a_long_text_is_truncated_between_characters() {
        let mut text = Text::<CAPACITY>::EMPTY;
        // Each repeated character takes two bytes, and begins at an odd offset.
        text.compose(format_args!("a{}", "\u{e9}".repeat(CAPACITY)));
        assert_eq!(read_back(&text).len(), CAPACITY - 1);
        text.compose(format_args!("{}", "\u{e9}".repeat(CAPACITY)));
        assert_eq!(read_back(&text).len(), CAPACITY - 2);
        assert_eq!(read_back(&text), text.as_str());
    }
}

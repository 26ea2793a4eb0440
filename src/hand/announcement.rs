//! What a hand says on standard error: one line each, for people who do not look at results.

use crate::model::one_line;
use std::io::Write;

/// One line, written at once, so that those of several threads do not mix. Not with `eprintln!`, which panics where nobody reads it.
pub(super) fn say(text: &str) {
    let _ = std::io::stderr().write_all(format!("sun2xp: {}\n", one_line(text)).as_bytes());
}

//! What the program says. A terminal that has closed or a disk that is full must not end a server that moves a hand, so
//! a text that cannot be written is lost. Control characters are escaped, because a text from another program must not
//! change the state of a terminal.

use std::io::{Write, stderr, stdout};
use sun2xp::model::one_line;

/// Writes a line to the standard output.
pub fn say(text: &str) {
    let _ = writeln!(stdout(), "{}", one_line(text));
}

/// Writes a line to the standard error output, after the name of the program.
pub fn complain(text: &str) {
    let _ = writeln!(stderr(), "sun2xp-serve: {}", one_line(text));
}

/// Writes the lines of a message to the standard error output.
pub fn complain_lines(text: &str) {
    for line in text.lines() {
        let _ = writeln!(stderr(), "{}", one_line(line));
    }
}

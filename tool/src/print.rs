//! Output for people and for other programs, shared by all commands: aligned tables, colours, progress, JSON.
//!
//! Results go to standard output, progress and errors to standard error. Colours and the lines below table headers
//! appear only where the output is a terminal that shows them, so that a file or another program receives plain text.

mod paint;
mod progress;
mod screen;
mod table;

pub use paint::{Look, painted};
pub use progress::Progress;
pub use screen::Screen;
pub use table::{Cell, Table};

use serde::Serialize;
use std::io::{self, Write};

/// Prints the result of a command as one JSON value on standard output.
///
/// # Errors
/// Returns an error if standard output cannot be written.
pub fn json(value: &impl Serialize) -> io::Result<()> {
    let mut output = io::stdout().lock();
    serde_json::to_writer_pretty(&mut output, value)?;
    writeln!(output)?;
    output.flush()
}

//! What the standard output of this process can show.

use anstream::{AutoStream, ColorChoice};
use std::io::{self, IsTerminal};

/// Narrowest width to which a table is fitted, columns. On a narrower terminal the lines of a table wrap.
const NARROWEST: usize = 40;

/// The abilities of an output.
#[derive(Clone, Copy, Debug)]
pub struct Screen {
    /// Number of columns of the terminal. It is `None` if the output is not a terminal, or if the terminal is narrower
    /// than [`NARROWEST`]. Lines then have any length.
    pub width: Option<usize>,
    /// Whether a table has a horizontal line below its header.
    pub lines: bool,
    /// Whether the output shows colours. They are off if the environment has NO_COLOR, and for dumb terminals.
    pub coloured: bool,
}

impl Screen {
    /// Standard output.
    pub fn stdout() -> Self {
        let output = io::stdout();
        let terminal = output.is_terminal();
        let width = terminal_size::terminal_size_of(&output).map(|(width, _)| usize::from(width.0));
        let coloured = AutoStream::choice(&output) != ColorChoice::Never;
        Self { width: width.filter(|&width| terminal && width >= NARROWEST), lines: terminal, coloured }
    }
}

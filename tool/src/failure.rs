//! Failures of the tool's commands.

use std::error::Error;

/// The reason why a command failed. The tool prints its text, which names cause and remedy, in one line.
pub type Failure = Box<dyn Error>;

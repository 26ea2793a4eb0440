//! Why a command of the tool ends without success.

use std::error::Error;

/// Its text is the line that the tool prints, and names cause and remedy.
pub type Failure = Box<dyn Error>;

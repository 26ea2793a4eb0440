//! The command `sun2xp`, which the wheel installs.

use pyo3::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// Runs the tool with these arguments, the first of which is its name, and returns its exit status. `script` is the
/// file of the command.
#[pyfunction]
#[pyo3(signature = (arguments, script=None))]
pub fn run_tool(py: Python<'_>, arguments: Vec<OsString>, script: Option<PathBuf>) -> u8 {
    py.detach(|| sun2xp_tool::run_script(arguments, script.as_deref()))
}

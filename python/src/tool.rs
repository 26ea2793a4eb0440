//! The command `sun2xp`, which the wheel installs.

use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the tool with these arguments, the first of which is its name, and returns its exit status.
#[pyfunction]
pub fn run_tool(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| sun2xp_tool::run(arguments))
}

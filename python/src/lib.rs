//! The extension module of the Python package `sun2xp`. The Python files of the package add what needs no Rust.

mod arguments;
mod commands;
mod errors;
mod events;
mod fork;
mod hand;
mod messages;
mod opening;
mod pending;
mod queries;
mod recording;
mod records;
mod reflexes;
mod supervision;
mod tool;
mod waiting;

use pyo3::prelude::*;

#[pymodule]
mod _sun2xp {
    #[pymodule_export]
    use super::events::{Queue, event_kinds, event_values};
    #[pymodule_export]
    use super::hand::Hand;
    #[pymodule_export]
    use super::hand::close_all;
    #[pymodule_export]
    use super::messages::{end_messages, flush_messages, next_message, take_messages};
    #[pymodule_export]
    use super::opening::{open_file, open_simulated, open_text};
    #[pymodule_export]
    use super::recording::read_file;
    #[pymodule_export]
    use super::supervision::stop_all;
    #[pymodule_export]
    use super::tool::run_tool;
    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))?;
        fork::watch(module.py())?;
        // Python runs the handlers in the reverse order of their registration. Handlers that the program registers
        // after the import run before this one, and can still use the hands.
        module.py().import("atexit")?.call_method1("register", (module.getattr("close_all")?,))?;
        Ok(())
    }
}

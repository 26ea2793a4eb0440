//! The functions that open a hand.

use crate::errors::Refusal;
use crate::hand::Opened;
use crate::pending::Pending;
use crate::waiting::in_thread;
use parking_lot::Mutex;
use pyo3::prelude::*;
use std::path::PathBuf;
use sun2xp::hand::{Configured, find_configuration};
use sun2xp::{ConfigurationError, Hand};

/// Opens the hand of a configuration file. Without a path, the library searches for the file.
#[pyfunction]
pub fn open_file(py: Python<'_>, path: Option<PathBuf>) -> PyResult<Opened> {
    opened(py, move || match path {
        Some(path) => Configured::read(&path),
        None => find_configuration(),
    })
}

/// Opens the hand that the text of a configuration file describes.
#[pyfunction]
pub fn open_text(py: Python<'_>, text: String) -> PyResult<Opened> {
    opened(py, move || Configured::from_text(&text))
}

/// Opens a simulated hand with this name. `text` has further keys of the configuration.
#[pyfunction]
pub fn open_simulated(py: Python<'_>, name: String, rate: f64, text: String) -> PyResult<Opened> {
    opened(py, move || Configured::simulated(&name, rate, &text))
}

fn opened(
    py: Python<'_>,
    configured: impl FnOnce() -> Result<Configured, ConfigurationError> + Send + 'static,
) -> PyResult<Opened> {
    let pending = Pending::opening();
    let open = move || {
        let configured = configured().map_err(sun2xp::HandError::from);
        let hand = configured.and_then(|configured| Hand::open_while(configured, &|| pending.goes_on()));
        // If nobody waits for the result any more, the hand is closed before `pending` is dropped.
        (hand, pending)
    };
    let (hand, pending) = in_thread(py, open)?;
    let hand = hand.map_err(|error| Refusal::Hand(error).raise(py))?;
    Ok(Opened(Mutex::new(Some((hand, pending)))))
}

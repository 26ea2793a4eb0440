//! The functions that open a hand.

use crate::errors::Refusal;
use crate::hand::Opened;
use crate::waiting::in_thread;
use parking_lot::Mutex;
use pyo3::prelude::*;
use std::path::PathBuf;
use sun2xp::hand::{Configured, find_configuration, parse_configuration};
use sun2xp::model::configuration::NamedHand;
use sun2xp::{Configuration, Hand, HandError};

/// Opens the hand of a configuration file; without a path, of the file that the library finds.
#[pyfunction]
pub fn open_file(py: Python<'_>, path: Option<PathBuf>) -> PyResult<Opened> {
    opened(py, move || {
        let configured = match path {
            Some(path) => Configured::read(&path)?,
            None => find_configuration()?,
        };
        Hand::open_as(configured)
    })
}

/// Opens the hand that the text of a configuration file describes.
#[pyfunction]
pub fn open_text(py: Python<'_>, text: String) -> PyResult<Opened> {
    opened(py, move || Hand::open(parse_configuration(&text)?))
}

/// Opens a simulated hand with this name. `text` has further keys of the configuration.
#[pyfunction]
pub fn open_simulated(py: Python<'_>, name: &str, rate: f64, text: &str) -> PyResult<Opened> {
    let configuration = simulated(name, rate, text).map_err(|refusal| refusal.raise(py))?;
    opened(py, move || Hand::open(configuration))
}

fn simulated(name: &str, rate: f64, text: &str) -> Result<Configuration, Refusal> {
    let refused = |error: sun2xp::ConfigurationError| Refusal::Hand(error.into());
    let mut configuration = parse_configuration(text).map_err(refused)?;
    // The library checks name and rate, and its errors name the key.
    let named = format!("hand.rate = {rate:?}\n[finger.simulation]\nhand = {name:?}\n");
    let named = parse_configuration(&named).map_err(refused)?;
    configuration.hand.rate = named.hand.rate;
    for (finger, named) in configuration.fingers.iter_mut().zip(named.fingers) {
        finger.port = named.port;
        if name != NamedHand::default().name() {
            finger.simulation = named.simulation;
        }
    }
    Ok(configuration)
}

fn opened(py: Python<'_>, open: impl FnOnce() -> Result<Hand, HandError> + Send + 'static) -> PyResult<Opened> {
    let hand = in_thread(py, open)?.map_err(|error| Refusal::Hand(error).raise(py))?;
    Ok(Opened(Mutex::new(Some(hand))))
}

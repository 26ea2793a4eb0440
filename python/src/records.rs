//! Conversion of results to the classes of sun2xp._types.

use crate::errors;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use sun2xp::{Distribution, Fault, FingerFault, FingerStatus, FingerTip, Losses};

/// Returns an object of a class of sun2xp._types with these fields.
pub fn record<'py>(py: Python<'py>, class: &str, fields: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyAny>> {
    static TYPES: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let types = TYPES.get_or_try_init(py, || py.import("sun2xp._types").map(Bound::unbind))?;
    types.bind(py).getattr(class)?.call((), Some(fields))
}

pub fn vector<'py, const N: usize>(py: Python<'py>, numbers: &[f64; N]) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, numbers)
}

pub fn matrix<'py, const N: usize>(py: Python<'py>, rows: &[[f64; 3]; N]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows: Vec<Vec<f64>> = rows.iter().map(|row| row.to_vec()).collect();
    Ok(PyArray2::from_vec2(py, &rows)?)
}

pub fn tip<'py>(py: Python<'py>, tip: &FingerTip) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("position", vector(py, &tip.tip))?;
    fields.set_item("force", vector(py, &tip.force))?;
    fields.set_item("force_directions", tip.felt)?;
    fields.set_item("tensions", vector(py, &tip.tensions))?;
    fields.set_item("stiffness", matrix(py, &tip.stiffness)?)?;
    fields.set_item("contact_force", vector(py, &tip.contact))?;
    fields.set_item("touching", tip.touching)?;
    fields.set_item("slide_speed", tip.slide)?;
    record(py, "Tip", &fields)
}

pub fn status<'py>(py: Python<'py>, status: &FingerStatus) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("stage", status.stage.name())?;
    fields.set_item("realtime", status.realtime)?;
    fields.set_item("memory_locked", status.memory_locked)?;
    fields.set_item("on_core", status.on_core)?;
    fields.set_item("rate", status.rate)?;
    fields.set_item("measured_rate", status.measured_rate)?;
    fields.set_item("wake_up", distribution(py, &status.wake_up)?)?;
    fields.set_item("losses", losses(py, &status.losses)?)?;
    fields.set_item("torque_scale", status.torque_scale)?;
    fields.set_item("stiffness_scale", status.stiffness_scale)?;
    fields.set_item("calibration", status.calibration)?;
    record(py, "Status", &fields)
}

pub fn losses<'py>(py: Python<'py>, losses: &Losses) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("cycles", losses.cycles)?;
    fields.set_item("overruns", losses.overruns)?;
    fields.set_item("skipped_periods", losses.skipped_periods)?;
    fields.set_item("lost_replies", losses.lost_replies)?;
    fields.set_item("late_replies", losses.late_replies)?;
    fields.set_item("duplicate_replies", losses.duplicate_replies)?;
    fields.set_item("damaged_replies", losses.damaged_frames)?;
    fields.set_item("foreign_frames", losses.foreign_frames)?;
    record(py, "Losses", &fields)
}

pub fn distribution<'py>(py: Python<'py>, distribution: &Distribution) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("count", distribution.count)?;
    fields.set_item("minimum", distribution.minimum)?;
    fields.set_item("median", distribution.median)?;
    fields.set_item("p99", distribution.p99)?;
    fields.set_item("p999", distribution.p999)?;
    fields.set_item("maximum", distribution.maximum)?;
    record(py, "Distribution", &fields)
}

pub fn finger_fault<'py>(py: Python<'py>, found: &FingerFault) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("stopped", found.stopped.map(|found| fault(py, &found)).transpose()?)?;
    fields.set_item("warning", found.warning.map(|found| fault(py, &found)).transpose()?)?;
    fields.set_item("warnings", found.warnings)?;
    record(py, "FingerFault", &fields)
}

pub fn fault<'py>(py: Python<'py>, fault: &Fault) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("number", fault.kind.number())?;
    fields.set_item("name", fault.kind.description().name)?;
    fields.set_item("part", fault.part.to_string())?;
    fields.set_item("value", fault.value)?;
    fields.set_item("text", fault.to_string())?;
    fields.set_item("remedy", errors::remedy(fault.kind))?;
    record(py, "FaultDescription", &fields)
}

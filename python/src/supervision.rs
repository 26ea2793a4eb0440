//! The methods of `Hand` that wait, stop, recover and calibrate.

use crate::arguments;
use crate::errors::Refusal;
use crate::hand::Hand;
use crate::records::{self, vector};
use crate::waiting::{SLICE, duration, in_thread, until};
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::time::Duration;
use sun2xp::groups::{Until, Waiting};
use sun2xp::nalgebra::Matrix3x4;
use sun2xp::{Calibrating, CalibrationState, Findings, Identified, Progress, Recovering, Task};

#[pymethods]
impl Hand {
    /// Waits until fingers have arrived at their set points, or have settled.
    fn _wait(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::fingers)] fingers: Vec<i32>,
        condition: &str,
        timeout: Option<f64>,
    ) -> PyResult<()> {
        let condition = match condition {
            "arrived" => Until::Arrived,
            "settled" => Until::Settled,
            other => {
                let text = format!("there is no condition {other:?} to wait for: pass \"arrived\" or \"settled\"");
                return Err(Refusal::Argument(text).raise(py));
            }
        };
        let limit = duration(py, "timeout", timeout)?.unwrap_or(Duration::MAX);
        let waiting = self.quick(py, |hand| Waiting::begin(hand, &fingers, condition, limit))?;
        until(py, || Ok(self.0.with(|hand| waiting.poll(hand))?.then_some(())))
    }

    /// Makes a faulted finger a spring again. The finger holds its present pose at its initial stiffness. The cause of
    /// the fault must be removed first. If the finger is not faulted, only waits for a recovery by another call.
    fn recover(&self, py: Python<'_>, #[pyo3(from_py_with = arguments::finger)] finger: i32) -> PyResult<()> {
        // After a stop, this call waits until the servo has carried out the stop.
        let recovering = self.slow(py, |hand| Recovering::begin(hand, finger))?;
        let (recovering, reconnected) = in_thread(py, move || {
            let reconnected = recovering.reconnect();
            (recovering, reconnected)
        })?;
        reconnected.map_err(|error| Refusal::Hand(error).raise(py))?;
        until(py, || Ok(self.0.with(|hand| recovering.poll(hand))?.then_some(())))
    }

    /// Stops a finger, or all fingers: they fault at the beginning of their next cycle, and stay faulted until they
    /// recover.
    #[pyo3(signature = (finger=None))]
    fn stop(&self, py: Python<'_>, #[pyo3(from_py_with = arguments::some_finger)] finger: Option<i32>) -> PyResult<()> {
        self.quick(py, |hand| match finger {
            Some(finger) => hand.stop(finger),
            None => hand.fingers().numbers().try_for_each(|finger| hand.stop(finger)),
        })
    }

    /// Runs a calibration: "signs", "zero" or "identify". Calls `progress` 50 times a second with the completed part of
    /// the calibration, 0 to 1, and the current activity. If `progress` or the handler of a signal raises an exception,
    /// the finger is stopped.
    fn _calibrate<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        task: &str,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let task = match task {
            "signs" => Task::Signs,
            "zero" => Task::Zero,
            _ => Task::Identify,
        };
        let mut calibrating = self.slow(py, |hand| Calibrating::begin(hand, finger, task))?;
        loop {
            let state = match self.slow(py, |hand| calibrating.poll(hand))? {
                CalibrationState::Done(findings) => return found(py, &findings),
                other => other,
            };
            if let Err(exception) = pause(py, &state, progress) {
                // Without this stop, the calibration would continue although nobody polls it. It could still move the
                // joints between their mechanical stops, and the finger would be limp at the end. If the stop fails
                // because the hand was closed meanwhile, the finger is in its end state.
                let _ = self.0.with(|hand| hand.stop(finger));
                return Err(exception);
            }
        }
    }

    /// Stores the results of calibrations of a finger in the configuration file. Returns False if there is nothing to
    /// store, or if the hand was opened without a file.
    fn store_calibration(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
    ) -> PyResult<bool> {
        self.slow(py, |hand| hand.store_calibration(finger))
    }

    /// Writes the last two seconds of a finger into a file for `sun2xp replay`.
    fn write_black_box(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        path: PathBuf,
    ) -> PyResult<()> {
        self.slow(py, |hand| hand.write_black_box(finger, &path))
    }
}

/// Emergency stop: every finger of every hand of this process faults at the beginning of its next cycle.
#[pyfunction]
pub fn stop_all() {
    sun2xp::stop_all();
}

/// Reports the progress of a calibration, and waits until the next poll.
fn pause(py: Python<'_>, state: &CalibrationState, progress: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
    if let (CalibrationState::InProgress(Progress { step, part, .. }), Some(progress)) = (state, progress) {
        progress.call1((*part, step.to_string()))?;
    }
    py.detach(|| std::thread::sleep(SLICE));
    py.check_signals()
}

fn found<'py>(py: Python<'py>, findings: &Findings) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    match findings {
        Findings::Signs(signs) => {
            fields.set_item("motor", signs.motor)?;
            fields.set_item("encoder", signs.encoder)?;
            fields.set_item("gauge", signs.gauge)?;
            records::record(py, "Signs", &fields)
        }
        Findings::RightWiring => Ok(py.None().into_bound(py)),
        Findings::Zeros(zeros) => {
            fields.set_item("encoder", zeros.encoder)?;
            fields.set_item("gauge", vector(py, &zeros.gauge))?;
            fields.set_item("joint_error", vector(py, &zeros.joint_error.into()))?;
            fields.set_item("range_error", zeros.range_error.map(|error| vector(py, &error.into())))?;
            records::record(py, "Zeros", &fields)
        }
        Findings::Identified(identified) => self::identified(py, identified),
    }
}

fn identified<'py>(py: Python<'py>, found: &Identified) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("tendon_stiffness", vector(py, &found.tendon_stiffness.into()))?;
    fields.set_item("stiffness_tolerance", found.stiffness_tolerance)?;
    fields.set_item("travel_residual", found.travel_residual)?;
    fields.set_item("motor_coulomb", vector(py, &found.motor_coulomb.into()))?;
    fields.set_item("conduit", vector(py, &found.conduit.into()))?;
    fields.set_item("pulley", vector(py, &found.pulley.into()))?;
    fields.set_item("gauge_gain", vector(py, &found.gauge_gain.into()))?;
    fields.set_item("motor_ratio", vector(py, &found.motor_ratio.into()))?;
    fields.set_item("joint_coulomb", vector(py, &found.joint_coulomb.into()))?;
    fields.set_item("joint_viscous", vector(py, &found.joint_viscous.into()))?;
    fields.set_item("rotor_inertia", found.rotor_inertia.map(|inertia| vector(py, &inertia.into())))?;
    let arms = found.moment_arms.map(|arms| matrix_of_arms(py, &arms.r)).transpose()?;
    fields.set_item("moment_arms", arms)?;
    records::record(py, "Identified", &fields)
}

fn matrix_of_arms<'py>(py: Python<'py>, arms: &Matrix3x4<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let rows: Vec<Vec<f64>> = arms.row_iter().map(|row| row.iter().copied().collect()).collect();
    Ok(PyArray2::from_vec2(py, &rows)?)
}

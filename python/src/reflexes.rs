//! The methods of `Hand` that install reflexes.

use crate::arguments::{self, rows, vector};
use crate::errors::Refusal;
use crate::hand::Hand;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use sun2xp::events::EventKind;
use sun2xp::model::FingerNumber;
use sun2xp::nalgebra::{Matrix3, Vector3};
use sun2xp::reflexes::{Condition, Reaction, Reflex};

#[pymethods]
impl Hand {
    /// Installs a reflex of a finger, and returns its number. `when` and `then` are names and values, as the functions
    /// of `sun2xp.when` and `sun2xp.then` return them.
    #[pyo3(signature = (finger, when, then, *, priority=0, refractory=0.0, inhibition=0.0))]
    #[expect(clippy::too_many_arguments, reason = "the keywords of a Python call")]
    fn install_reflex(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        when: &Bound<'_, PyTuple>,
        then: &Bound<'_, PyTuple>,
        #[pyo3(from_py_with = arguments::priority)] priority: u8,
        refractory: f64,
        inhibition: f64,
    ) -> PyResult<u32> {
        let (condition, reaction) = (condition(when)?, reaction(then)?);
        let reflex = Reflex { condition, reaction, priority, refractory, inhibition };
        self.quick(py, |hand| hand.install_reflex(finger, reflex))
    }

    /// Removes a reflex of a finger. Without a number, removes all of its reflexes.
    #[pyo3(signature = (finger, number=None))]
    fn remove_reflex(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = arguments::finger)] finger: i32,
        #[pyo3(from_py_with = arguments::some_reflex)] number: Option<u32>,
    ) -> PyResult<()> {
        self.quick(py, |hand| match number {
            Some(number) => hand.remove_reflex(finger, number),
            None => hand.clear_reflexes(finger),
        })
    }
}

fn condition(when: &Bound<'_, PyTuple>) -> PyResult<Condition> {
    let (name, one, other) = (name(when)?, || value(when, 1), || value(when, 2));
    Ok(match name.as_str() {
        "event" => Condition::Event(event(&one()?)?),
        "other_finger" => Condition::OtherFinger { finger: number(&one()?)?, event: event(&other()?)? },
        "force_above" => Condition::ForceAbove(one()?.extract()?),
        "tension_above" => Condition::TensionAbove(one()?.extract()?),
        "tension_below" => Condition::TensionBelow(one()?.extract()?),
        "joint_above" => Condition::JointAbove { joint: arguments::joint(&one()?)?, angle: other()?.extract()? },
        "joint_below" => Condition::JointBelow { joint: arguments::joint(&one()?)?, angle: other()?.extract()? },
        "link_lost" => Condition::LinkLost(one()?.extract()?),
        "planner_silent" => Condition::PlannerSilent(one()?.extract()?),
        _ => return Err(unknown(when, "condition", "sun2xp.when")),
    })
}

fn reaction(then: &Bound<'_, PyTuple>) -> PyResult<Reaction> {
    let (name, one) = (name(then)?, || value(then, 1));
    Ok(match name.as_str() {
        "stop" => Reaction::Stop,
        "hold" => Reaction::Hold,
        "soften" => {
            let rows = rows(&one()?, "stiffness")?;
            Reaction::Soften(Matrix3::from_fn(|row, column| rows[row][column]))
        }
        "retract" => Reaction::Retract(vector(&one()?, "joints")?.into()),
        "grip" => {
            let direction: Vector3<f64> = vector(&value(then, 3)?, "direction")?.into();
            Reaction::Grip { direction, by: one()?.extract()?, most: value(then, 2)?.extract()? }
        }
        "damp" => Reaction::Damp(one()?.extract()?),
        _ => return Err(unknown(then, "reaction", "sun2xp.then")),
    })
}

fn name(tuple: &Bound<'_, PyTuple>) -> PyResult<String> {
    value(tuple, 0)?.extract()
}

fn value<'py>(tuple: &Bound<'py, PyTuple>, place: usize) -> PyResult<Bound<'py, PyAny>> {
    tuple.get_item(place)
}

/// Returns the kind of event with this number, which is the value of a member of the Python class `EventKind`.
fn event(number: &Bound<'_, PyAny>) -> PyResult<EventKind> {
    let text = || format!("there is no kind of event {number}: use the members of sun2xp.EventKind");
    let found = EventKind::from_number(arguments::in_range(number, number.extract(), text)?);
    found.ok_or_else(|| Refusal::Argument(text()).raise(number.py()))
}

fn number(finger: &Bound<'_, PyAny>) -> PyResult<FingerNumber> {
    let found = FingerNumber::try_from(arguments::finger(finger)?);
    found.map_err(|error| Refusal::Hand(error).raise(finger.py()))
}

fn unknown(tuple: &Bound<'_, PyTuple>, what: &str, module: &str) -> PyErr {
    let text = format!("there is no such {what} as {tuple}: use the functions of {module}");
    Refusal::Argument(text).raise(tuple.py())
}

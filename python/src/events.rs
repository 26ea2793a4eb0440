//! The queue of a hand's events.

use crate::errors::Refusal;
use crate::fork;
use crate::hand::Hand;
use crate::records;
use crate::waiting::{SLICE, duration};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::time::{Duration, Instant};
use sun2xp::HandError;
use sun2xp::events::{Event, EventKind, EventQueue};
use sun2xp::finger::{Fault, FaultKind};
use sun2xp::model::Part;

/// A queue of all events of a hand. It has its own position in the events, and takes none away from other queues.
#[pyclass(frozen, subclass, module = "sun2xp._sun2xp")]
pub struct Queue {
    queue: EventQueue,
    /// The generation of the process that has opened the hand.
    generation: u32,
}

#[pymethods]
impl Queue {
    #[new]
    fn new(hand: &Bound<'_, Hand>) -> PyResult<Self> {
        let queue = hand.get().quick(hand.py(), |hand| Ok(hand.events()))?;
        Ok(Self { queue, generation: fork::generation() })
    }

    /// Takes the earliest event; None if there is no event now.
    fn take<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.check(py)?;
        self.queue.next().map(|event| record(py, &event)).transpose()
    }

    /// Waits for an event, and takes it. Returns None if no event comes within `timeout` s, or if the hand is closed.
    /// Without a timeout, waits without a limit.
    #[pyo3(signature = (timeout=None))]
    fn wait<'py>(&self, py: Python<'py>, timeout: Option<f64>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.check(py)?;
        let limit = duration(py, "timeout", timeout)?;
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        loop {
            let left = deadline.map_or(Duration::MAX, |deadline| deadline.saturating_duration_since(Instant::now()));
            // Between the wait and the time at which this thread has the interpreter lock again, an event may come and
            // the queue may be closed. If `closed` were read after the wait, that event would not be returned.
            let closed = self.queue.is_closed();
            let event = py.detach(|| self.queue.wait(Some(left.min(SLICE))));
            if let Some(event) = event {
                return record(py, &event).map(Some);
            }
            if left.is_zero() || closed {
                return Ok(None);
            }
            py.check_signals()?;
        }
    }

    /// Whether the hand is closed or being closed. While it is being closed, events may still come.
    #[getter]
    fn closed(&self) -> bool {
        self.queue.is_closed()
    }

    /// The number of events that this queue has lost because they were not taken in time. The oldest are lost first.
    #[getter]
    fn lost(&self) -> u64 {
        self.queue.lost()
    }

    /// Discards all events up to now.
    fn clear(&self, py: Python<'_>) -> PyResult<()> {
        self.check(py)?;
        self.queue.clear();
        Ok(())
    }

    /// A descriptor for select, poll and event loops. It is readable while there is an event, and when the hand is
    /// closed. Do not read, write or close it. It stays open until the queue is freed.
    fn fileno(&self, py: Python<'_>) -> PyResult<i32> {
        self.check(py)?;
        let doing = "create the descriptor of events";
        self.queue.descriptor().map_err(|source| Refusal::Hand(HandError::System { doing, source }).raise(py))
    }
}

impl Queue {
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        if self.generation == fork::generation() { Ok(()) } else { Err(Refusal::Forked.raise(py)) }
    }
}

/// Returns an object of the class `Event`.
fn record<'py>(py: Python<'py>, event: &Event) -> PyResult<Bound<'py, PyAny>> {
    let fields = PyDict::new(py);
    fields.set_item("finger", event.finger.get())?;
    fields.set_item("cycle", event.cycle)?;
    fields.set_item("time", event.time)?;
    fields.set_item("kind", kind(py, event.kind)?)?;
    fields.set_item("part", event.part.to_string())?;
    fields.set_item("values", PyTuple::new(py, &event.values[..places(event.kind)])?)?;
    fields.set_item("text", text(event))?;
    records::record(py, "Event", &fields)
}

/// Returns the member of the Python class `EventKind`.
fn kind<'py>(py: Python<'py>, kind: EventKind) -> PyResult<Bound<'py, PyAny>> {
    py.import("sun2xp._types")?.getattr("EventKind")?.call1((kind.number(),))
}

/// Returns what happened, in words.
fn text(event: &Event) -> String {
    let Event { kind, part, values, .. } = *event;
    if let (EventKind::Fault | EventKind::Warning, Some(number)) = (kind, FaultKind::from_number(values[0] as i32)) {
        let mut fault = Fault::of(number, values[1]);
        fault.part = part;
        return fault.to_string();
    }
    let name = kind.description().name;
    if part == Part::Finger { name.into() } else { format!("{name}, {part}") }
}

/// The numbers and constants of all kinds of events, for the comparison with the Python class
/// `sun2xp.EventKind`.
#[pyfunction]
pub fn event_kinds() -> Vec<(u8, &'static str)> {
    EventKind::ALL.iter().map(|kind| (kind.number(), kind.description().constant)).collect()
}

/// The numbers of all kinds of events, and how many values an event of each kind has, for the comparison with
/// sun2xp/remote/_receiver.py.
#[pyfunction]
pub fn event_values() -> Vec<(u8, usize)> {
    EventKind::ALL.iter().map(|&kind| (kind.number(), places(kind))).collect()
}

/// The number of values of an event.
fn places(kind: EventKind) -> usize {
    kind.description().values.iter().map(|value| value.places()).sum()
}

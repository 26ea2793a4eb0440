//! Detects forked children. A child has the memory of the hand, but not its threads. If a thread of the parent held a
//! lock of the hand at the fork, nothing releases this lock in the child.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::atomic::{AtomicU32, Ordering};

/// Number of forks that lead from the first process to this process.
static GENERATION: AtomicU32 = AtomicU32::new(0);

#[pyfunction]
fn forked() {
    GENERATION.fetch_add(1, Ordering::Relaxed);
}

/// Counts forks by Python from now on.
pub fn watch(py: Python<'_>) -> PyResult<()> {
    let handlers = PyDict::new(py);
    handlers.set_item("after_in_child", pyo3::wrap_pyfunction!(forked, py)?)?;
    py.import("os")?.call_method("register_at_fork", (), Some(&handlers))?;
    Ok(())
}

/// Returns the generation of this process. It is greater in a child than in its parent.
pub fn generation() -> u32 {
    GENERATION.load(Ordering::Relaxed)
}

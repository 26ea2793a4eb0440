//! The class `Hand`: an open hand, until it is closed.

use crate::errors::Refusal;
use crate::fork;
use crate::pending::{self, Pending};
use parking_lot::{Mutex, RwLock};
use pyo3::prelude::*;
use std::sync::{Arc, Weak};

/// All hands that may be open. The end of the interpreter closes them.
static HANDS: Mutex<Vec<Weak<Shared>>> = Mutex::new(Vec::new());

/// The hand that the Python object and the threads of its slow calls share.
pub struct Shared {
    /// None: closed. Locked for writing only to take the hand out.
    hand: RwLock<Option<sun2xp::Hand>>,
    /// [`fork::generation`] in the process that has opened the hand.
    generation: u32,
}

impl Shared {
    /// Calls `action` with the open hand. The lock is free again when this returns, so that the caller may run Python
    /// code, which may close the hand.
    pub fn with<R>(&self, action: impl FnOnce(&sun2xp::Hand) -> Result<R, sun2xp::HandError>) -> Result<R, Refusal> {
        self.check_process()?;
        let hand = self.hand.read();
        let hand = hand.as_ref().ok_or(Refusal::Closed)?;
        Ok(action(hand)?)
    }

    pub fn is_open(&self) -> bool {
        self.check_process().is_ok() && self.hand.read().is_some()
    }

    fn check_process(&self) -> Result<(), Refusal> {
        if self.generation == fork::generation() { Ok(()) } else { Err(Refusal::Forked) }
    }

    /// Closes the hand, if it is open: waits until every finger is in its end state.
    fn close(&self) {
        if self.check_process().is_ok() {
            let _closing = Pending::closing();
            let hand = self.hand.write().take();
            drop(hand);
        }
    }
}

/// An open hand of up to three fingers, whose numbers are in `fingers`. The servo threads run without Python.
///
/// `sun2xp.open()` and `sun2xp.simulated()` open a hand. All methods may be called from several threads.
#[pyclass(frozen, subclass, module = "sun2xp")]
pub struct Hand(pub Arc<Shared>);

impl Hand {
    /// Makes a quick call. It keeps the interpreter lock, because releasing the lock would take longer than the call.
    pub fn quick<R>(
        &self,
        py: Python<'_>,
        action: impl FnOnce(&sun2xp::Hand) -> Result<R, sun2xp::HandError>,
    ) -> PyResult<R> {
        self.0.with(action).map_err(|refusal| refusal.raise(py))
    }

    /// Makes a call that computes or waits for some time. Other Python threads run meanwhile.
    pub fn slow<R: Send>(
        &self,
        py: Python<'_>,
        action: impl FnOnce(&sun2xp::Hand) -> Result<R, sun2xp::HandError> + Send,
    ) -> PyResult<R> {
        py.detach(|| self.0.with(action)).map_err(|refusal| refusal.raise(py))
    }
}

#[pymethods]
impl Hand {
    /// Takes the hand out of an `Opened`. Subclasses are constructed in this way.
    #[new]
    fn new(opened: &Bound<'_, Opened>) -> PyResult<Self> {
        let hand = opened.get().0.lock().take();
        // The hand is in `HANDS` before `_opening` is dropped, so `close_all` cannot miss it.
        let (hand, _opening) = hand.ok_or_else(|| Refusal::Closed.raise(opened.py()))?;
        let shared = Arc::new(Shared { hand: RwLock::new(Some(hand)), generation: fork::generation() });
        let mut hands = HANDS.lock();
        hands.retain(|hand| hand.strong_count() > 0);
        hands.push(Arc::downgrade(&shared));
        Ok(Self(shared))
    }

    /// The numbers of the fingers that the hand has.
    #[getter]
    fn fingers(&self, py: Python<'_>) -> PyResult<Vec<i32>> {
        self.quick(py, |hand| Ok(hand.fingers().numbers().collect()))
    }

    /// Whether the hand is closed.
    #[getter]
    fn closed(&self) -> bool {
        !self.0.is_open()
    }

    /// Brings every finger to its configured end state (`hand.end_state`), and closes the ports. Waits until this is
    /// done, also after Ctrl-C. By default, this takes 0.2 s. Does nothing if the hand is closed.
    fn close(&self, py: Python<'_>) {
        py.detach(|| self.0.close());
    }

    fn __enter__(slf: Bound<'_, Self>) -> Bound<'_, Self> {
        slf
    }

    #[pyo3(signature = (*_exception))]
    fn __exit__(&self, py: Python<'_>, _exception: &Bound<'_, PyAny>) {
        self.close(py);
    }

    fn __repr__(&self) -> String {
        let stages = (1..=3).map(|finger| match self.0.with(|hand| hand.report(finger)) {
            Ok(report) => report.stage.name(),
            Err(_) => "absent",
        });
        if self.0.is_open() {
            format!("<sun2xp.Hand: {}>", stages.collect::<Vec<_>>().join(", "))
        } else {
            "<sun2xp.Hand: closed>".into()
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        // Closing waits, so other threads of Python must run meanwhile.
        Python::attach(|py| py.detach(|| self.0.close()));
    }
}

/// Carries an open hand from the function that opened it to the constructor of `Hand`.
#[pyclass(frozen, module = "sun2xp._sun2xp")]
pub struct Opened(pub Mutex<Option<(sun2xp::Hand, Pending)>>);

impl Drop for Opened {
    fn drop(&mut self) {
        // Ctrl-C may come before the constructor has taken the hand. Closing this hand waits, as closing a `Hand` does.
        if let Some(opened) = self.0.get_mut().take() {
            Python::attach(|py| py.detach(|| drop(opened)));
        }
    }
}

/// Closes all hands at the end of the interpreter, so that their fingers reach their end states. Ends the openings of
/// other threads, and waits until their hands are closed.
#[pyfunction]
pub fn close_all(py: Python<'_>) {
    py.detach(|| {
        pending::end_openings();
        close_listed();
        pending::wait();
        // Openings of other threads may have been completed since the first call. The second call closes their hands.
        close_listed();
    });
}

fn close_listed() {
    let hands = std::mem::take(&mut *HANDS.lock());
    hands.iter().filter_map(Weak::upgrade).for_each(|hand| hand.close());
}

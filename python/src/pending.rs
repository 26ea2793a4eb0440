//! Hands that are opening or closing. The end of the interpreter waits for them, so that no motor keeps pulling its
//! tendon.

use crate::fork;
use parking_lot::{Condvar, Mutex, MutexGuard};
use std::sync::atomic::{AtomicBool, Ordering};

static PENDING: Mutex<State> = Mutex::new(State { generation: 0, ending: false, count: 0 });
static CHANGED: Condvar = Condvar::new();

struct State {
    /// The generation of the process to which the other fields belong. A forked child does not have the threads that
    /// open and close hands.
    generation: u32,
    /// Whether the interpreter is ending.
    ending: bool,
    /// The number of hands that are closing, or that are opening and may have pulled their tendons.
    count: usize,
}

fn state() -> MutexGuard<'static, State> {
    let mut state = PENDING.lock();
    let generation = fork::generation();
    if state.generation != generation {
        *state = State { generation, ending: false, count: 0 };
    }
    state
}

/// Notes that a hand is opening or closing, until this value is dropped.
pub struct Pending {
    counted: AtomicBool,
    generation: u32,
}

impl Pending {
    /// Notes an opening. Until the first call of [`Pending::goes_on`], the end of the interpreter does not wait for
    /// this opening.
    pub fn opening() -> Self {
        Self { counted: AtomicBool::new(false), generation: fork::generation() }
    }

    /// Notes a closing.
    pub fn closing() -> Self {
        state().count += 1;
        Self { counted: AtomicBool::new(true), generation: fork::generation() }
    }

    /// Returns whether the opening may go on. It may unless the interpreter is ending. If it may go on, the end of the
    /// interpreter waits for this opening from now on.
    pub fn goes_on(&self) -> bool {
        let mut state = state();
        if !state.ending && !self.counted.swap(true, Ordering::Relaxed) {
            state.count += 1;
        }
        !state.ending
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        let mut state = state();
        if *self.counted.get_mut() && self.generation == state.generation {
            state.count -= 1;
            CHANGED.notify_all();
        }
    }
}

/// Requests all openings to end. Each opening ends at its next call of [`Pending::goes_on`].
pub fn end_openings() {
    state().ending = true;
}

/// Waits until no hand is closing, and until no opening is left for which the end of the interpreter waits.
pub fn wait() {
    let mut state = state();
    while state.count > 0 {
        CHANGED.wait(&mut state);
    }
}

//! Replaces `src/realtime/atomics.rs` with the types of loom. The orderings can be weakened, to show that the checks
//! detect a missing ordering.

use loom::sync::atomic;
use std::cell::Cell;

pub use loom::cell::UnsafeCell;
pub use loom::sync::atomic::Ordering;

thread_local! {
    /// Whether every access is relaxed. Loom runs all threads of a check on the thread of the test, so they share this
    /// value.
    static WEAKENED: Cell<bool> = const { Cell::new(false) };
}

/// Calls `check` with every access relaxed, as if the code had no orderings.
pub fn weakened<R>(check: impl FnOnce() -> R) -> R {
    WEAKENED.set(true);
    let result = check();
    WEAKENED.set(false);
    result
}

fn ordering(intended: Ordering) -> Ordering {
    if WEAKENED.get() { Ordering::Relaxed } else { intended }
}

/// A fence. There is none if every access is relaxed.
pub fn fence(intended: Ordering) {
    if !WEAKENED.get() {
        atomic::fence(intended);
    }
}

macro_rules! atomic {
    ($name:ident, $value:ty) => {
        pub struct $name(atomic::$name);

        impl $name {
            pub fn new(value: $value) -> Self {
                Self(atomic::$name::new(value))
            }

            pub fn load(&self, intended: Ordering) -> $value {
                self.0.load(ordering(intended))
            }

            pub fn store(&self, value: $value, intended: Ordering) {
                self.0.store(value, ordering(intended));
            }

            pub fn swap(&self, value: $value, intended: Ordering) -> $value {
                self.0.swap(value, ordering(intended))
            }
        }
    };
}

atomic!(AtomicBool, bool);
atomic!(AtomicU8, u8);
atomic!(AtomicU32, u32);
atomic!(AtomicU64, u64);
atomic!(AtomicUsize, usize);

impl AtomicU32 {
    pub fn fetch_add(&self, by: u32, intended: Ordering) -> u32 {
        self.0.fetch_add(by, ordering(intended))
    }
}

impl AtomicU64 {
    pub fn fetch_add(&self, by: u64, intended: Ordering) -> u64 {
        self.0.fetch_add(by, ordering(intended))
    }

    pub fn compare_exchange(&self, old: u64, new: u64, done: Ordering, failed: Ordering) -> Result<u64, u64> {
        self.0.compare_exchange(old, new, ordering(done), ordering(failed))
    }
}

/// Declares a static counter. Loom creates it anew for every run.
macro_rules! static_counter {
    ($(#[$attribute:meta])* $name:ident) => {
        loom::lazy_static! {
            $(#[$attribute])*
            static ref $name: $crate::realtime::atomics::AtomicU32 = $crate::realtime::atomics::AtomicU32::new(0);
        }
    };
}
pub(crate) use static_counter;

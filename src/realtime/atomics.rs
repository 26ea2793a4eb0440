//! The atomic types and the cell of the lock-free code. The package in `models/` compiles the lock-free files again
//! with the types of the model checker loom in place of this file. So the code that is checked is the code that runs.

pub use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, AtomicUsize, Ordering, fence};

/// Memory that two threads access in turns. It has the interface of loom's cell. That cell reports a data race: two
/// accesses by different threads, at least one of them a write, that no happens-before relation orders.
pub struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

impl<T> UnsafeCell<T> {
    /// Creates a cell.
    pub fn new(value: T) -> Self {
        Self(std::cell::UnsafeCell::new(value))
    }

    /// Calls `read` with a pointer to the value.
    pub fn with<R>(&self, read: impl FnOnce(*const T) -> R) -> R {
        read(self.0.get())
    }

    /// Calls `access` with a pointer to the value.
    pub fn with_mut<R>(&self, access: impl FnOnce(*mut T) -> R) -> R {
        access(self.0.get())
    }
}

/// Declares a static counter that begins at 0.
macro_rules! static_counter {
    ($(#[$attribute:meta])* $name:ident) => {
        $(#[$attribute])*
        static $name: $crate::realtime::atomics::AtomicU32 = $crate::realtime::atomics::AtomicU32::new(0);
    };
}
pub(crate) use static_counter;

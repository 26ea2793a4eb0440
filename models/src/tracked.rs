//! A value whose accesses loom tracks.

use crate::realtime::atomics::UnsafeCell;

/// A number that two threads access in turns. Loom fails a check if one thread writes the number and nothing orders
/// this write before or after an access of the other thread.
pub struct Tracked(UnsafeCell<u32>);

impl Tracked {
    pub fn new(number: u32) -> Self {
        Self(UnsafeCell::new(number))
    }

    pub fn get(&self) -> u32 {
        // SAFETY: the pointer is valid. Loom fails the check if a write is concurrent.
        self.0.with(|number| unsafe { *number })
    }

    pub fn set(&mut self, new: u32) {
        // SAFETY: the pointer is valid. Loom fails the check if another access is concurrent.
        self.0.with_mut(|number| unsafe { *number = new });
    }
}

impl Clone for Tracked {
    fn clone(&self) -> Self {
        Self::new(self.get())
    }
}

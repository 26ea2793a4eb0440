//! Copies of the records that a black box collects, for telemetry.

use crate::control::State;
use crate::finger::CycleRecord;
use std::collections::TryReserveError;

/// Capacity, s. The records are taken out twenty times a second. In between, the thread that collects and the
/// calls of planners add records.
const CAPACITY: f64 = 1.0;

/// The controller's state before a cycle.
#[derive(Clone, Copy)]
pub struct Keyframe {
    /// Number of the cycle.
    pub cycle: u64,
    /// The state.
    pub state: State,
}

/// Records and keyframes in the order of their cycles. If the outlet is full, further records and keyframes are
/// dropped. The numbers of the cycles then show that some are missing.
#[derive(Default)]
pub struct Outlet {
    /// The records.
    pub records: Vec<CycleRecord>,
    /// The keyframes.
    pub keyframes: Vec<Keyframe>,
}

impl Outlet {
    /// Creates an empty outlet of a finger whose servo runs at `rate`, Hz.
    ///
    /// # Errors
    /// Returns an error if there is not enough memory.
    pub fn new(rate: f64, keyframes_per_second: f64) -> Result<Self, TryReserveError> {
        let mut outlet = Self::default();
        outlet.records.try_reserve_exact((CAPACITY * rate).ceil() as usize)?;
        outlet.keyframes.try_reserve_exact((CAPACITY * keyframes_per_second).ceil() as usize + 2)?;
        Ok(outlet)
    }

    /// Removes everything, and keeps the memory.
    pub fn clear(&mut self) {
        self.records.clear();
        self.keyframes.clear();
    }

    pub(super) fn add_record(&mut self, record: &CycleRecord) {
        // The capacity is fixed, because the collector must not allocate.
        if self.records.len() < self.records.capacity() {
            self.records.push(*record);
        }
    }

    pub(super) fn add_keyframe(&mut self, keyframe: &Keyframe) {
        if self.keyframes.len() < self.keyframes.capacity() {
            self.keyframes.push(*keyframe);
        }
    }
}

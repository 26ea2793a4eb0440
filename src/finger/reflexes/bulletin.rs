//! Counters of the events of every finger, one counter for each kind. A servo reads the counters of the other fingers
//! without waiting.

use crate::finger::events::EventKind;
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
use crate::realtime::atomics::{AtomicU32, Ordering};
use crate::realtime::{LockedMemory, Pages, SharedPages};

/// Number of counters of a finger. Kinds have numbers from 1, so the counter with the index 0 is not used.
const KINDS: usize = 32;
const _: () = assert!(EventKind::ALL.len() < KINDS, "a kind has no place");

/// The counters. All clones share them.
#[derive(Clone)]
pub struct Bulletin(SharedPages<[[AtomicU32; KINDS]; FINGERS]>);

impl Bulletin {
    /// Creates counters of a hand.
    pub fn new() -> Self {
        let counters = std::array::from_fn(|_| std::array::from_fn(|_| AtomicU32::new(0)));
        Self(Pages::new(counters).into())
    }

    /// Adds the pages of the counters to `memory`.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.0);
    }

    /// Counts events of a finger, at most one of each kind. Bit n of `kinds` stands for the kind with the number n.
    pub(super) fn count(&self, finger: FingerNumber, mut kinds: u32) {
        while kinds != 0 {
            let number = kinds.trailing_zeros();
            self.0[finger.index()][number as usize].fetch_add(1, Ordering::Release);
            kinds &= kinds - 1;
        }
    }

    /// Returns how often events of this kind have been counted, modulo 2^32.
    pub(super) fn counted(&self, finger: FingerNumber, kind: EventKind) -> u32 {
        self.0[finger.index()][usize::from(kind.number())].load(Ordering::Acquire)
    }
}

impl Default for Bulletin {
    fn default() -> Self {
        Self::new()
    }
}

//! The newest readings of a finger's tactile elements, which its servo writes and planners read. Neither side waits for
//! the other.

use crate::board::protocol::{TactileChange, TactileEvent};
use crate::model::configuration::ConfiguredTouch;
use crate::realtime::{LockedMemory, Pages, SharedPages};
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// The newest reading of a tactile element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct TouchReading {
    /// Whether the board has reported this element since open and since the last reset of the board, and could read the
    /// element at the newest of these reports. Otherwise the other fields are 0. A reset of the board makes the
    /// readings invalid only when the finger recovers. A recovery from a fault of the line or of the port counts as a
    /// reset.
    pub valid: bool,
    /// Whether something presses the element.
    pub pressed: bool,
    /// The raw count.
    pub count: u16,
    /// The force on the element, N: the count minus its zero, times `newton_per_count`.
    pub force: f64,
}

/// The elements of a finger. All clones share the same elements.
#[derive(Clone)]
pub struct Elements(SharedPages<Shared>);

struct Shared {
    elements: Pages<[Element]>,
    /// Number of events that the board has lost since open.
    lost: AtomicU64,
    /// Number of events that name an element that is not configured.
    unknown: AtomicU64,
}

struct Element {
    newton_per_count: f64,
    /// Count of the element when nothing presses it.
    zero: AtomicU32,
    /// The newest count, with [`VALID`] and [`PRESSED`].
    reading: AtomicU32,
}

/// The element could be read.
const VALID: u32 = 1 << 16;
/// Something presses the element.
const PRESSED: u32 = 1 << 17;

impl Element {
    fn reading(&self) -> TouchReading {
        let reading = self.reading.load(Ordering::Acquire);
        if reading & VALID == 0 {
            return TouchReading::default();
        }
        let count = reading as u16;
        let zero = self.zero.load(Ordering::Acquire);
        let force = (f64::from(count) - f64::from(zero)) * self.newton_per_count;
        TouchReading { valid: true, pressed: reading & PRESSED != 0, count, force }
    }
}

impl Elements {
    /// Creates the configured elements, without readings.
    pub fn new(touch: &ConfiguredTouch) -> Self {
        let elements = Pages::from_fn(touch.elements.len(), |element| Element {
            newton_per_count: touch.elements[element].newton_per_count,
            zero: AtomicU32::new(touch.elements[element].zero.into()),
            reading: AtomicU32::new(0),
        });
        let shared = Shared { elements, lost: AtomicU64::new(0), unknown: AtomicU64::new(0) };
        Self(SharedPages::from(Pages::new(shared)))
    }

    /// Adds the pages of the elements to `memory`.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.0);
        memory.add(&self.0.elements);
    }

    /// Returns the number of elements.
    pub fn count(&self) -> usize {
        self.0.elements.len()
    }

    /// Returns the newest reading of an element, counted from 0. Returns none if there is no such element.
    pub fn reading(&self, element: usize) -> Option<TouchReading> {
        self.0.elements.get(element).map(Element::reading)
    }

    /// Makes the newest count of every element its zero. An element without a valid reading keeps its zero.
    pub fn tare(&self) {
        for element in self.0.elements.iter() {
            let reading = element.reading();
            if reading.valid {
                element.zero.store(reading.count.into(), Ordering::Release);
            }
        }
    }

    /// Returns the zeros of all elements, counts.
    pub fn zeros(&self) -> Vec<u16> {
        self.0.elements.iter().map(|element| element.zero.load(Ordering::Acquire) as u16).collect()
    }

    /// Returns the number of events that the board has lost since open, because they did not fit into its queue.
    pub fn lost(&self) -> u64 {
        self.0.lost.load(Ordering::Acquire)
    }

    /// Returns the number of events of elements that are not configured.
    pub fn unknown(&self) -> u64 {
        self.0.unknown.load(Ordering::Acquire)
    }

    /// Makes all readings invalid.
    pub(super) fn forget_readings(&self) {
        self.0.elements.iter().for_each(|element| element.reading.store(0, Ordering::Release));
    }

    /// Counts events that the board has lost.
    pub(super) fn count_lost(&self, lost: u8) {
        self.0.lost.fetch_add(lost.into(), Ordering::Release);
    }

    /// Stores the reading of an event, and returns it. Counts the event and returns none if the element is not
    /// configured.
    pub(super) fn store(&self, event: &TactileEvent) -> Option<TouchReading> {
        let Some(element) = self.0.elements.get(usize::from(event.element)) else {
            self.0.unknown.fetch_add(1, Ordering::Release);
            return None;
        };
        let before = element.reading.load(Ordering::Relaxed) & PRESSED;
        let flags = match event.change {
            TactileChange::Made => VALID | PRESSED,
            TactileChange::Lost => VALID,
            TactileChange::Invalid | TactileChange::Nothing => 0,
            TactileChange::Slip | TactileChange::Pressure | TactileChange::Other(_) => VALID | before,
        };
        let count = if flags & VALID != 0 { u32::from(event.count) } else { 0 };
        element.reading.store(count | flags, Ordering::Release);
        Some(element.reading())
    }
}

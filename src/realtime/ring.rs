//! A wait-free queue from one thread to another: a ring in memory pages of its own.
#![allow(unsafe_code, reason = "places that two threads access in turns")]

use super::LockedMemory;
use super::atomics::{AtomicUsize, Ordering, UnsafeCell};
use super::pages::{Pages, SharedPages};
use std::mem::MaybeUninit;

/// The writer's end of a ring.
pub struct Producer<T> {
    ring: SharedPages<Ring<T>>,
    /// The value of the ring's counter `put`. Only this end changes this counter.
    put: usize,
}

/// The reader's end of a ring.
pub struct Consumer<T> {
    ring: SharedPages<Ring<T>>,
    /// The value of the ring's counter `taken`. Only this end changes this counter.
    taken: usize,
}

/// `put` counts the values that the writer has put into the ring, and `taken` counts those that the reader has taken.
/// Both counters start again at 0 when they reach twice the number of places, so that a full ring differs from an empty
/// one. The places from `taken` to `put` hold values.
struct Ring<T> {
    put: Line<AtomicUsize>,
    taken: Line<AtomicUsize>,
    places: Pages<[UnsafeCell<MaybeUninit<T>>]>,
}

/// A value in cache lines of its own.
#[repr(align(128))]
struct Line<T>(T);

// SAFETY: only the writer accesses a place until `put` has passed it. From then on, only the reader accesses the
// place until `taken` has passed it.
unsafe impl<T: Send> Sync for Ring<T> {}

/// Returns both ends of a ring with room for `capacity` values, or for one value if `capacity` is 0.
pub fn ring<T>(capacity: usize) -> (Producer<T>, Consumer<T>) {
    let ring = Ring {
        put: Line(AtomicUsize::new(0)),
        taken: Line(AtomicUsize::new(0)),
        places: Pages::from_fn(capacity.max(1), |_| UnsafeCell::new(MaybeUninit::uninit())),
    };
    let ring = SharedPages::from(Pages::new(ring));
    (Producer { ring: ring.clone(), put: 0 }, Consumer { ring, taken: 0 })
}

impl<T> Ring<T> {
    fn place(&self, number: usize) -> &UnsafeCell<MaybeUninit<T>> {
        let count = self.places.len();
        &self.places[if number < count { number } else { number - count }]
    }

    fn after(&self, number: usize) -> usize {
        if number + 1 == 2 * self.places.len() { 0 } else { number + 1 }
    }

    /// The number of values between two counters.
    fn count(&self, taken: usize, put: usize) -> usize {
        if put >= taken { put - taken } else { put + 2 * self.places.len() - taken }
    }
}

impl<T> Producer<T> {
    /// Appends a value.
    ///
    /// # Errors
    /// Returns the value itself if the ring is full.
    pub fn push(&mut self, value: T) -> Result<(), T> {
        let (ring, put) = (&*self.ring, self.put);
        if ring.count(ring.taken.0.load(Ordering::Acquire), put) == ring.places.len() {
            return Err(value);
        }
        // SAFETY: the reader has taken the previous value of this place, and does not access it before `put` has
        // passed it.
        ring.place(put).with_mut(|place| unsafe {
            (*place).write(value);
        });
        self.put = ring.after(put);
        ring.put.0.store(self.put, Ordering::Release);
        Ok(())
    }

    /// Whether the reader has taken every value.
    pub fn is_empty(&self) -> bool {
        self.put == self.ring.taken.0.load(Ordering::Acquire)
    }

    /// Whether the next push succeeds.
    pub fn has_room(&self) -> bool {
        let ring = &*self.ring;
        ring.count(ring.taken.0.load(Ordering::Acquire), self.put) < ring.places.len()
    }

    /// Adds the ring's pages to `memory`.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.ring);
        memory.add(&self.ring.places);
    }
}

impl<T> Consumer<T> {
    /// Takes the oldest value. Returns `None` if the ring is empty.
    pub fn pop(&mut self) -> Option<T> {
        let (ring, taken) = (&*self.ring, self.taken);
        if taken == ring.put.0.load(Ordering::Acquire) {
            return None;
        }
        // SAFETY: the writer has put a value here, and does not access the place again before `taken` has passed it.
        let value = ring.place(taken).with(|place| unsafe { (*place).assume_init_read() });
        self.taken = ring.after(taken);
        ring.taken.0.store(self.taken, Ordering::Release);
        Some(value)
    }

    /// Whether the ring is empty.
    pub fn is_empty(&self) -> bool {
        self.taken == self.ring.put.0.load(Ordering::Acquire)
    }

    /// Adds the ring's pages to `memory`.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.ring);
        memory.add(&self.ring.places);
    }

    /// Whether the writer's end has been dropped.
    pub fn is_abandoned(&self) -> bool {
        self.ring.is_alone()
    }
}

impl<T> Drop for Ring<T> {
    fn drop(&mut self) {
        // Both ends are gone, so no thread changes the counters any more.
        let (mut taken, put) = (self.taken.0.load(Ordering::Relaxed), self.put.0.load(Ordering::Relaxed));
        while taken != put {
            // SAFETY: both ends are gone. The writer put this value here, and the reader did not take it.
            self.place(taken).with_mut(|place| unsafe { (*place).assume_init_drop() });
            taken = self.after(taken);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::thread;

    #[test]
    fn a_full_ring_gives_the_value_back() {
        let (mut producer, mut consumer) = ring(2);
        assert_eq!(consumer.pop(), None);
        assert_eq!([producer.push(1), producer.push(2), producer.push(3)], [Ok(()), Ok(()), Err(3)]);
        assert_eq!(consumer.pop(), Some(1));
        assert_eq!(producer.push(4), Ok(()));
        assert_eq!([consumer.pop(), consumer.pop(), consumer.pop()], [Some(2), Some(4), None]);
    }

    #[test]
    fn values_that_were_not_taken_are_dropped_with_the_ring() {
        let witness = Arc::new(());
        let (mut producer, mut consumer) = ring(4);
        for _ in 0..4 {
            producer.push(witness.clone()).expect("room");
        }
        drop(consumer.pop());
        assert!(!consumer.is_abandoned());
        drop(producer);
        assert!(consumer.is_abandoned());
        assert_eq!(Arc::strong_count(&witness), 4);
        drop(consumer);
        assert_eq!(Arc::strong_count(&witness), 1);
    }

    #[test]
    fn every_value_comes_whole_and_in_order() {
        const LAST: u64 = 200_000;
        let (mut producer, mut consumer) = ring(13);
        let writer = thread::spawn(move || {
            for number in 1..=LAST {
                while producer.push([number; 32]).is_err() {
                    thread::yield_now();
                }
            }
        });
        for number in 1..=LAST {
            let value = loop {
                match consumer.pop() {
                    Some(value) => break value,
                    None => thread::yield_now(),
                }
            };
            assert_eq!(value, [number; 32]);
        }
        writer.join().expect("no panic");
    }
}

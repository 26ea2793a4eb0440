//! A wait-free channel that passes the newest value of one thread to another. It has three places in memory pages of
//! their own. One place belongs to the writer, and one to the reader. Each end swaps its place for the third one.
#![allow(unsafe_code, reason = "places that two threads access in turns")]

use super::LockedMemory;
use super::atomics::{AtomicU8, Ordering, UnsafeCell};
use super::pages::{Pages, SharedPages};

/// Bit of `between`: the writer has published a value that the reader has not taken yet.
const NEW: u8 = 4;

/// Bits of `between` that hold the number of the place.
const PLACE: u8 = 3;

/// The writer's end of a triple buffer.
pub struct Input<T> {
    places: SharedPages<Places<T>>,
    own: u8,
}

/// The reader's end of a triple buffer.
pub struct Output<T> {
    places: SharedPages<Places<T>>,
    own: u8,
}

struct Places<T> {
    /// The number of the place that belongs to neither end, and the bit [`NEW`]. This field has cache lines of its own,
    /// because both threads write to it.
    between: Line<AtomicU8>,
    places: [Line<UnsafeCell<T>>; 3],
}

/// A value in cache lines of its own.
#[repr(align(128))]
struct Line<T>(T);

// SAFETY: only the end that has the number of a place accesses that place. `T` is `Send`, because values move between
// threads.
unsafe impl<T: Send> Sync for Places<T> {}

/// Returns both ends, with the same value in every place.
pub fn triple_buffer<T: Clone>(initial: &T) -> (Input<T>, Output<T>) {
    triple_buffer_of(|| initial.clone())
}

/// Returns both ends. `make` makes the value of each place.
pub fn triple_buffer_of<T>(mut make: impl FnMut() -> T) -> (Input<T>, Output<T>) {
    let places = [(); 3].map(|()| Line(UnsafeCell::new(make())));
    let places = SharedPages::from(Pages::new(Places { between: Line(AtomicU8::new(1)), places }));
    (Input { places: places.clone(), own: 0 }, Output { places, own: 2 })
}

impl<T> Input<T> {
    /// Returns the buffer for the next value to publish. It still holds an older value.
    pub fn input_buffer_mut(&mut self) -> &mut T {
        // SAFETY: only this end has the number of this place, and this end is borrowed mutably.
        self.places.places[usize::from(self.own)].0.with_mut(|value| unsafe { &mut *value })
    }

    /// Publishes the buffer.
    pub fn publish(&mut self) {
        // Release: the value was written before this swap. Acquire: the reader has finished reading the place that this
        // end gets back.
        self.own = self.places.between.0.swap(self.own | NEW, Ordering::AcqRel) & PLACE;
    }

    /// Publishes a value.
    pub fn write(&mut self, value: T) {
        *self.input_buffer_mut() = value;
        self.publish();
    }

    /// Adds the buffer's pages to `memory`.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.places);
    }
}

impl<T> Output<T> {
    /// Takes the newest value if a value was published since the last call. Returns whether it took a value.
    pub fn update(&mut self) -> bool {
        let between = &self.places.between.0;
        if between.load(Ordering::Relaxed) & NEW == 0 {
            return false;
        }
        // Acquire: the value is complete. Release: this end has finished reading the place that it gives back.
        self.own = between.swap(self.own, Ordering::AcqRel) & PLACE;
        true
    }

    /// Returns the value that was taken last.
    pub fn output_buffer(&mut self) -> &T {
        // SAFETY: only this end has the number of this place, and this end is borrowed mutably.
        self.places.places[usize::from(self.own)].0.with(|value| unsafe { &*value })
    }

    /// Takes the newest value if there is one, and returns the value that was taken last.
    pub fn read(&mut self) -> &T {
        self.update();
        self.output_buffer()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    #[test]
    fn the_reader_sees_the_newest_value_once_as_new() {
        let (mut input, mut output) = triple_buffer(&0);
        assert!(!output.update());
        assert_eq!(*output.read(), 0);
        input.write(1);
        input.write(2);
        assert!(output.update());
        assert_eq!(*output.output_buffer(), 2);
        assert!(!output.update());
        *input.input_buffer_mut() = 3;
        assert_eq!(*output.read(), 2);
        input.publish();
        assert_eq!(*output.read(), 3);
    }

    /// If both threads accessed a place at once, its entries would differ. A value that came late would be smaller than
    /// the one before.
    #[test]
    fn values_are_whole_and_in_order() {
        const LAST: u64 = 200_000;
        let (mut input, mut output) = triple_buffer(&[0u64; 64]);
        let writer = thread::spawn(move || (1..=LAST).for_each(|number| input.write([number; 64])));
        let mut last = 0;
        while last < LAST {
            let value = *output.read();
            assert!(value.iter().all(|&entry| entry == value[0]), "{value:?}");
            assert!(value[0] >= last, "{} after {last}", value[0]);
            last = value[0];
        }
        writer.join().expect("no panic");
    }
}

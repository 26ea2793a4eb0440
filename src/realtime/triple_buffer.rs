//! The newest value of one thread for another, wait-free on both sides: three places in pages of their own. One is the
//! writer's, one the reader's, and the third changes hands.
#![allow(unsafe_code, reason = "places that two threads take turns at")]

use super::LockedMemory;
use super::pages::{Pages, SharedPages};
use std::cell::UnsafeCell;
use std::sync::atomic::{AtomicU8, Ordering};

/// In the number of the place between: the writer has left it since the reader took one.
const NEW: u8 = 4;

/// Where the number of a place is.
const PLACE: u8 = 3;

/// The writer's end.
pub struct Input<T> {
    places: SharedPages<Places<T>>,
    own: u8,
}

/// The reader's end.
pub struct Output<T> {
    places: SharedPages<Places<T>>,
    own: u8,
}

struct Places<T> {
    /// Apart from the values: both threads write to it.
    between: Line<AtomicU8>,
    places: [Line<UnsafeCell<T>>; 3],
}

/// In cache lines of its own.
#[repr(align(128))]
struct Line<T>(T);

// SAFETY: a place is reached by one end at a time, the one that has its number, and values go from one thread to
// another.
unsafe impl<T: Send> Sync for Places<T> {}

/// Both ends, with the same value in every place.
pub fn triple_buffer<T: Clone>(initial: &T) -> (Input<T>, Output<T>) {
    let places = [(); 3].map(|()| Line(UnsafeCell::new(initial.clone())));
    let places = SharedPages::from(Pages::new(Places { between: Line(AtomicU8::new(1)), places }));
    (Input { places: places.clone(), own: 0 }, Output { places, own: 2 })
}

impl<T> Input<T> {
    /// The value that is published next. What is in it is that of some time ago.
    pub fn input_buffer_mut(&mut self) -> &mut T {
        // SAFETY: the number of this place is nowhere else, and this end is borrowed mutably.
        unsafe { &mut *self.places.places[usize::from(self.own)].0.get() }
    }

    /// Publishes it.
    pub fn publish(&mut self) {
        // Released: the value. Acquired: what the reader has read of the place that it gave back.
        self.own = self.places.between.0.swap(self.own | NEW, Ordering::AcqRel) & PLACE;
    }

    /// Publishes a value.
    pub fn write(&mut self, value: T) {
        *self.input_buffer_mut() = value;
        self.publish();
    }

    /// Adds its pages.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.places);
    }
}

impl<T> Output<T> {
    /// Takes the newest value, if there is one since the last call; whether there was.
    pub fn update(&mut self) -> bool {
        let between = &self.places.between.0;
        if between.load(Ordering::Relaxed) & NEW == 0 {
            return false;
        }
        // Acquired: the value. Released: what was read of the place that is given back.
        self.own = between.swap(self.own, Ordering::AcqRel) & PLACE;
        true
    }

    /// The value that was taken last.
    pub fn output_buffer(&mut self) -> &T {
        // SAFETY: the number of this place is nowhere else, and this end is borrowed mutably.
        unsafe { &*self.places.places[usize::from(self.own)].0.get() }
    }

    /// The newest value.
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

    /// A value that two threads reached at once would have entries of different ages, and a value that comes late would
    /// be older than one before it.
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

//! Measures the cases of a table row in parallel. Every case has its own finger and its own random numbers, so the
//! order does not matter.

use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Calls `measure` for every item with its number, on one thread per core. Returns the results in the order of the
/// items.
pub fn each<Item: Sync, Found: Send>(items: &[Item], measure: impl Fn(usize, &Item) -> Found + Sync) -> Vec<Found> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let (next, found) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(items.len())));
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((number, item)) = {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    items.get(number).map(|item| (number, item))
                } {
                    let one = measure(number, item);
                    found.lock().expect("no case panics").push((number, one));
                }
            });
        }
    });
    let mut found = found.into_inner().expect("no case panics");
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, one)| one).collect()
}

/// Returns the largest value. NaN counts as larger than any number.
pub fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    let beyond = |value: f64| if value.is_nan() { f64::INFINITY } else { value };
    values.into_iter().map(beyond).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the smallest value. NaN counts as smaller than any number.
pub fn least(values: impl IntoIterator<Item = f64>) -> f64 {
    -worst(values.into_iter().map(|value| -value))
}

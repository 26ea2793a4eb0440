//! Measurements on all cores.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Returns `measure` of every item, in order. It uses as many threads as there are cores. A thread takes the next item
/// when it has finished one. This balances the load, because items can take very different times.
pub(super) fn in_parallel<Item: Sync, Found: Send>(
    items: &[Item],
    measure: impl Fn(&Item) -> Found + Sync,
) -> Vec<Found> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut found = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else { return found };
            found.push((index, measure(item)));
        }
    };
    let mut found: Vec<(usize, Found)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no measurement panics")).collect()
    });
    found.sort_by_key(|&(index, _)| index);
    found.into_iter().map(|(_, found)| found).collect()
}

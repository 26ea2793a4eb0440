//! An event count: ordinary threads wait until a servo notifies them, and the servo never waits.
//!
//! The servo makes a system call only if a thread waits, and wakes one thread, so that the duration of the call does
//! not depend on the number of threads. That thread wakes the others.

use super::clock::now;
use super::futex;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering, fence};

/// Longest time for which a thread sleeps before it checks its condition again, ns.
const LONGEST_SLEEP: u64 = 100_000_000;

/// An event count. A waiting thread calls [`EventCount::prepare`], then checks its condition, and then calls
/// [`EventCount::wait`]. It misses no notification between these steps.
#[derive(Debug, Default)]
pub struct EventCount {
    /// Number of notifications that found a waiting thread, modulo 2^32.
    count: AtomicU32,
    /// Whether a thread has called [`EventCount::prepare`] since the last notification.
    waiting: AtomicBool,
}

impl EventCount {
    /// Notifies the waiting threads, after the caller has changed what they wait for. Makes one system call if a thread
    /// waits, and otherwise none. It does not wait, so a servo may call it.
    pub fn notify(&self) {
        // This fence and the one in `prepare` order the change, the flag and the condition: either this thread sees the
        // flag, or the waiting thread sees the change.
        fence(Ordering::SeqCst);
        if self.waiting.load(Ordering::Relaxed) && self.waiting.swap(false, Ordering::Relaxed) {
            self.count.fetch_add(1, Ordering::Release);
            futex::wake(&self.count, 1);
        }
    }

    /// Begins to wait. The caller then checks its condition. If the condition does not hold, the caller calls
    /// [`EventCount::wait`] with the number that this function has returned.
    pub fn prepare(&self) -> u32 {
        let count = self.count.load(Ordering::Acquire);
        self.waiting.store(true, Ordering::Relaxed);
        fence(Ordering::SeqCst);
        count
    }

    /// Waits for a notification that comes after the call of [`EventCount::prepare`] that returned `prepared`. Waits
    /// for at most 0.1 s, and not after `deadline`, ns of the monotonic clock. The caller then checks its condition
    /// again.
    pub fn wait(&self, prepared: u32, deadline: u64) {
        let limit = deadline.saturating_sub(now()).min(LONGEST_SLEEP);
        if limit > 0 && futex::wait(&self.count, prepared, limit) {
            futex::wake(&self.count, i32::MAX);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicU64;
    use std::thread;
    use std::time::Duration;

    #[test]
    fn every_waiting_thread_sees_every_change() {
        const LAST: u64 = 20_000;
        let (events, changes) = (EventCount::default(), AtomicU64::new(0));
        let follow = || {
            let mut seen = 0;
            while seen < LAST {
                let prepared = events.prepare();
                let present = changes.load(Ordering::Relaxed);
                if present != seen {
                    seen = present;
                    continue;
                }
                events.wait(prepared, u64::MAX);
            }
        };
        thread::scope(|scope| {
            let readers = [(); 3].map(|()| scope.spawn(follow));
            for number in 1..=LAST {
                changes.store(number, Ordering::Relaxed);
                events.notify();
                if number % 64 == 0 {
                    thread::yield_now();
                }
            }
            readers.into_iter().for_each(|reader| reader.join().expect("no panic"));
        });
    }

    /// A thread that is not woken sees a change only when its longest sleep ends.
    #[test]
    fn sleeping_threads_are_woken() {
        const ROUNDS: u64 = 300;
        let (events, changes) = (EventCount::default(), AtomicU64::new(0));
        let seen = [const { AtomicU64::new(0) }; 3];
        let follow = |own: &AtomicU64| {
            while own.load(Ordering::Relaxed) < ROUNDS {
                let prepared = events.prepare();
                let present = changes.load(Ordering::Relaxed);
                if own.swap(present, Ordering::Relaxed) == present {
                    events.wait(prepared, u64::MAX);
                }
            }
        };
        let slow = thread::scope(|scope| {
            seen.iter().for_each(|own| drop(scope.spawn(|| follow(own))));
            let mut slow = 0;
            for number in 1..=ROUNDS {
                // After this time, most of the threads are asleep.
                thread::sleep(Duration::from_millis(1));
                changes.store(if slow < ROUNDS / 2 { number } else { ROUNDS }, Ordering::Relaxed);
                let began = now();
                events.notify();
                while seen.iter().any(|own| own.load(Ordering::Relaxed) < number) {
                    thread::sleep(Duration::from_micros(50));
                }
                slow += u64::from(now() - began > LONGEST_SLEEP / 2);
            }
            slow
        });
        assert!(slow < ROUNDS / 2, "in {slow} of {ROUNDS} rounds a thread was not woken");
    }

    #[test]
    fn a_wait_ends_at_its_deadline_and_a_notification_before_the_wait_is_not_missed() {
        let events = EventCount::default();
        let began = now();
        events.wait(events.prepare(), began + 5_000_000);
        assert!(now() - began >= 5_000_000);
        let prepared = events.prepare();
        events.notify();
        // The count has changed, so the next wait returns at once. Otherwise it would return after 0.1 s.
        let began = now();
        events.wait(prepared, u64::MAX);
        assert!(now() - began < LONGEST_SLEEP);
        let (before, after) = (events.count.load(Ordering::Relaxed), {
            events.notify();
            events.count.load(Ordering::Relaxed)
        });
        assert_eq!(before, after, "nobody waits");
    }
}

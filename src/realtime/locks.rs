//! Locks between threads that are not servos. This module uses the locks of the standard library, which wait on a futex
//! word and never allocate. Locks with a table of waiting threads, such as the locks of parking_lot, allocate when a
//! thread waits for the first time. If the process is out of memory, this allocation would end it while a hand may be
//! in motion.
//!
//! A lock stays usable after a panic of the thread that held it. The C interface catches panics, and it must be
//! possible to close a hand after a panic.

use super::clock::now;
use std::sync::{self, MutexGuard, PoisonError, RwLockReadGuard, RwLockWriteGuard, TryLockError};
use std::thread::sleep;
use std::time::Duration;

/// Interval at which [`try_for`] tries again.
const RETRY_INTERVAL: Duration = Duration::from_millis(1);

/// Mutual exclusion of threads.
#[derive(Debug, Default)]
pub struct Mutex<T>(sync::Mutex<T>);

impl<T> Mutex<T> {
    /// An unlocked mutex.
    pub const fn new(value: T) -> Self {
        Self(sync::Mutex::new(value))
    }

    /// Waits until no other thread has the lock.
    pub fn lock(&self) -> MutexGuard<'_, T> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Locks without waiting. Returns `None` if a thread has the lock.
    pub fn try_lock(&self) -> Option<MutexGuard<'_, T>> {
        match self.0.try_lock() {
            Ok(guard) => Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }
}

/// A lock for many readers or one writer.
#[derive(Debug, Default)]
pub struct RwLock<T>(sync::RwLock<T>);

impl<T> RwLock<T> {
    /// An unlocked lock.
    pub const fn new(value: T) -> Self {
        Self(sync::RwLock::new(value))
    }

    /// Waits until no thread writes. A thread must not read again while it reads: if a writer waits, the second read
    /// would wait for the writer, and the writer would wait for the end of the first read.
    pub fn read(&self) -> RwLockReadGuard<'_, T> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }

    /// Locks for reading without waiting. Returns `None` if a thread writes or waits to write.
    pub fn try_read(&self) -> Option<RwLockReadGuard<'_, T>> {
        match self.0.try_read() {
            Ok(guard) => Some(guard),
            Err(TryLockError::Poisoned(poisoned)) => Some(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Waits until no other thread reads or writes.
    pub fn write(&self) -> RwLockWriteGuard<'_, T> {
        self.0.write().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Calls `attempt` until it has a result, for at most `limit`. This is for the end of a process, when a thread may hold
/// a lock and never release it.
pub fn try_for<T>(limit: Duration, attempt: impl Fn() -> Option<T>) -> Option<T> {
    let end = now() + limit.as_nanos() as u64;
    loop {
        let result = attempt();
        if result.is_some() || now() >= end {
            return result;
        }
        sleep(RETRY_INTERVAL);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};
    use std::sync::atomic::{AtomicU32, Ordering};

    #[test]
    fn locks_stay_usable_after_a_panic() {
        let (mutex, lock) = (Mutex::new(1), RwLock::new(2));
        let panicked = catch_unwind(AssertUnwindSafe(|| {
            let _held = (mutex.lock(), lock.write());
            panic!("a test");
        }));
        assert!(panicked.is_err());
        assert_eq!(*mutex.lock(), 1);
        assert_eq!(mutex.try_lock().map(|value| *value), Some(1));
        assert_eq!(*lock.read(), 2);
        assert_eq!(lock.try_read().map(|value| *value), Some(2));
        assert_eq!(*lock.write(), 2);
    }

    #[test]
    fn a_held_lock_is_not_locked_again() {
        let (mutex, lock) = (Mutex::new(()), RwLock::new(()));
        let _held = (mutex.lock(), lock.write());
        assert!(mutex.try_lock().is_none() && lock.try_read().is_none());
        assert!(try_for(Duration::ZERO, || mutex.try_lock()).is_none());
    }

    #[test]
    fn an_attempt_is_repeated_until_it_succeeds() {
        let attempts = AtomicU32::new(0);
        let attempt = || (attempts.fetch_add(1, Ordering::Relaxed) == 2).then_some("done");
        assert_eq!(try_for(Duration::from_secs(60), attempt), Some("done"));
        assert_eq!(attempts.into_inner(), 3);
    }
}

//! Work that a thread of this library does on behalf of a planner's thread. The planner's thread waits for the result.
//! Signal handlers of the planner run on the waiting thread. A handler may leave the wait by siglongjmp, because the
//! waiting thread waits on a futex word and holds no lock.

use super::cancellation::NoCancellation;
use super::futex;
use super::locks::Mutex;
use super::signals::SignalsBlocked;
use super::threads::spawn_alike;
use std::cell::RefCell;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::JoinHandle;

/// Interval at which a waiting thread checks whether to give up, ns.
const CHECK_INTERVAL: u64 = 100_000_000;

/// Work that has started.
pub struct DelegatedCall<T>(Arc<Outcome<T>>);

/// The place where the working thread leaves the result.
struct Outcome<T> {
    result: Mutex<Option<T>>,
    /// 1 when the work is done.
    done: AtomicU32,
}

thread_local! {
    /// The thread that works for the calling thread. If a thread is still stored here when the next work starts, a
    /// signal handler left the wait for it by siglongjmp.
    static WORKER: RefCell<Option<JoinHandle<()>>> = const { RefCell::new(None) };
}

impl<T: Send + 'static> DelegatedCall<T> {
    /// Starts a thread that runs `work`, which must not panic.
    ///
    /// # Errors
    /// Returns the system's error if it cannot start a thread.
    pub fn begin(_blocked: &SignalsBlocked, work: Box<dyn FnOnce() -> T + Send>) -> io::Result<Self> {
        // A worker that is still in `WORKER` is not joined. It ends by itself.
        drop(take_worker());
        let outcome = Arc::new(Outcome { result: Mutex::new(None), done: AtomicU32::new(0) });
        let workers = outcome.clone();
        let worker = spawn_alike("sun2xp call", move || {
            *workers.result.lock() = Some(work());
            workers.done.store(1, Ordering::Release);
            futex::wake(&workers.done, 1);
        })?;
        // `try_with` fails if the calling thread is ending and has no thread-local data any more. Then no thread joins
        // the worker.
        let _ = WORKER.try_with(|place| place.replace(Some(worker)));
        Ok(Self(outcome))
    }

    /// Waits for the end of the work, under the thread's original signal mask. Returns `None` if `give_up` returns true
    /// before the work ends.
    pub fn wait(self, blocked: &SignalsBlocked, give_up: impl Fn() -> bool) -> Option<T> {
        let done = &self.0.done;
        // Signals are unblocked only inside this block. Elsewhere the thread may own a lock, for example in the
        // allocator, and a siglongjmp out of a handler would leave the lock taken.
        let given_up = blocked.lifted(|| {
            while done.load(Ordering::Acquire) == 0 {
                futex::wait(done, 0, CHECK_INTERVAL);
                if give_up() {
                    return true;
                }
            }
            false
        });
        let worker = take_worker();
        if given_up {
            // `give_up` returns true in a forked child, which does not have the worker thread.
            std::mem::forget(worker);
            return None;
        }
        // The worker has nothing left to do. Joining waits until its stack and its thread number are free again.
        let _uncancelled = NoCancellation::begin();
        worker.map(JoinHandle::join);
        self.0.result.lock().take()
    }
}

fn take_worker() -> Option<JoinHandle<()>> {
    WORKER.try_with(RefCell::take).ok().flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_work_is_done_on_another_thread_and_waited_for() {
        let blocked = SignalsBlocked::all();
        let own = std::thread::current().id();
        let work = move || {
            std::thread::sleep(Duration::from_millis(20));
            std::thread::current().id() != own
        };
        let call = DelegatedCall::begin(&blocked, Box::new(work)).expect("a thread");
        assert_eq!(call.wait(&blocked, || false), Some(true));
    }

    #[test]
    fn a_wait_ends_when_there_is_a_reason_to_give_up() {
        let blocked = SignalsBlocked::all();
        let (stay, leave) = std::sync::mpsc::channel::<()>();
        let call = DelegatedCall::begin(&blocked, Box::new(move || leave.recv().is_err())).expect("a thread");
        assert_eq!(call.wait(&blocked, || true), None);
        drop(stay);
    }
}

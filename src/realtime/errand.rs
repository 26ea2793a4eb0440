//! Work that a thread of this library does for a planner's thread, which waits. The planner's handlers run on its own
//! thread meanwhile, and one that leaves the wait by siglongjmp leaves nothing locked: it waits for a word in memory,
//! and holds nothing.
#![allow(unsafe_code, reason = "the futex system call")]

use super::cancellation::NoCancellation;
use super::signals::SignalsBlocked;
use super::threads::spawn_alike;
use parking_lot::Mutex;
use std::cell::RefCell;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::JoinHandle;

/// How often a thread that waits looks whether it still has a reason to, ns.
const LOOKING: libc::c_long = 100_000_000;

/// Work that has begun.
pub struct Errand<T>(Arc<Desk<T>>);

/// Where the thread that works leaves what comes of it.
struct Desk<T> {
    result: Mutex<Option<T>>,
    /// 1: the work is done.
    done: AtomicU32,
}

thread_local! {
    /// The thread that works for this one. What is found here when the next one begins works for a call that was jumped
    /// out of.
    static WORKING: RefCell<Option<JoinHandle<()>>> = const { RefCell::new(None) };
}

impl<T: Send + 'static> Errand<T> {
    /// Begins. `work` must not panic.
    ///
    /// # Errors
    /// The system refuses a thread.
    pub fn begin(_blocked: &SignalsBlocked, work: impl FnOnce() -> T + Send + 'static) -> io::Result<Self> {
        // Nobody waits for a thread that is left there: it ends by itself.
        drop(take_worker());
        let desk = Arc::new(Desk { result: Mutex::new(None), done: AtomicU32::new(0) });
        let theirs = desk.clone();
        let worker = spawn_alike("sun2xp call", move || {
            *theirs.result.lock() = Some(work());
            theirs.done.store(1, Ordering::Release);
            wake(&theirs.done);
        })?;
        // Where the calling thread is just ending there is no such place any more: then nobody waits for the worker's
        // end.
        let _ = WORKING.try_with(|working| working.replace(Some(worker)));
        Ok(Self(desk))
    }

    /// Waits for the work to be done, with the signals of the calling thread let in; none where there is a reason to
    /// give up.
    pub fn wait(self, blocked: &SignalsBlocked, give_up: impl Fn() -> bool) -> Option<T> {
        let done = &self.0.done;
        // Outside of this a signal handler could not be left by siglongjmp: there is memory in use, and the desk.
        let given_up = blocked.lifted(|| {
            while done.load(Ordering::Acquire) == 0 {
                wait_for_change(done, 0);
                if give_up() {
                    return true;
                }
            }
            false
        });
        let worker = take_worker();
        if given_up {
            // There is no such thread in a forked child.
            std::mem::forget(worker);
            return None;
        }
        // It has nothing left to do: this waits until it has returned what it had of the system.
        let _uncancelled = NoCancellation::begin();
        worker.map(JoinHandle::join);
        self.0.result.lock().take()
    }
}

fn take_worker() -> Option<JoinHandle<()>> {
    WORKING.try_with(RefCell::take).ok().flatten()
}

/// Waits while `word` has this value, or for some time. Not a cancellation point.
fn wait_for_change(word: &AtomicU32, value: u32) {
    let some_time = libc::timespec { tv_sec: 0, tv_nsec: LOOKING };
    let operation = libc::FUTEX_WAIT | libc::FUTEX_PRIVATE_FLAG;
    // SAFETY: the word and the time live during the call. Whatever it returns, the word is looked at again.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), operation, value, &some_time) };
}

fn wake(word: &AtomicU32) {
    let operation = libc::FUTEX_WAKE | libc::FUTEX_PRIVATE_FLAG;
    // SAFETY: the word lives during the call.
    unsafe { libc::syscall(libc::SYS_futex, word.as_ptr(), operation, 1) };
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
        let errand = Errand::begin(&blocked, work).expect("a thread");
        assert_eq!(errand.wait(&blocked, || false), Some(true));
    }

    #[test]
    fn who_has_a_reason_gives_up() {
        let blocked = SignalsBlocked::all();
        let (stay, leave) = std::sync::mpsc::channel::<()>();
        let errand = Errand::begin(&blocked, move || leave.recv().is_err()).expect("a thread");
        assert_eq!(errand.wait(&blocked, || true), None);
        drop(stay);
    }
}

//! Threads that leave the planner's signals alone and run real-time where the system permits it.
#![allow(unsafe_code)]

use super::floating_point::use_default_environment;
use super::memory::every_page_is_locked;
use super::signals::SignalsBlocked;
use super::thread_local_data::taken_by_the_c_library;
use parking_lot::Mutex;
use std::io;
use std::mem::MaybeUninit;
use std::thread::{Builder, JoinHandle};

/// Small, so that a planner that locks its memory (mlockall) locks little of ours; many times what a servo cycle uses.
/// Every thread gets this beside the part of its stack that the C library takes.
const STACK_BYTES: usize = 256 * 1024;

/// Opening a hand takes 290 KiB.
const STAND_IN_STACK_BYTES: usize = 512 * 1024;

/// The numbers of the threads that were started here and have not ended.
static OWN: Mutex<Vec<libc::pid_t>> = Mutex::new(Vec::new());

/// How a thread is scheduled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Priority {
    /// SCHED_FIFO priority, 1 to 99; 0: an ordinary thread.
    pub fifo: u8,
    /// Core that the thread is bound to.
    pub core: Option<usize>,
}

/// What of a [`Priority`] was had.
#[derive(Debug, Default)]
pub struct Realtime {
    /// Why the thread is not real-time, though it was asked to be.
    pub scheduling: Option<io::Error>,
    /// Why the thread is not bound to its core, though it was asked to be.
    pub core: Option<io::Error>,
    /// Why its memory is not locked, though that was asked for.
    pub memory: Option<io::Error>,
}

/// Starts a thread with all signals blocked, so that it takes none of the planner's: not one that the process receives,
/// nor one that its own system calls let in; and with the default floating-point environment. `body` runs after the
/// thread has the priority it could get, and is told.
///
/// # Errors
/// The system refuses a thread.
pub fn spawn<T: Send + 'static>(
    name: &str,
    priority: Priority,
    body: impl FnOnce(Realtime) -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    start(name, STACK_BYTES, move || body(apply(priority)))
}

/// Starts such a thread that is scheduled as the calling thread is: it works in its place.
pub(super) fn spawn_alike<T: Send + 'static>(
    name: &str,
    body: impl FnOnce() -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    start(name, STAND_IN_STACK_BYTES, body)
}

fn start<T: Send + 'static>(
    name: &str,
    stack: usize,
    body: impl FnOnce() -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    // The new thread inherits the mask.
    let _blocked = SignalsBlocked::all();
    let stack = stack + taken_by_the_c_library();
    Builder::new().name(name.into()).stack_size(stack).spawn(|| {
        let _own = OwnThread::begin();
        use_default_environment();
        body()
    })
}

/// The numbers of the threads of this library.
pub(super) fn own_threads() -> Vec<libc::pid_t> {
    OWN.lock().clone()
}

/// A thread of this library, from its beginning to its end.
struct OwnThread(libc::pid_t);

impl OwnThread {
    fn begin() -> Self {
        // SAFETY: no arguments. Not `gettid`, which old C libraries do not have.
        let number = unsafe { libc::syscall(libc::SYS_gettid) } as libc::pid_t;
        OWN.lock().push(number);
        Self(number)
    }
}

impl Drop for OwnThread {
    fn drop(&mut self) {
        OWN.lock().retain(|&number| number != self.0);
    }
}

/// The locked stack of the thread that has it, which drops it before it ends: the C library keeps the stacks of threads
/// that have ended for others.
#[derive(Debug)]
pub struct LockedStack {
    lowest: *mut libc::c_void,
    bytes: usize,
}

impl LockedStack {
    /// Locks the stack of the calling thread, all of it, and so faults it in.
    ///
    /// # Errors
    /// What the system says: EPERM without any right to lock, ENOMEM beyond the memlock limit.
    pub fn lock() -> io::Result<Self> {
        let mut attributes = MaybeUninit::uninit();
        let (mut lowest, mut bytes) = (std::ptr::null_mut(), 0);
        // SAFETY: the calling thread; the attributes are initialised before they are looked at, and destroyed once.
        unsafe {
            match libc::pthread_getattr_np(libc::pthread_self(), attributes.as_mut_ptr()) {
                0 => {}
                error => return Err(io::Error::from_raw_os_error(error)),
            }
            libc::pthread_attr_getstack(attributes.as_ptr(), &mut lowest, &mut bytes);
            libc::pthread_attr_destroy(attributes.as_mut_ptr());
        }
        // Made first: a refused lock may have locked a part.
        let locked = Self { lowest, bytes };
        // SAFETY: locking changes no contents.
        if unsafe { libc::mlock(lowest, bytes) } == 0 { Ok(locked) } else { Err(io::Error::last_os_error()) }
    }
}

impl Drop for LockedStack {
    fn drop(&mut self) {
        // A planner that has locked all of its memory has locked this too.
        if !every_page_is_locked() {
            // SAFETY: unlocking changes no contents.
            unsafe { libc::munlock(self.lowest, self.bytes) };
        }
    }
}

/// Faults in half of the stack of a thread that [`spawn`] has started: for where it cannot be locked.
#[inline(never)]
pub fn touch_stack() {
    const PAGE: usize = 4096;
    let mut stack = [MaybeUninit::<u8>::uninit(); STACK_BYTES / 2];
    for byte in stack.iter_mut().step_by(PAGE) {
        // SAFETY: a byte of a local array; volatile, because nobody ever reads it.
        unsafe { std::ptr::from_mut(byte).write_volatile(MaybeUninit::new(0)) };
    }
}

fn apply(priority: Priority) -> Realtime {
    let mut had = Realtime::default();
    // An ordinary thread's timers are 50 us late by default; real-time threads have no slack.
    // SAFETY: PR_SET_TIMERSLACK takes ns as a number and changes the calling thread only.
    unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1 as libc::c_ulong) };
    // An ordinary thread is made one, because a thread inherits: a real-time planner's would all be real-time.
    let policy = if priority.fifo > 0 { libc::SCHED_FIFO } else { libc::SCHED_OTHER };
    let parameters = libc::sched_param { sched_priority: priority.fifo.into() };
    // SAFETY: the calling thread, a valid parameter block.
    let refused = unsafe { libc::pthread_setschedparam(libc::pthread_self(), policy, &parameters) };
    if refused != 0 && priority.fifo > 0 {
        had.scheduling = Some(io::Error::from_raw_os_error(refused));
    }
    if let Some(core) = priority.core {
        had.core = bind(core).err();
    }
    had
}

fn bind(core: usize) -> io::Result<()> {
    if core >= libc::CPU_SETSIZE as usize {
        return Err(io::Error::from_raw_os_error(libc::EINVAL));
    }
    // SAFETY: a cpu_set_t is plain bits, all zero is the empty set; `core` is within it.
    let refused = unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        libc::CPU_SET(core, &mut set);
        libc::sched_setaffinity(0, size_of::<libc::cpu_set_t>(), &set)
    };
    if refused == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thread_has_every_signal_blocked_and_its_starter_has_not() {
        let blocked = |signal| {
            let mut mask = MaybeUninit::uninit();
            // SAFETY: a null new mask only reads the old one into `mask`.
            unsafe {
                libc::pthread_sigmask(libc::SIG_BLOCK, std::ptr::null(), mask.as_mut_ptr());
                libc::sigismember(&mask.assume_init(), signal) == 1
            }
        };
        let signals = [libc::SIGALRM, libc::SIGINT, libc::SIGCHLD, libc::SIGUSR1, libc::SIGTERM];
        let inside = spawn("quiet", Priority::default(), move |_| signals.map(blocked)).expect("a thread").join();
        assert_eq!(inside.expect("no panic"), [true; 5]);
        assert_eq!(signals.map(blocked), [false; 5]);
    }

    #[test]
    fn an_ordinary_thread_is_ordinary_also_where_its_starter_is_real_time() {
        // SAFETY: 0 is the calling thread.
        let policy = |_| unsafe { libc::sched_getscheduler(0) };
        let nested = move |_| spawn("inner", Priority::default(), policy).expect("a thread").join().expect("no panic");
        let inner = spawn("outer", Priority { fifo: 1, core: None }, nested).expect("a thread").join();
        assert_eq!(inner.expect("no panic"), libc::SCHED_OTHER);
    }

    #[test]
    fn a_core_that_is_not_there_is_told_and_survived() {
        let priority = Priority { fifo: 0, core: Some(1023) };
        let had = spawn("lost", priority, |had| had).expect("a thread").join().expect("no panic");
        assert!(had.core.is_some() && had.scheduling.is_none());
    }
}

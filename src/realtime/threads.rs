//! Threads that block the planner's signals and run in real time if the system permits it.
#![allow(unsafe_code)]

use super::floating_point::use_default_environment;
use super::locks::Mutex;
use super::memory::every_page_is_locked;
use super::signals::SignalsBlocked;
use super::thread_local_data::taken_by_the_c_library;
use std::io;
use std::mem::MaybeUninit;
use std::thread::{Builder, JoinHandle};

/// Stack of a servo thread, and of every other thread that [`spawn`] starts. It is many times what a servo cycle uses,
/// but small, so that a planner that locks all of its memory (mlockall) locks little for this library. The bytes that
/// the C library takes from the stack are added to this size.
const STACK_BYTES: usize = 256 * 1024;

/// Stack of a thread that runs a call on behalf of the planner's thread. Opening a hand needs more than 512 KiB.
const CALL_STACK_BYTES: usize = 1024 * 1024;

/// Thread numbers of the running threads that this library has started.
static OWN: Mutex<Vec<libc::pid_t>> = Mutex::new(Vec::new());

/// How a thread is scheduled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Priority {
    /// SCHED_FIFO priority, 1 to 99; 0 for an ordinary thread.
    pub fifo: u8,
    /// Core that the thread is bound to.
    pub core: Option<usize>,
}

/// What the system refused to a thread (parts of its [`Priority`], or locked memory), with the reasons.
#[derive(Debug, Default)]
pub struct RealtimeRefusals {
    /// Why the thread is not real-time although that was requested.
    pub scheduling: Option<io::Error>,
    /// Why the thread is not bound to its core although that was requested.
    pub core: Option<io::Error>,
    /// Why the thread's memory is not locked although that was requested.
    pub memory: Option<io::Error>,
}

/// Starts a thread with all signals blocked and with the default floating-point environment. Signals that are sent to
/// the process, and signals that the thread's own system calls raise, do not run the planner's handlers in this thread.
/// `body` runs after the priority is set. Its argument contains what the system refused.
///
/// # Errors
/// The system cannot start a thread.
pub fn spawn<T: Send + 'static>(
    name: &str,
    priority: Priority,
    body: impl FnOnce(RealtimeRefusals) -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    start(name, STACK_BYTES, Box::new(move || body(apply(priority))))
}

/// Like [`spawn`], but the new thread has the scheduling of the calling thread, because it works on behalf of that
/// thread.
pub(super) fn spawn_alike<T: Send + 'static>(
    name: &str,
    body: impl FnOnce() -> T + Send + 'static,
) -> io::Result<JoinHandle<T>> {
    start(name, CALL_STACK_BYTES, Box::new(body))
}

/// `body` is boxed, because the standard library's code that starts a thread is large, and would be compiled again for
/// each type of `body`.
fn start<T: Send + 'static>(
    name: &str,
    stack: usize,
    body: Box<dyn FnOnce() -> T + Send>,
) -> io::Result<JoinHandle<T>> {
    // The new thread inherits this signal mask.
    let _blocked = SignalsBlocked::all();
    let stack = stack + taken_by_the_c_library();
    Builder::new().name(name.into()).stack_size(stack).spawn(|| {
        let _own = OwnThread::begin();
        use_default_environment();
        body()
    })
}

/// The thread numbers of the running threads of this library.
pub(super) fn own_threads() -> Vec<libc::pid_t> {
    OWN.lock().clone()
}

/// Registers the calling thread as one of this library until it ends.
struct OwnThread(libc::pid_t);

impl OwnThread {
    fn begin() -> Self {
        // SAFETY: the system call takes no arguments. `gettid` is not used, because old C libraries do not have it.
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

/// The locked stack of a thread. The thread must drop this value before it ends, because the C library gives the stacks
/// of ended threads to new threads.
#[derive(Debug)]
pub struct LockedStack {
    lowest: *mut libc::c_void,
    bytes: usize,
}

impl LockedStack {
    /// Locks the whole stack of the calling thread, which also faults it in.
    ///
    /// # Errors
    /// Returns the system's error: EPERM if the process may not lock memory, ENOMEM if the stack exceeds the memlock
    /// limit.
    pub fn lock() -> io::Result<Self> {
        let mut attributes = MaybeUninit::uninit();
        let (mut lowest, mut bytes) = (std::ptr::null_mut(), 0);
        // SAFETY: the handle is that of the calling thread. The attributes are initialised before they are read, and
        // destroyed once.
        unsafe {
            match libc::pthread_getattr_np(libc::pthread_self(), attributes.as_mut_ptr()) {
                0 => {}
                error => return Err(io::Error::from_raw_os_error(error)),
            }
            libc::pthread_attr_getstack(attributes.as_ptr(), &mut lowest, &mut bytes);
            libc::pthread_attr_destroy(attributes.as_mut_ptr());
        }
        // This value exists before mlock is called, so that it also unlocks what a failed mlock may have locked.
        let locked = Self { lowest, bytes };
        // SAFETY: locking does not change the contents.
        if unsafe { libc::mlock(lowest, bytes) } == 0 { Ok(locked) } else { Err(io::Error::last_os_error()) }
    }
}

impl Drop for LockedStack {
    fn drop(&mut self) {
        // If the planner has locked all of its memory, the stack must stay locked.
        if !every_page_is_locked() {
            // SAFETY: unlocking does not change the contents.
            unsafe { libc::munlock(self.lowest, self.bytes) };
        }
    }
}

/// Faults in half of the stack of the calling thread, which must have been started by [`spawn`]. This function is for
/// stacks that cannot be locked.
#[inline(never)]
pub fn touch_stack() {
    const PAGE: usize = 4096;
    let mut stack = [MaybeUninit::<u8>::uninit(); STACK_BYTES / 2];
    for byte in stack.iter_mut().step_by(PAGE) {
        // SAFETY: the pointer points to a byte of a local array. The write is volatile, because nothing reads the
        // array.
        unsafe { std::ptr::from_mut(byte).write_volatile(MaybeUninit::new(0)) };
    }
}

fn apply(priority: Priority) -> RealtimeRefusals {
    let mut refusals = RealtimeRefusals::default();
    // The timers of an ordinary thread may be 50 us late by default. Real-time threads have no slack.
    // SAFETY: PR_SET_TIMERSLACK takes ns as a number and affects the calling thread only.
    unsafe { libc::prctl(libc::PR_SET_TIMERSLACK, 1 as libc::c_ulong) };
    // The policy is set for an ordinary thread too. Otherwise the thread would inherit the policy of the thread that
    // starts it, and would be real-time in a real-time planner.
    let policy = if priority.fifo > 0 { libc::SCHED_FIFO } else { libc::SCHED_OTHER };
    let parameters = libc::sched_param { sched_priority: priority.fifo.into() };
    // SAFETY: the handle is that of the calling thread, and the parameter block is valid.
    let refused = unsafe { libc::pthread_setschedparam(libc::pthread_self(), policy, &parameters) };
    if refused != 0 && priority.fifo > 0 {
        refusals.scheduling = Some(io::Error::from_raw_os_error(refused));
    }
    if let Some(core) = priority.core {
        refusals.core = bind(core).err();
    }
    refusals
}

fn bind(core: usize) -> io::Result<()> {
    if core >= libc::CPU_SETSIZE as usize {
        return Err(io::Error::from_raw_os_error(libc::EINVAL));
    }
    // SAFETY: a cpu_set_t is plain bits, and all zeros is the empty set. `core` is within it.
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
    fn a_new_thread_blocks_every_signal_and_the_thread_that_starts_it_blocks_none() {
        let blocked = |signal| {
            let mut mask = MaybeUninit::uninit();
            // SAFETY: with a null new mask, the call only reads the current mask into `mask`.
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
    fn an_ordinary_thread_is_ordinary_even_if_its_parent_is_real_time() {
        // SAFETY: 0 is the calling thread.
        let policy = |_| unsafe { libc::sched_getscheduler(0) };
        let nested = move |_| spawn("inner", Priority::default(), policy).expect("a thread").join().expect("no panic");
        let inner = spawn("outer", Priority { fifo: 1, core: None }, nested).expect("a thread").join();
        assert_eq!(inner.expect("no panic"), libc::SCHED_OTHER);
    }

    #[test]
    fn a_core_that_does_not_exist_is_reported_and_the_thread_runs() {
        let priority = Priority { fifo: 0, core: Some(1023) };
        let refusals = spawn("lost", priority, |refusals| refusals).expect("a thread").join().expect("no panic");
        assert!(refusals.core.is_some() && refusals.scheduling.is_none());
    }
}

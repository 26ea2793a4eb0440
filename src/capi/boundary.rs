//! What every call does on its way in and out. No panic leaves a call, no cancellation enters it, and the planner's
//! errno, floating-point environment and signal mask are after it what they were before.
//!
//! A quick call runs in the planner's thread. A slow one runs in a thread of its own, for which the planner's waits: it
//! needs little of the planner's stack then, and a signal handler that jumps out of it (siglongjmp) leaves nothing
//! locked. The call goes on.

use crate::capi::forked::is_forked_child;
use crate::capi::process;
use crate::capi::refusal::{Refusal, refuse};
use crate::hand::HandError;
use crate::realtime::{DeferredCancellation, Environment, Errand, NoCancellation, SignalsBlocked, is_memory_free};
use std::ffi::c_int;
use std::mem::ManuallyDrop;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The memory that OpenHand may need, with the black boxes.
pub(super) const MEMORY_OF_HAND: usize = 12 << 20;

/// The memory that a slow call on an open hand may need: a black box takes most.
pub(super) const MEMORY_OF_CALL: usize = 4 << 20;

/// The memory that a thread for a call may need.
const MEMORY_OF_THREAD: usize = 64 * 1024;

/// Runs a quick call: 0 where it is done, -1 where it is refused. `call` must have no cancellation point.
#[inline(always)]
pub(super) fn guarded(name: &'static str, call: impl FnOnce() -> Result<(), Refusal>) -> c_int {
    uncancelled(|| {
        let environment = Environment::enter_default();
        let errno = process::errno();
        let result = finish(name, errno, admitted(call));
        environment.restore();
        result
    })
}

/// Runs a slow call in a thread of its own: 0 where it is done, -1 where it is refused. `prepare` copies the arguments
/// in the planner's thread. The call is refused where less than `memory` is free, bytes.
#[inline(always)]
pub(super) fn delegated<C: FnOnce() -> Result<(), Refusal> + Send + 'static>(
    name: &'static str,
    memory: usize,
    prepare: impl FnOnce() -> Result<C, Refusal>,
) -> c_int {
    uncancelled(|| {
        let blocked = SignalsBlocked::all();
        waited_for(name, &blocked, || {
            if !is_memory_free(memory) {
                return Err(Refusal::NoMemory);
            }
            // With the signals of faults let in: it reads the planner's memory.
            let call = blocked.faults_let_in(prepare)?;
            let start = |source| HandError::System { doing: "start a thread for this call", source };
            let errand = Errand::begin(&blocked, || caught(call)).map_err(start)?;
            errand.wait(&blocked, is_forked_child).unwrap_or(Err(Refusal::Forked))
        })
    })
}

/// Runs a slow call as [`delegated`] does, but in the planner's thread where there is no memory for another or the
/// system refuses it: for what must not fail.
#[inline(always)]
pub(super) fn delegated_or_done_here(name: &'static str, call: fn() -> Result<(), Refusal>) -> c_int {
    uncancelled(|| {
        let blocked = SignalsBlocked::all();
        waited_for(name, &blocked, || {
            match is_memory_free(MEMORY_OF_THREAD).then(|| Errand::begin(&blocked, move || caught(call))) {
                Some(Ok(errand)) => errand.wait(&blocked, is_forked_child).unwrap_or(Err(Refusal::Forked)),
                _ => {
                    let _whole = NoCancellation::begin();
                    let environment = Environment::enter_default();
                    let closed = caught(call);
                    environment.restore();
                    closed
                }
            }
        })
    })
}

/// Everything of a slow call but the wait itself is done with all signals blocked: nothing there can be jumped out of.
/// During the wait the thread has the planner's floating-point environment, which a jump would leave as it is.
fn waited_for(name: &str, _blocked: &SignalsBlocked, call: impl FnOnce() -> Result<(), Refusal>) -> c_int {
    let errno = process::errno();
    let outcome = admitted(call);
    let environment = Environment::enter_default();
    let result = finish(name, errno, outcome);
    environment.restore();
    result
}

/// Keeps cancellation out of `call`, which must not panic and whose result needs no destructor.
///
/// This becomes a part of the exported function, in which nothing has a destructor: a thread with asynchronous
/// cancellation may be unwound there before and after the call.
#[inline(always)]
pub(super) fn uncancelled<R, F: FnOnce() -> R>(call: F) -> R {
    let mut call = ManuallyDrop::new(call);
    let cancellation = DeferredCancellation::begin();
    // SAFETY: it is not used again.
    let result = unsafe { contained(&mut call) };
    cancellation.end();
    result
}

/// Runs a call in a frame of its own. `extern "C"`, because the compiler then knows that nothing unwinds out of it.
///
/// # Safety
/// `call` is not used afterwards.
#[inline(never)]
#[allow(improper_ctypes_definitions, reason = "called from this file only")]
unsafe extern "C" fn contained<R, F: FnOnce() -> R>(call: &mut ManuallyDrop<F>) -> R {
    // SAFETY: by the contract of this function.
    let call = unsafe { ManuallyDrop::take(call) };
    call()
}

/// What becomes of a call, which is refused in a forked child.
fn admitted(call: impl FnOnce() -> Result<(), Refusal>) -> Result<(), Refusal> {
    if is_forked_child() { Err(Refusal::Forked) } else { caught(call) }
}

fn caught(call: impl FnOnce() -> Result<(), Refusal>) -> Result<(), Refusal> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(Refusal::Panicked(message(&*panic))))
}

fn finish(name: &str, errno: c_int, outcome: Result<(), Refusal>) -> c_int {
    match outcome {
        Ok(()) => {
            // Files that are looked for and not there, and locks that were waited for, have set it.
            process::set_errno(errno);
            0
        }
        Err(refusal) => {
            refuse(name, &refusal);
            -1
        }
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capi::refusal::text;
    use std::ffi::CStr;
    use std::thread;

    fn told() -> String {
        // SAFETY: the text of this thread, which refuses nothing meanwhile.
        unsafe { CStr::from_ptr(text()) }.to_string_lossy().into_owned()
    }

    #[test]
    fn a_panic_does_not_leave_the_boundary() {
        let result = guarded("SendPos", || panic!("a defect"));
        let errno = std::io::Error::last_os_error().raw_os_error();
        assert_eq!((result, errno), (-1, Some(libc::EIO)));
        assert_eq!(told(), "SendPos: the library failed (a defect): a defect of this library, please report it");
    }

    #[test]
    fn success_leaves_errno() {
        process::set_errno(libc::E2BIG);
        let call = || {
            process::set_errno(libc::ENOENT);
            Ok(())
        };
        assert_eq!((guarded("OpenHand", call), process::errno()), (0, libc::E2BIG));
    }

    #[test]
    fn every_thread_has_its_own_text_which_success_leaves_alone() {
        assert_eq!(told(), "");
        assert_eq!(guarded("GetPos", || Err(Refusal::NoHand)), -1);
        assert_eq!(guarded("SendPos", || Ok(())), 0);
        assert!(told().starts_with("GetPos: no hand is open"));
        thread::scope(|scope| scope.spawn(|| assert_eq!(told(), "")).join()).expect("another thread has no text yet");
    }

    #[test]
    fn a_slow_call_is_refused_and_panics_as_a_quick_one() {
        process::set_errno(libc::E2BIG);
        let name = || thread::current().name().map(str::to_owned);
        let elsewhere = move || match name().as_deref() {
            Some("sun2xp call") => Ok(()),
            _ => Err(Refusal::Busy),
        };
        assert_eq!(
            (delegated("OpenHand", MEMORY_OF_CALL, || Ok(elsewhere)), process::errno()),
            (0, libc::E2BIG),
            "{}",
            told()
        );
        let none = || -> Result<fn() -> Result<(), Refusal>, Refusal> {
            Err(Refusal::SmallStruct { name: "Fault", size: 1, least: 2 })
        };
        assert_eq!((delegated("WriteBlackBox", MEMORY_OF_CALL, none), process::errno()), (-1, libc::EINVAL));
        assert!(told().starts_with("WriteBlackBox: Fault->Size is 1"));
        assert_eq!(
            (delegated("OpenHand", MEMORY_OF_CALL, || Ok(|| Err(Refusal::NoHand))), process::errno()),
            (-1, libc::ENODEV)
        );
        assert!(told().starts_with("OpenHand: no hand is open"));
        assert_eq!(
            (delegated("OpenHand", MEMORY_OF_CALL, || Ok(|| panic!("a defect"))), process::errno()),
            (-1, libc::EIO)
        );
        assert!(told().starts_with("OpenHand: the library failed (a defect)"));
        assert_eq!(delegated_or_done_here("CloseHand", || Err(Refusal::Busy)), -1);
        assert_eq!(process::errno(), libc::EBUSY);
    }
}

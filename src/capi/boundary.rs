//! The entry and exit of every call. No panic leaves a call, and no cancellation interrupts it. Every call restores the
//! planner's floating-point environment and signal mask. A successful call also restores the planner's errno.
//!
//! A quick call runs in the planner's thread. A slow call runs in its own thread (see [`delegated_or_done_here`] for an
//! exception), and the planner's thread waits for it. So a slow call needs little of the planner's stack. If a signal
//! handler jumps out of the wait (siglongjmp), nothing stays locked, because the call continues to its end.

use crate::capi::forked::is_forked_child;
use crate::capi::handle::Handle;
use crate::capi::process;
use crate::capi::refusal::Refusal;
use crate::capi::reporting::refuse;
use crate::hand::HandError;
use crate::realtime::{
    DeferredCancellation, DelegatedCall, Environment, NoCancellation, SignalsBlocked, is_memory_free,
};
use std::ffi::c_int;
use std::mem::ManuallyDrop;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Memory that OpenHand may need, including the black boxes, bytes.
pub(super) const MEMORY_OF_HAND: usize = 12 << 20;

/// Memory that a slow call on an open hand may need, bytes. sun2xp_write_black_box needs the most.
pub(super) const MEMORY_OF_CALL: usize = 4 << 20;

/// Memory that the thread of a call may need, bytes.
pub(super) const MEMORY_OF_THREAD: usize = 64 * 1024;

/// Runs a quick call for the hand with this handle. Returns 0, or a negative number if it is refused. `call` must have
/// no cancellation point.
#[inline(always)]
pub(super) fn guarded(name: &'static str, handle: Handle, call: impl FnOnce() -> Result<(), Refusal>) -> c_int {
    let mut call = ManuallyDrop::new(call);
    // SAFETY: `quick` calls this once.
    let mut call = || unsafe { ManuallyDrop::take(&mut call) }();
    let cancellation = DeferredCancellation::begin();
    let result = quick(name, handle, &mut call);
    cancellation.end();
    result
}

/// Runs a quick call in its own frame, as [`contained`] does. This function is compiled once for all calls, which keeps
/// the library small.
#[inline(never)]
#[allow(improper_ctypes_definitions, reason = "called from this file only")]
extern "C" fn quick(name: &'static str, handle: Handle, call: &mut dyn FnMut() -> Result<(), Refusal>) -> c_int {
    let environment = Environment::enter_default();
    let errno = process::errno();
    let result = finish(name, handle, errno, unless_forked(call));
    environment.restore();
    result
}

/// Runs a slow call in its own thread. Returns 0, or a negative number if it is refused. `prepare` copies the arguments
/// in the planner's thread. The call is refused if less than `memory` bytes are free.
#[inline(always)]
pub(super) fn delegated<C: FnOnce() -> Result<(), Refusal> + Send + 'static>(
    name: &'static str,
    handle: Handle,
    memory: usize,
    prepare: impl FnOnce() -> Result<C, Refusal>,
) -> c_int {
    let mut prepare = ManuallyDrop::new(prepare);
    let mut prepare = |blocked: &SignalsBlocked| -> Result<Work, Refusal> {
        // SAFETY: `elsewhere` calls this once.
        let prepare = unsafe { ManuallyDrop::take(&mut prepare) };
        // The planner may have handlers of SIGSEGV and SIGBUS that make pages accessible. `prepare` may read such
        // pages.
        let call = blocked.with_faults_unblocked(prepare)?;
        Ok(Box::new(|| caught(call)))
    };
    let cancellation = DeferredCancellation::begin();
    let result = elsewhere(name, handle, memory, &mut prepare);
    cancellation.end();
    result
}

/// The part of a slow call that its own thread runs.
type Work = Box<dyn FnOnce() -> Result<(), Refusal> + Send>;

/// Runs a slow call in its own thread, as [`delegated`] does. This function is compiled once for all calls.
#[inline(never)]
#[allow(improper_ctypes_definitions, reason = "called from this file only")]
extern "C" fn elsewhere(
    name: &'static str,
    handle: Handle,
    memory: usize,
    prepare: &mut dyn FnMut(&SignalsBlocked) -> Result<Work, Refusal>,
) -> c_int {
    let blocked = SignalsBlocked::all();
    slow(name, handle, &blocked, || {
        if !is_memory_free(memory) {
            return Err(Refusal::NoMemory);
        }
        let start = |source| HandError::System { doing: "start a thread for this call", source };
        let delegated = DelegatedCall::begin(&blocked, prepare(&blocked)?).map_err(start)?;
        delegated.wait(&blocked, is_forked_child).unwrap_or(Err(Refusal::Forked))
    })
}

/// Runs a slow call that must take place in any case. Unlike [`delegated`], it runs the call in the planner's thread if
/// there is no memory for another thread or the system refuses to start one. `prepare` runs in the planner's thread and
/// returns the function that carries out the call.
#[inline(always)]
pub(super) fn delegated_or_done_here<C: FnOnce() -> Result<(), Refusal> + Copy + Send + 'static>(
    name: &'static str,
    handle: Handle,
    prepare: impl FnOnce() -> C,
) -> c_int {
    uncancelled(|| {
        let call = prepare();
        let blocked = SignalsBlocked::all();
        slow(name, handle, &blocked, || {
            match is_memory_free(MEMORY_OF_THREAD)
                .then(|| DelegatedCall::begin(&blocked, Box::new(move || caught(call))))
            {
                Some(Ok(delegated)) => delegated.wait(&blocked, is_forked_child).unwrap_or(Err(Refusal::Forked)),
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

/// Runs a slow call. The planner's signal mask is in force only during the wait itself. While the arguments are copied,
/// only the fault signals (for example SIGSEGV) can be delivered. All signals are blocked in all other parts of the
/// call, so no handler can jump out of these parts. A jump out of the wait does not restore the floating-point
/// environment. Therefore the planner's thread keeps its own environment during the wait.
fn slow(
    name: &'static str,
    handle: Handle,
    _blocked: &SignalsBlocked,
    call: impl FnOnce() -> Result<(), Refusal>,
) -> c_int {
    let errno = process::errno();
    let outcome = unless_forked(call);
    let environment = Environment::enter_default();
    let result = finish(name, handle, errno, outcome);
    environment.restore();
    result
}

/// Runs `call` without cancellation. `call` must not panic, and its result must need no destructor.
///
/// This function is inlined into the exported function. No value in it has a destructor, because a thread with
/// asynchronous cancellation may be unwound from this function before and after `call` runs. An exported function that
/// needs values with destructors must create them inside `call`.
#[inline(always)]
pub(super) fn uncancelled<R, F: FnOnce() -> R>(call: F) -> R {
    let mut call = ManuallyDrop::new(call);
    let cancellation = DeferredCancellation::begin();
    // SAFETY: `call` is not used again.
    let result = unsafe { contained(&mut call) };
    cancellation.end();
    result
}

/// Runs a call in its own frame. With `extern "C"` the compiler knows that nothing unwinds out of it.
///
/// # Safety
/// `call` is not used afterwards.
#[inline(never)]
#[allow(improper_ctypes_definitions, reason = "called from this file only")]
unsafe extern "C" fn contained<R, F: FnOnce() -> R>(call: &mut ManuallyDrop<F>) -> R {
    // SAFETY: the caller does not use `call` afterwards.
    let call = unsafe { ManuallyDrop::take(call) };
    call()
}

/// Runs a call, unless this process is a forked child.
fn unless_forked(call: impl FnOnce() -> Result<(), Refusal>) -> Result<(), Refusal> {
    if is_forked_child() { Err(Refusal::Forked) } else { caught(call) }
}

fn caught(call: impl FnOnce() -> Result<(), Refusal>) -> Result<(), Refusal> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(Refusal::Panicked(message(&*panic))))
}

fn finish(name: &'static str, handle: Handle, errno: c_int, outcome: Result<(), Refusal>) -> c_int {
    match outcome {
        Ok(()) => {
            // System calls of a successful call may have set errno, for example for a missing optional file or a
            // contended lock.
            process::set_errno(errno);
            0
        }
        Err(refusal) => refuse(name, handle, &refusal),
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or(panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capi::error_numbers::SUN2XP_ERROR_ARGUMENT;
    use crate::capi::thread_errors::find;
    use std::ffi::CStr;
    use std::thread;

    fn last_text() -> String {
        // SAFETY: the text belongs to this thread, which makes no refused call meanwhile.
        unsafe { CStr::from_ptr(find(Handle::NULL).text) }.to_string_lossy().into_owned()
    }

    #[test]
    fn a_panic_does_not_leave_the_boundary() {
        let result = guarded("SendPos", Handle::NULL, || panic!("a defect"));
        let errno = std::io::Error::last_os_error().raw_os_error();
        assert_eq!((result, errno), (-1, Some(libc::EIO)));
        assert_eq!(last_text(), "SendPos: the library failed (a defect): please report this defect of the library");
    }

    #[test]
    fn success_leaves_errno() {
        process::set_errno(libc::E2BIG);
        let call = || {
            process::set_errno(libc::ENOENT);
            Ok(())
        };
        assert_eq!((guarded("OpenHand", Handle::NULL, call), process::errno()), (0, libc::E2BIG));
    }

    #[test]
    fn every_thread_has_its_own_text_which_success_leaves_alone() {
        assert_eq!(last_text(), "");
        assert_eq!(guarded("GetPos", Handle::NULL, || Err(Refusal::NoHand)), -1);
        assert_eq!(guarded("SendPos", Handle::NULL, || Ok(())), 0);
        assert!(last_text().starts_with("GetPos: no hand is open"));
        thread::scope(|scope| scope.spawn(|| assert_eq!(last_text(), "")).join())
            .expect("another thread has no text yet");
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
            (delegated("OpenHand", Handle::NULL, MEMORY_OF_CALL, || Ok(elsewhere)), process::errno()),
            (0, libc::E2BIG),
            "{}",
            last_text()
        );
        let none = || -> Result<fn() -> Result<(), Refusal>, Refusal> {
            Err(Refusal::WrongSize { name: "Fault", size: 1, least: 2 })
        };
        assert_eq!(
            (delegated("sun2xp_write_black_box", Handle::NULL, MEMORY_OF_CALL, none), process::errno()),
            (-SUN2XP_ERROR_ARGUMENT, libc::EINVAL)
        );
        assert!(last_text().starts_with("sun2xp_write_black_box: Fault->size is 1"));
        assert_eq!(
            (delegated("OpenHand", Handle::NULL, MEMORY_OF_CALL, || Ok(|| Err(Refusal::NoHand))), process::errno()),
            (-1, libc::ENODEV)
        );
        assert!(last_text().starts_with("OpenHand: no hand is open"));
        assert_eq!(
            (delegated("OpenHand", Handle::NULL, MEMORY_OF_CALL, || Ok(|| panic!("a defect"))), process::errno()),
            (-1, libc::EIO)
        );
        assert!(last_text().starts_with("OpenHand: the library failed (a defect)"));
        assert_eq!(delegated_or_done_here("CloseHand", Handle::NULL, || || Err(Refusal::Busy)), -1);
        assert_eq!(process::errno(), libc::EBUSY);
    }
}

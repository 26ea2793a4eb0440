//! Protection of the library's code from pthread_cancel. A cancelled thread unwinds its stack. Unwinding a Rust frame
//! that has a destructor is undefined behaviour, and the thread would leave its locks taken.
#![allow(unsafe_code, reason = "C functions that the libc crate does not have")]

use std::ffi::c_int;

unsafe extern "C" {
    fn pthread_setcancelstate(state: c_int, before: *mut c_int) -> c_int;
    fn pthread_setcanceltype(kind: c_int, before: *mut c_int) -> c_int;
}

/// PTHREAD_CANCEL_DEFERRED, which has this value in every C library of Linux.
const DEFERRED: c_int = 0;

/// PTHREAD_CANCEL_DISABLE, which has this value in every C library of Linux.
const DISABLE: c_int = 1;

/// While this exists, the calling thread is cancelled only at cancellation points, not at any instruction. Almost every
/// planner has deferred cancellation already. Then [`DeferredCancellation::begin`] changes nothing and
/// [`DeferredCancellation::end`] does nothing, which costs less than disabling cancellation.
///
/// This struct has no destructor, so the frame that holds it has nothing to drop. This matters because an asynchronous
/// cancellation takes effect in [`DeferredCancellation::end`] and unwinds that frame.
#[must_use]
pub struct DeferredCancellation(c_int);

impl DeferredCancellation {
    /// Makes cancellation deferred, and stores the previous type.
    #[inline(always)]
    pub fn begin() -> Self {
        let mut before = DEFERRED;
        // SAFETY: the type is valid, and there is room for the previous one.
        unsafe { pthread_setcanceltype(DEFERRED, &mut before) };
        Self(before)
    }

    /// Restores the previous type. If that type is asynchronous and a cancellation is pending, the thread ends here.
    #[inline(always)]
    pub fn end(self) {
        if self.0 != DEFERRED {
            let mut before = DEFERRED;
            // SAFETY: the type is the thread's previous one, and there is room for the current one.
            unsafe { pthread_setcanceltype(self.0, &mut before) };
        }
    }
}

/// While this exists, the calling thread is not cancelled at all. It is used around cancellation points.
pub struct NoCancellation(c_int);

impl NoCancellation {
    /// Disables cancellation.
    pub fn begin() -> Self {
        let mut before = DISABLE;
        // SAFETY: the state is valid, and there is room for the previous one.
        unsafe { pthread_setcancelstate(DISABLE, &mut before) };
        Self(before)
    }
}

impl Drop for NoCancellation {
    fn drop(&mut self) {
        let mut before = DISABLE;
        // SAFETY: the state is the thread's previous one, and there is room for the current one. A pending cancellation
        // does not take effect in this call, because every thread that uses this struct either has deferred
        // cancellation, or is never cancelled.
        unsafe { pthread_setcancelstate(self.0, &mut before) };
    }
}

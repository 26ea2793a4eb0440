//! Keeps pthread_cancel away from the code of this library. A cancelled thread unwinds its stack, which no Rust frame
//! with anything to drop survives, and it would leave locks taken.
#![allow(unsafe_code, reason = "functions of C that the libc crate does not have")]

use std::ffi::c_int;

unsafe extern "C" {
    fn pthread_setcancelstate(state: c_int, before: *mut c_int) -> c_int;
    fn pthread_setcanceltype(kind: c_int, before: *mut c_int) -> c_int;
}

/// PTHREAD_CANCEL_DEFERRED of every C library of Linux.
const DEFERRED: c_int = 0;

/// PTHREAD_CANCEL_DISABLE of every C library of Linux.
const DISABLE: c_int = 1;

/// A thread that is cancelled only at cancellation points, and not at any instruction. Where it was so before, as in
/// almost every planner, this only reads: it costs less than to disable cancellation.
///
/// Without a destructor, so that the frame that holds it has nothing to drop: an asynchronous cancellation takes effect
/// in [`DeferredCancellation::end`], and unwinds that frame.
#[must_use]
pub struct DeferredCancellation(c_int);

impl DeferredCancellation {
    /// Begins it.
    #[inline(always)]
    pub fn begin() -> Self {
        let mut before = DEFERRED;
        // SAFETY: a valid type, and room for the one before.
        unsafe { pthread_setcanceltype(DEFERRED, &mut before) };
        Self(before)
    }

    /// Ends it. A thread that may be cancelled at any instruction, and was cancelled meanwhile, ends here.
    #[inline(always)]
    pub fn end(self) {
        if self.0 != DEFERRED {
            let mut before = DEFERRED;
            // SAFETY: the type that the thread had, and room for the one before.
            unsafe { pthread_setcanceltype(self.0, &mut before) };
        }
    }
}

/// A thread that is not cancelled at all while this exists: around cancellation points.
pub struct NoCancellation(c_int);

impl NoCancellation {
    /// Begins it.
    pub fn begin() -> Self {
        let mut before = DISABLE;
        // SAFETY: a valid state, and room for the one before.
        unsafe { pthread_setcancelstate(DISABLE, &mut before) };
        Self(before)
    }
}

impl Drop for NoCancellation {
    fn drop(&mut self) {
        let mut before = DISABLE;
        // SAFETY: the state that the thread had, and room for the one before. What was cancelled meanwhile takes effect
        // later: this is used only where cancellation is deferred, or ended by nobody.
        unsafe { pthread_setcancelstate(self.0, &mut before) };
    }
}

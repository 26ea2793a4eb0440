//! What the process around the hand does: fork, exit and errno.

use crate::capi::fault_texts::compose_texts;
use crate::capi::forked::{is_forked_child, mark_forked_child, mark_this_process};
use std::ffi::c_int;
use std::panic::catch_unwind;
use std::sync::OnceLock;

/// What exit calls; set with the first open.
static CLOSE: OnceLock<fn()> = OnceLock::new();

/// Watches for fork and exit from now on, and keeps ports away from the standard descriptors. To be called at every
/// open: a planner may have closed one since the last. `close`: what exit calls.
pub(super) fn watch(close: fn()) {
    keep_standard_descriptors();
    // Neither handler can be taken back.
    CLOSE.get_or_init(|| {
        compose_texts();
        mark_this_process();
        // SAFETY: both handlers are functions of this library, which stays loaded (`-z nodelete`), and no panic leaves
        // them. Out of memory is the only failure; then a planner's exit is what its death is: the boards' watchdogs
        // act.
        unsafe {
            libc::pthread_atfork(None, None, Some(in_forked_child));
            libc::atexit(at_exit);
        }
        close
    });
}

/// Opens /dev/null as those of descriptors 0 to 2 that the planner has closed: a board's port must not become its
/// standard error, or every text would go to the board.
fn keep_standard_descriptors() {
    loop {
        // SAFETY: a constant path; the descriptor that comes back is closed here or meant to stay.
        unsafe {
            let descriptor = libc::open(c"/dev/null".as_ptr(), libc::O_RDWR);
            if descriptor > libc::STDERR_FILENO {
                libc::close(descriptor);
            }
            if !(0..=libc::STDERR_FILENO).contains(&descriptor) {
                return;
            }
        }
    }
}

extern "C" fn in_forked_child() {
    mark_forked_child();
}

extern "C" fn at_exit() {
    if !is_forked_child()
        && let Some(&close) = CLOSE.get()
    {
        // Whatever goes wrong here, the process ends, and the boards' watchdogs see to the motors.
        let _ = catch_unwind(close);
    }
}

/// The calling thread's errno.
pub(super) fn errno() -> c_int {
    // SAFETY: the address of the calling thread's own errno is always valid.
    unsafe { *libc::__errno_location() }
}

/// Sets the calling thread's errno.
pub(super) fn set_errno(errno: c_int) {
    // SAFETY: the address of the calling thread's own errno is always valid.
    unsafe { *libc::__errno_location() = errno }
}

//! Handlers of fork and exit, standard descriptors, and errno.

use crate::capi::fault_texts::compose_texts;
use crate::capi::forked::{is_forked_child, mark_forked_child, mark_this_process};
use std::ffi::c_int;
use std::panic::catch_unwind;
use std::sync::OnceLock;

/// Function that the exit handler calls. The first call that opens a hand sets it.
static CLOSE: OnceLock<fn()> = OnceLock::new();

/// Registers the handlers of fork and exit, and replaces closed standard descriptors. This function must be called at
/// every open, because a planner may have closed a descriptor since the previous open. The exit handler calls `close`.
pub(super) fn prepare(close: fn()) {
    replace_closed_standard_descriptors();
    // Handlers cannot be unregistered, so they are registered once.
    CLOSE.get_or_init(|| {
        compose_texts();
        mark_this_process();
        // SAFETY: both handlers are functions of this library, which stays loaded (`-z nodelete`), and no panic leaves
        // a handler. Registration fails only if memory is exhausted. The boards' watchdogs then end the motion at exit.
        unsafe {
            libc::pthread_atfork(None, None, Some(in_forked_child));
            libc::atexit(at_exit);
        }
        close
    });
}

/// Opens /dev/null as each of the descriptors 0 to 2 that the planner has closed. Otherwise a board's port could become
/// standard error, and every message would be sent to the board.
fn replace_closed_standard_descriptors() {
    loop {
        // SAFETY: the path is a constant C string. The returned descriptor is closed here or stays open on purpose.
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
        // If this fails, the process ends anyway, and the boards' watchdogs end the motion.
        let _ = catch_unwind(close);
    }
}

/// Returns the calling thread's errno.
pub(super) fn errno() -> c_int {
    // SAFETY: the address of the calling thread's own errno is always valid.
    unsafe { *libc::__errno_location() }
}

/// Sets the calling thread's errno.
pub(super) fn set_errno(errno: c_int) {
    // SAFETY: the address of the calling thread's own errno is always valid.
    unsafe { *libc::__errno_location() = errno }
}

//! Checks whether this process has more rights than the user who started it.
#![allow(unsafe_code)]

/// Returns whether the program runs with more rights than its caller: it is setuid or setgid, or its file has
/// capabilities. Such a program must not trust what the caller controls, such as the environment and the working
/// directory.
pub fn raised_privileges() -> bool {
    // SAFETY: the call reads a value that the kernel stored at the start of this process, and has no other effect.
    unsafe { libc::getauxval(libc::AT_SECURE) != 0 }
}

//! Whether this process may do more than the user who has started it.
#![allow(unsafe_code)]

/// Whether the program was started with more rights than its caller has: it is setuid or setgid, or its file has
/// capabilities. What the caller decides is not to be trusted then, such as the environment and the working directory.
pub fn raised_privileges() -> bool {
    // SAFETY: it reads what the kernel has left for this process at its start, and has no other effect.
    unsafe { libc::getauxval(libc::AT_SECURE) != 0 }
}

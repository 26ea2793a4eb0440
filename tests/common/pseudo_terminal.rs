//! Opens pseudo-terminals that stand for the lines to boards.
#![allow(unsafe_code, reason = "a raw descriptor")]

use std::ffi::CStr;
use std::os::fd::{FromRawFd, OwnedFd};
use std::path::PathBuf;

/// Returns the controlling end of a new pseudo-terminal, and the path of the other end.
pub fn pseudo_terminal() -> (OwnedFd, PathBuf) {
    // SAFETY: takes no pointers.
    let control = unsafe { libc::posix_openpt(libc::O_RDWR | libc::O_NOCTTY | libc::O_CLOEXEC) };
    assert!(control >= 0, "a pseudo-terminal");
    let mut name = [0; 64];
    // SAFETY: the descriptor is open, and `name` has the size that the call gets.
    unsafe {
        assert_eq!((libc::grantpt(control), libc::unlockpt(control)), (0, 0));
        assert_eq!(libc::ptsname_r(control, name.as_mut_ptr(), name.len()), 0);
        let path = CStr::from_ptr(name.as_ptr()).to_str().expect("a path");
        (OwnedFd::from_raw_fd(control), PathBuf::from(path))
    }
}

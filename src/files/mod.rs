//! Reads and writes files. A path from a person or a program cannot make the library wait without end or exhaust its
//! memory. No failure and no other process can destroy the content of a file.

mod privileges;
mod regular;
mod replace;
mod update;

pub use privileges::raised_privileges;
pub use regular::{open_regular_file, read_regular_file};
pub use replace::{create_file, replace_file};
pub use update::{UpdateError, update_file};

use std::io::{Error, ErrorKind};

/// Returns the closest errno for an error of this module, whether or not the system reported one.
pub(crate) fn errno(error: &Error) -> i32 {
    error.raw_os_error().unwrap_or(match error.kind() {
        ErrorKind::InvalidInput | ErrorKind::InvalidData => libc::EINVAL,
        ErrorKind::FileTooLarge => libc::EFBIG,
        ErrorKind::AlreadyExists => libc::EEXIST,
        ErrorKind::ResourceBusy => libc::EBUSY,
        ErrorKind::Unsupported => libc::ENOTSUP,
        _ => libc::EIO,
    })
}

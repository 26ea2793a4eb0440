//! Files on disk, handled so that no path that a person or a program names can hang the library or exhaust its memory,
//! and so that no failure and no other process destroys what is in a file.

mod privileges;
mod regular;
mod replace;
mod update;

pub use privileges::raised_privileges;
pub use regular::{open_regular_file, read_regular_file};
pub use replace::{create_file, replace_file};
pub use update::{UpdateError, update_file};

use std::io::{Error, ErrorKind};

/// The errno that is nearest to an error of this module, which the system may have reported or not.
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

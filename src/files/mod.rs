//! Reads and writes files. Whatever path a user gives, the library neither waits without end nor exhausts its memory.
//! A file always has its complete old content or its complete new content, even if a write fails or if several
//! processes write at the same time.

mod layout;
mod privileges;
mod regular;
mod replace;
mod update;

pub use layout::with_line_ends_of;
pub use privileges::raised_privileges;
pub(crate) use regular::line_of_error;
pub use regular::{open_regular_file, read_regular_file};
#[cfg(feature = "internals")]
pub use replace::NewFile;
pub use replace::{create_file, replace_file};
pub use update::{UpdateError, update_file};

use std::io::{Error, ErrorKind};

/// Returns the remedy for an error in writing a file. The remedy begins with a full stop and a space, because the
/// caller appends it to the text of the error. The remedy is empty unless permission is missing or the file system is
/// read-only. The texts of other errors already show what to change, for example that the disk is full.
pub fn write_remedy(error: &Error) -> &'static str {
    match error.kind() {
        ErrorKind::PermissionDenied => ". Give this user permission to write the file and its folder",
        ErrorKind::ReadOnlyFilesystem => ". Make the file system writable, or choose a folder on another one",
        _ => "",
    }
}

/// Returns the errno of an error of this module. If the system has not reported one, returns the errno whose meaning is
/// closest.
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

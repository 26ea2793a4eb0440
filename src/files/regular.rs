//! Opens and reads files that must be regular files of a limited size.

use std::fs::{File, FileType, Metadata, OpenOptions, metadata};
use std::io::{self, Read, Take};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;
use std::str::Utf8Error;

/// Opens a regular file for reading. The reader ends after `largest` + 1 bytes, so that a file that grows while it is
/// read cannot fill the memory.
///
/// A path to a FIFO, a device, a socket or a directory is refused without waiting.
///
/// # Errors
/// Returns the error that the system reports, or an error of one of these kinds:
/// - [`io::ErrorKind::InvalidInput`] if the path does not lead to a regular file
/// - [`io::ErrorKind::FileTooLarge`] if the file has more than `largest` bytes
pub fn open_regular_file(path: &Path, largest: u64) -> io::Result<Take<File>> {
    Ok(open(path, OpenOptions::new().read(true), largest)?.take(largest.saturating_add(1)))
}

/// Opens a regular file of at most `largest` bytes with `options`.
pub(super) fn open(path: &Path, options: &mut OpenOptions, largest: u64) -> io::Result<File> {
    // Opening some devices has an effect: a modem line rises, a tape rewinds. So the kind is checked before the path is
    // opened.
    check(&metadata(path)?, largest)?;
    // O_NONBLOCK is set because the path may lead to a FIFO by now, and opening a FIFO would wait for a writer. The
    // flag has no effect on regular files.
    let file = options.custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY).open(path)?;
    // The path may have changed in between, so the opened file is checked too.
    check(&file.metadata()?, largest)?;
    Ok(file)
}

/// Reads a regular file of at most `largest` bytes as text.
///
/// # Errors
/// Returns the errors of [`open_regular_file`]. Returns [`io::ErrorKind::InvalidData`] if the file is not UTF-8 text.
/// The text of that error names the line.
pub fn read_regular_file(path: &Path, largest: u64) -> io::Result<String> {
    read_text(&mut open_regular_file(path, largest)?, largest)
}

/// Reads text of at most `largest` bytes.
pub(super) fn read_text(input: &mut impl Read, largest: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    input.take(largest.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest {
        return Err(too_large(largest));
    }
    String::from_utf8(bytes).map_err(|error| {
        let line = line_of_error(error.as_bytes(), error.utf8_error());
        io::Error::new(io::ErrorKind::InvalidData, format!("line {line} is not UTF-8 text"))
    })
}

/// Returns the number of the line, counted from 1, that is not UTF-8 text.
pub(crate) fn line_of_error(bytes: &[u8], error: Utf8Error) -> usize {
    bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1
}

/// Refuses everything except regular files.
pub(super) fn check_kind(kind: FileType) -> io::Result<()> {
    if kind.is_file() {
        return Ok(());
    }
    let reason = format!("it is {} and not a regular file", name_of(kind));
    Err(io::Error::new(io::ErrorKind::InvalidInput, reason))
}

fn check(metadata: &Metadata, largest: u64) -> io::Result<()> {
    check_kind(metadata.file_type())?;
    match metadata.len() {
        length if length > largest => Err(too_large(largest)),
        _ => Ok(()),
    }
}

fn too_large(largest: u64) -> io::Error {
    io::Error::new(io::ErrorKind::FileTooLarge, format!("it is larger than {largest} bytes"))
}

fn name_of(kind: FileType) -> &'static str {
    match kind {
        kind if kind.is_dir() => "a directory",
        kind if kind.is_symlink() => "a symbolic link",
        kind if kind.is_fifo() => "a FIFO (a pipe)",
        kind if kind.is_socket() => "a socket",
        kind if kind.is_char_device() || kind.is_block_device() => "a device",
        _ => "a file of an unknown kind",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::{create_dir, write};
    use std::os::unix::net::UnixListener;
    use std::process::Command;

    fn refused(path: &Path) -> String {
        read_regular_file(path, 1000).expect_err("refused").to_string()
    }

    #[test]
    fn text_up_to_the_limit_is_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        for length in [0, 1, 1000] {
            write(&file, "x".repeat(length)).expect("written");
            assert_eq!(read_regular_file(&file, 1000).expect("read").len(), length);
        }
        write(&file, "x".repeat(1001)).expect("written");
        assert_eq!(refused(&file), "it is larger than 1000 bytes");
    }

    #[test]
    fn a_path_to_anything_but_a_regular_file_is_refused_with_its_kind() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        assert!(Command::new("mkfifo").arg(path("fifo")).status().expect("mkfifo").success());
        create_dir(path("folder")).expect("made");
        let _socket = UnixListener::bind(path("socket")).expect("bound");
        std::os::unix::fs::symlink("/dev/zero", path("link")).expect("made");
        for (name, kind) in
            [("fifo", "a FIFO (a pipe)"), ("folder", "a directory"), ("socket", "a socket"), ("link", "a device")]
        {
            assert_eq!(refused(&path(name)), format!("it is {kind} and not a regular file"));
        }
        assert_eq!(refused(Path::new("/dev/zero")), "it is a device and not a regular file");
        assert!(refused(&path("missing")).contains("No such file"));
    }

    #[test]
    fn a_file_without_a_size_is_read_up_to_the_limit() {
        // The kernel reports no size for files in /proc.
        let maps = Path::new("/proc/self/maps");
        assert!(read_regular_file(maps, 1 << 20).expect("read").contains("[stack]"));
        assert_eq!(read_regular_file(maps, 10).expect_err("refused").kind(), io::ErrorKind::FileTooLarge);
    }

    #[test]
    fn the_error_names_the_line_that_is_not_text() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        write(&file, b"one\ntwo\n\xff\nfour\n").expect("written");
        assert_eq!(refused(&file), "line 3 is not UTF-8 text");
    }
}

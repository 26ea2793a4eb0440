//! Changes a file that other processes may change too. The file is read, changed and replaced under a lock.

use super::regular::{open, read_text};
use super::replace::NewFile;
use std::fs::{File, Metadata, OpenOptions, TryLockError, metadata};
use std::io::{self, ErrorKind, Write};
use std::os::unix::fs::MetadataExt;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Maximum time that an update waits for other updates. Each of them takes some milliseconds.
const PATIENCE: Duration = Duration::from_secs(30);

/// Interval between attempts to take the lock. The system offers no wait with a time-out for this lock.
const LOOKING: Duration = Duration::from_millis(5);

/// Why an update failed. The file is unchanged, with one exception: if writing its folder to the disk failed, the file
/// has already been replaced.
#[derive(Debug)]
pub enum UpdateError<E> {
    /// An error that the system reported, or an error of one of the kinds that [`update_file`] lists.
    File(io::Error),
    /// The change was refused. The function that changes the text returned this error.
    Change(E),
}

impl<E> From<io::Error> for UpdateError<E> {
    fn from(error: io::Error) -> Self {
        Self::File(error)
    }
}

/// Replaces the text of the file at `path` by the result of `change`. If `change` returns `None`, the file stays
/// unchanged.
///
/// Updates of a file by several threads and processes exclude each other. Each waits for the others, at most 30
/// seconds. If a program that does not use the lock, such as an editor, changes the file meanwhile, `change` is called
/// again with the new text. Only a change between the last check and the replacement is not detected. The file is
/// replaced as by [`replace_file`](super::replace_file). A symbolic link is kept, and its target is replaced. The lock
/// belongs to the open file, so the system releases it when the process ends.
///
/// # Errors
/// Returns the error of `change`, the error that the system reports, or an error of one of these kinds:
/// - [`io::ErrorKind::InvalidInput`] if the path does not lead to a regular file
/// - [`io::ErrorKind::InvalidData`] if the file is not UTF-8 text
/// - [`io::ErrorKind::FileTooLarge`] if the file has more than `largest` bytes
/// - [`io::ErrorKind::ResourceBusy`] if other threads or processes do not release the file in time, or keep changing it
/// - [`io::ErrorKind::Unsupported`] if the file system does not support locks
pub fn update_file<E>(
    path: &Path,
    largest: u64,
    mut change: impl FnMut(&str) -> Result<Option<String>, E>,
) -> Result<(), UpdateError<E>> {
    let path = &path.canonicalize()?;
    let deadline = Instant::now() + PATIENCE;
    loop {
        // The file is opened for writing although it is replaced and not written. A user without write permission must
        // not replace it, and a network file system locks only a file that is open for writing.
        let file = Locked::new(open(path, OpenOptions::new().read(true).write(true), largest)?, deadline)?;
        let old = file.0.metadata()?;
        // If the versions differ, another process replaced the file while this one waited for the lock of the old file.
        if version(&metadata(path)?) == version(&old) {
            let text = read_text(&mut &file.0, largest)?;
            let Some(changed) = change(&text).map_err(UpdateError::Change)? else { return Ok(()) };
            let mut new = NewFile::beside(path, Some(&old))?;
            new.output.write_all(changed.as_bytes())?;
            new.flush()?;
            if version(&metadata(path)?) == version(&old) {
                return Ok(new.replace(path)?);
            }
        }
        if Instant::now() > deadline {
            return Err(busy("another program keeps changing the file: end that program and try again").into());
        }
    }
}

/// A file that is locked until this value is dropped.
struct Locked(File);

impl Locked {
    fn new(file: File, deadline: Instant) -> io::Result<Self> {
        loop {
            match file.try_lock() {
                Ok(()) => return Ok(Self(file)),
                Err(TryLockError::WouldBlock) if Instant::now() < deadline => sleep(LOOKING),
                Err(TryLockError::WouldBlock) => {
                    let seconds = PATIENCE.as_secs();
                    return Err(busy(&format!(
                        "another process has kept the file locked for {seconds} s: end that process (fuser shows it)"
                    )));
                }
                Err(TryLockError::Error(error)) => return Err(unlockable(error)),
            }
        }
    }
}

impl Drop for Locked {
    fn drop(&mut self) {
        // A child forked meanwhile also has the file open, and would otherwise keep the lock.
        let _ = self.0.unlock();
    }
}

fn busy(reason: &str) -> io::Error {
    io::Error::new(ErrorKind::ResourceBusy, reason)
}

/// Refuses a file system without locks, because without a lock the changes of others could be lost.
fn unlockable(error: io::Error) -> io::Error {
    match error.raw_os_error() {
        Some(libc::ENOLCK | libc::ENOSYS | libc::EOPNOTSUPP) => {
            let reason =
                format!("its file system does not support locks ({error}): move the file to another file system");
            io::Error::new(ErrorKind::Unsupported, reason)
        }
        _ => error,
    }
}

/// Returns a value that changes when a file is replaced or written.
fn version(file: &Metadata) -> [u64; 5] {
    [file.dev(), file.ino(), file.size(), file.mtime() as u64, file.mtime_nsec() as u64]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn append(line: &str) -> impl FnMut(&str) -> Result<Option<String>, String> {
        move |text| Ok(Some(format!("{text}{line}\n")))
    }

    #[test]
    fn no_update_of_several_threads_is_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "").expect("written");
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let file = &file;
                scope.spawn(move || {
                    (0..25).for_each(|turn| {
                        update_file(file, 10_000, append(&format!("{thread} {turn}"))).expect("updated")
                    });
                });
            }
        });
        let text = fs::read_to_string(&file).expect("read");
        for thread in 0..4 {
            let own: Vec<_> = text.lines().filter_map(|line| line.strip_prefix(&format!("{thread} "))).collect();
            assert_eq!(own, (0..25).map(|turn| turn.to_string()).collect::<Vec<_>>());
        }
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }

    #[test]
    fn a_change_without_the_lock_is_read_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, other) = (folder.path().join("file"), folder.path().join("other"));
        fs::write(&file, "old\n").expect("written");
        let mut seen = Vec::new();
        let change = |text: &str| {
            seen.push(text.to_string());
            if seen.len() == 1 {
                fs::write(&other, "edited\n").expect("written");
                fs::rename(&other, &file).expect("renamed");
            }
            Ok::<_, String>(Some(format!("{text}new\n")))
        };
        update_file(&file, 1000, change).expect("updated");
        assert_eq!(seen, ["old\n", "edited\n"]);
        assert_eq!(fs::read_to_string(&file).expect("read"), "edited\nnew\n");
    }

    #[test]
    fn a_link_is_kept_and_its_target_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "").expect("written");
        std::os::unix::fs::symlink("file", &link).expect("made");
        update_file(&link, 1000, append("new")).expect("updated");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read_to_string(&file).expect("read"), "new\n");
    }

    #[test]
    fn a_held_lock_is_awaited_only_until_the_deadline() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "old").expect("written");
        let kept = File::open(&file).expect("open");
        kept.lock().expect("locked");
        let open = || File::open(&file).expect("open");
        let error = Locked::new(open(), Instant::now()).err().expect("locked already");
        assert_eq!(error.kind(), ErrorKind::ResourceBusy);
        assert!(error.to_string().contains("another process"), "{error}");
        drop(kept);
        drop(Locked::new(open(), Instant::now()).expect("free"));
        Locked::new(open(), Instant::now()).expect("free again");
    }

    #[test]
    fn a_refused_change_and_no_change_leave_the_file_unchanged() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, "old").expect("written");
        let before = version(&metadata(&file).expect("there"));
        let refused = update_file(&file, 1000, |_| Err("no"));
        assert!(matches!(refused, Err(UpdateError::Change("no"))));
        update_file(&file, 1000, |_| Ok::<_, String>(None)).expect("nothing to do");
        let large = update_file(&file, 2, append("new"));
        assert!(matches!(large, Err(UpdateError::File(error)) if error.kind() == ErrorKind::FileTooLarge));
        assert!(matches!(update_file(Path::new("/dev/null"), 2, append("new")), Err(UpdateError::File(_))));
        assert_eq!(version(&metadata(&file).expect("there")), before);
        // The lock has been released.
        File::open(&file).expect("open").try_lock().expect("free");
    }
}

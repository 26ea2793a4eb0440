//! Writes each file completely under a temporary name in its folder, and then moves it to its place in one step.

use super::regular::check_kind;
use std::collections::hash_map::RandomState;
use std::fs::{self, File, Metadata, OpenOptions, Permissions};
use std::hash::{BuildHasher, Hasher};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt, fchown};
use std::path::{Path, PathBuf};

/// Number of temporary names that are tried. Two names of 64 random bits are never equal by accident.
const ATTEMPTS: u32 = 16;

/// The bits of a mode that a new file inherits. Set-user-ID, set-group-ID and sticky are not inherited.
const PERMISSIONS: u32 = 0o777;

/// Writes a file with the content that `write` gives. The new file replaces the file at `path`, if there is one.
///
/// A reader sees either the complete old file or the complete new one, even after a power cut. If anything fails before
/// the replacement, the old file stays unchanged. If the folder cannot be flushed afterwards, the call fails although
/// the new file is in its place. The new file gets the permissions of the old one, and its owner and group if this
/// process may set them.
///
/// Symbolic links are not followed. A caller that wants to replace the target of a link must resolve the link first.
///
/// # Errors
/// Returns the error that the system reports. Returns [`io::ErrorKind::InvalidInput`] if `path` is not a regular file.
pub fn replace_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let old = match fs::symlink_metadata(path) {
        Ok(old) => Some(old),
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    old.as_ref().map_or(Ok(()), |old| check_kind(old.file_type()))?;
    let mut new = NewFile::beside(path, old.as_ref())?;
    write(&mut new.output)?;
    new.flush()?;
    new.replace(path)
}

/// Writes a file under the first of `names` that is free in `folder`, and returns its path. The file appears complete,
/// and no file is overwritten. Exception: on a file system without hard links, a file that another process creates
/// under this name at the same time can be overwritten.
///
/// # Errors
/// Returns the error that the system reports. Returns [`io::ErrorKind::AlreadyExists`] if no name is free.
pub fn create_file(
    folder: &Path,
    names: impl IntoIterator<Item = String>,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<PathBuf> {
    let mut new = NewFile::inside(folder, None)?;
    write(&mut new.output)?;
    new.flush()?;
    for name in names {
        let path = folder.join(name);
        match new.place_at_free(&path) {
            Ok(()) => return flush_folder(folder).map(|()| path),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(ErrorKind::AlreadyExists.into())
}

/// A file under a temporary name. Dropping this value removes the temporary name, unless the file was moved to its
/// place. A file that a killed process leaves behind is never read.
pub struct NewFile {
    folder: PathBuf,
    path: PathBuf,
    /// The content goes here.
    pub output: BufWriter<File>,
    placed: bool,
}

impl NewFile {
    /// Creates a file in the folder of `target`, to replace a file with the metadata `old`.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn beside(target: &Path, old: Option<&Metadata>) -> io::Result<Self> {
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        Self::inside(folder, old)
    }

    fn inside(folder: &Path, old: Option<&Metadata>) -> io::Result<Self> {
        // The old file may be secret, so no other user may read the new file until it has the owner of the old one.
        // Without an old file, the umask determines the permissions, as usual.
        let mode = if old.is_some() { 0o600 } else { 0o666 };
        let (path, file) = create_unpredictable(folder, mode)?;
        let new = Self { folder: folder.into(), path, output: BufWriter::new(file), placed: false };
        if let Some(old) = old {
            inherit(new.output.get_ref(), old)?;
        }
        Ok(new)
    }

    /// Moves the file to `path`, and replaces the file there if it exists.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn replace(mut self, path: &Path) -> io::Result<()> {
        fs::rename(&self.path, path)?;
        self.placed = true;
        flush_folder(&self.folder)
    }

    /// Writes everything to the disk.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn flush(&mut self) -> io::Result<()> {
        self.output.flush()?;
        self.output.get_ref().sync_all()
    }

    /// Gives the file its final name, if the name is free.
    ///
    /// # Errors
    /// Returns the error that the system reports, [`io::ErrorKind::AlreadyExists`] if the name is not free.
    pub fn place_at_free(&mut self, path: &Path) -> io::Result<()> {
        match fs::hard_link(&self.path, path) {
            // Dropping this value removes the temporary name.
            Ok(()) => Ok(()),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
            // The file system has no hard links (FAT, for example). If another process creates a file at `path` after
            // this check, the rename overwrites that file.
            Err(_) if fs::symlink_metadata(path).is_err() => {
                fs::rename(&self.path, path)?;
                self.placed = true;
                Ok(())
            }
            Err(_) => Err(ErrorKind::AlreadyExists.into()),
        }
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if !self.placed {
            // If the file cannot be removed, it stays behind. No other remedy exists.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Creates a file under a name that an attacker cannot predict.
fn create_unpredictable(folder: &Path, mode: u32) -> io::Result<(PathBuf, File)> {
    let mut last = io::Error::from(ErrorKind::AlreadyExists);
    for _ in 0..ATTEMPTS {
        // The keys of a RandomState come from the system's random numbers.
        let path = folder.join(format!(".sun2xp-{:016x}.new", RandomState::new().build_hasher().finish()));
        // create_new sets O_EXCL, so that neither an existing file nor a link under this name is opened.
        let opened =
            OpenOptions::new().write(true).create_new(true).mode(mode).custom_flags(libc::O_NOFOLLOW).open(&path);
        match opened {
            Ok(file) => return Ok((path, file)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => last = error,
            Err(error) => return Err(error),
        }
    }
    Err(last)
}

/// Sets owner, group and permissions to those of the old file, where this process is permitted to set them.
fn inherit(file: &File, old: &Metadata) -> io::Result<()> {
    let new = file.metadata()?;
    let mut mode = old.mode() & PERMISSIONS;
    if new.uid() != old.uid() {
        // Only root may change the owner of a file. If the user of this process replaces another user's file, the new
        // file belongs to the user of this process.
        let _ = fchown(file, Some(old.uid()), None);
    }
    if new.gid() != old.gid() && fchown(file, None, Some(old.gid())).is_err() {
        // The new file does not have the old group, so its group gets at most the permissions that others have.
        mode &= 0o707 | (mode & 0o007) << 3;
    }
    // A file system without permissions refuses to set any, so they are set only if they differ.
    if file.metadata()?.mode() & PERMISSIONS == mode {
        return Ok(());
    }
    file.set_permissions(Permissions::from_mode(mode))
}

/// Writes the folder to the disk. Without this step, a power cut can undo the new name of the file.
fn flush_folder(folder: &Path) -> io::Result<()> {
    // A folder that cannot be opened for reading is not an error, because the file is already at its place. A power cut
    // may then undo its new name.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        // This file system cannot flush folders.
        Err(error) if error.kind() == ErrorKind::InvalidInput => Ok(()),
        flushed => flushed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;
    use tempfile::{TempDir, tempdir};

    fn write(text: &'static str) -> impl FnOnce(&mut dyn Write) -> io::Result<()> {
        move |output| output.write_all(text.as_bytes())
    }

    fn folder() -> (TempDir, PathBuf) {
        let folder = tempdir().expect("a folder");
        let file = folder.path().join("file");
        (folder, file)
    }

    fn names(folder: &TempDir) -> Vec<String> {
        let entries = fs::read_dir(folder.path()).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    fn mode(file: &Path) -> u32 {
        fs::metadata(file).expect("there").mode() & 0o7777
    }

    #[test]
    fn a_file_is_created_or_replaced() {
        let (folder, file) = folder();
        for text in ["one", "another"] {
            replace_file(&file, write(text)).expect("written");
            assert_eq!(fs::read_to_string(&file).expect("read"), text);
            assert_eq!(names(&folder), ["file"]);
        }
    }

    #[test]
    fn a_failed_write_changes_nothing_and_leaves_no_file() {
        let (folder, file) = folder();
        let fail = |output: &mut dyn Write| {
            output.write_all(b"the first half")?;
            Err(io::Error::from_raw_os_error(libc::ENOSPC))
        };
        assert_eq!(replace_file(&file, fail).expect_err("failed").raw_os_error(), Some(libc::ENOSPC));
        assert!(names(&folder).is_empty());
        fs::write(&file, "old").expect("written");
        assert_eq!(replace_file(&file, fail).expect_err("failed").raw_os_error(), Some(libc::ENOSPC));
        assert_eq!(fs::read_to_string(&file).expect("read"), "old");
        assert_eq!(names(&folder), ["file"]);
        create_file(folder.path(), ["file".into(), "other".into()], fail).expect_err("failed");
        assert_eq!(names(&folder), ["file"]);
    }

    #[test]
    fn links_and_devices_are_refused() {
        let (folder, file) = folder();
        fs::write(folder.path().join("victim"), "precious").expect("written");
        symlink("victim", &file).expect("made");
        assert_eq!(replace_file(&file, write("new")).expect_err("refused").kind(), ErrorKind::InvalidInput);
        assert_eq!(fs::read_to_string(&file).expect("read"), "precious");
        for path in [Path::new("/dev/null"), folder.path()] {
            assert_eq!(replace_file(path, write("new")).expect_err("refused").kind(), ErrorKind::InvalidInput);
        }
        assert_eq!(names(&folder), ["file", "victim"]);
    }

    #[test]
    fn permissions_are_inherited_without_special_bits() {
        let (_folder, file) = folder();
        fs::write(&file, "old").expect("written");
        for (before, after) in [(0o600, 0o600), (0o664, 0o664), (0o4750, 0o750)] {
            fs::set_permissions(&file, Permissions::from_mode(before)).expect("set");
            replace_file(&file, write("new")).expect("written");
            assert_eq!(mode(&file), after);
        }
    }

    #[test]
    fn a_file_with_the_wanted_name_is_not_overwritten() {
        let (folder, file) = folder();
        fs::write(&file, "old").expect("written");
        symlink("nowhere", folder.path().join("link")).expect("made");
        let candidates = ["file", "link", "third"].map(String::from);
        let path = create_file(folder.path(), candidates.clone(), write("new")).expect("written");
        assert_eq!(path, folder.path().join("third"));
        assert_eq!(fs::read_to_string(&file).expect("read"), "old");
        let error = create_file(folder.path(), candidates, write("new")).expect_err("every name is taken");
        assert_eq!(error.kind(), ErrorKind::AlreadyExists);
        assert_eq!(names(&folder), ["file", "link", "third"]);
    }

    #[test]
    fn temporary_names_differ() {
        let (folder, _) = folder();
        let made: std::collections::BTreeSet<PathBuf> =
            (0..100).map(|_| create_unpredictable(folder.path(), 0o600).expect("made").0).collect();
        assert_eq!(made.len(), 100);
    }
}

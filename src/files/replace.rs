//! Writes each file completely under a temporary name in its folder, and then moves it to its place in one step.

use super::regular::check_kind;
use std::collections::hash_map::RandomState;
use std::fs::{self, File, Metadata, OpenOptions, Permissions};
use std::hash::{BuildHasher, Hasher};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::iter;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt, fchown};
use std::path::{Path, PathBuf};

/// Number of temporary names that are tried. Names of 64 random bits are not equal by accident, so a second attempt is
/// needed only if somebody creates files with such names on purpose.
const ATTEMPTS: usize = 16;

/// The bits of a mode that a new file inherits. Set-user-ID, set-group-ID and sticky are not inherited.
const PERMISSIONS: u32 = 0o777;

/// Writes a file with the content that `write` gives. The new file replaces the file at `path`, if there is one.
///
/// A reader sees either the complete old file or the complete new one, even after a power cut. If anything fails before
/// the replacement, the old file stays unchanged. If flushing the folder fails afterwards, the call fails although the
/// new file is in its place. The call does not fail if the folder cannot be opened for reading, or if its file system
/// cannot flush folders. A power cut can then undo the replacement.
///
/// The new file gets the permissions of the old one, and its owner and group if this process may set them. If it may
/// not set the group, the new file's group gets at most the permissions that others have.
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
    /// Creates a file in the folder of `target`. `old` is the metadata of the file that it will replace, if there is
    /// one. The new file inherits permissions, owner and group from that file.
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
            // The error is ignored: a file that cannot be removed stays behind.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Creates a file under a name that an attacker cannot predict.
fn create_unpredictable(folder: &Path, mode: u32) -> io::Result<(PathBuf, File)> {
    create_under_free_name(folder, iter::repeat_with(unpredictable_name).take(ATTEMPTS), mode)
}

/// Returns a name with 64 random bits.
fn unpredictable_name() -> String {
    // The keys of a RandomState come from the system's random numbers.
    format!(".sun2xp-{:016x}.new", RandomState::new().build_hasher().finish())
}

/// Creates a file under the first of `names` that is free in `folder`.
fn create_under_free_name(
    folder: &Path,
    names: impl IntoIterator<Item = String>,
    mode: u32,
) -> io::Result<(PathBuf, File)> {
    let mut last = io::Error::from(ErrorKind::AlreadyExists);
    for name in names {
        let path = folder.join(name);
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
mod tests;

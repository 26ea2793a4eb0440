//! Where rows of CSV go: to standard output, or to a file that gets its name when all rows are written.

use crate::failure::{Failure, unwritable, wrong_usage};
use std::fs;
use std::io::{self, BufWriter, ErrorKind, Stdout, Write};
use std::path::{Path, PathBuf};
use sun2xp::files::NewFile;
use sun2xp::model::ShownPath;

/// An output. A file that is dropped without [`Output::place`] leaves the folder as it was.
pub enum Output {
    Standard(BufWriter<Stdout>),
    File {
        path: PathBuf,
        /// The file at `path`, or the file to which a symbolic link leads.
        target: PathBuf,
        file: NewFile,
    },
}

impl Output {
    pub fn standard() -> Self {
        Self::Standard(BufWriter::new(io::stdout()))
    }

    /// Begins a file. Without `force` there must be no file at `path`.
    ///
    /// # Errors
    /// Returns an error if there is a file at `path` and `force` is false, if there is something other than a regular
    /// file at `path`, or if the folder cannot be written.
    pub fn file(path: PathBuf, force: bool) -> Result<Self, Failure> {
        let old = fs::metadata(&path).ok();
        if old.as_ref().is_some_and(|old| !old.is_file()) {
            let shown = ShownPath(&path);
            return Err(format!("cannot replace {shown}: it is not a regular file. Choose another --output").into());
        }
        if fs::symlink_metadata(&path).is_ok() && !force {
            return Err(exists(&path));
        }
        let target = path.canonicalize().unwrap_or_else(|_| path.clone());
        let file = NewFile::beside(&target, old.as_ref()).map_err(|error| unwritable(&path, &error))?;
        Ok(Self::File { path, target, file })
    }

    pub fn writer(&mut self) -> &mut dyn Write {
        match self {
            Self::Standard(output) => output,
            Self::File { file, .. } => &mut file.output,
        }
    }

    /// Writes everything that is still in the buffer.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn flush(&mut self) -> Result<(), Failure> {
        match self {
            Self::Standard(output) => Ok(output.flush()?),
            Self::File { path, file, .. } => file.flush().map_err(|error| unwritable(path, &error)),
        }
    }

    /// Gives a file its name. Returns the path, or `None` for standard output.
    ///
    /// # Errors
    /// Returns an error if `force` is false and somebody has made a file at this path meanwhile, or if the system
    /// reports an error.
    pub fn place(self, force: bool) -> Result<Option<PathBuf>, Failure> {
        let Self::File { path, target, mut file } = self else { return Ok(None) };
        let placed = if force { file.replace(&target) } else { file.place_at_free(&target) };
        match placed {
            Ok(()) => Ok(Some(path)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(exists(&path)),
            Err(error) => Err(unwritable(&path, &error)),
        }
    }
}

fn exists(path: &Path) -> Failure {
    wrong_usage(format!("{} exists: replace it with --force", ShownPath(path)))
}

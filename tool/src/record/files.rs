//! The files of a recording. Each can be read by itself: a new file begins with the description and the controllers.

use crate::failure::{Failure, unwritable};
use crate::monitor::words::utc;
use crate::recording::RecordingWriter;
use std::collections::{BTreeMap, VecDeque};
use std::error::Error;
use std::fmt::{self, Display, Formatter};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind};
use std::iter::successors;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};
use sun2xp::files::write_remedy;
use sun2xp::model::{FingerNumber, ShownPath};
use sun2xp::telemetry::{Description, Message};

/// Largest number of controllers per finger at the beginning of a new file. One is not enough: a cycle names its own
/// controller, and the controller that was replaced in that cycle.
const MOST_CONTROLLERS: usize = 4;

/// When a new file begins, and how many files are kept.
#[derive(Clone, Copy, Default)]
pub struct Limits {
    /// Size at which a new file begins, bytes.
    pub bytes: Option<u64>,
    /// Age at which a new file begins.
    pub age: Option<Duration>,
    /// Largest number of files.
    pub keep: Option<u32>,
}

/// Writes messages into one file after the other.
pub struct Files {
    first: PathBuf,
    limits: Limits,
    description: Description,
    controllers: BTreeMap<FingerNumber, VecDeque<Message>>,
    file: OpenFile,
    /// The files that are kept, from the oldest to the present one.
    paths: VecDeque<PathBuf>,
    /// Old files that could not be deleted. The deletion is tried again whenever a new file begins.
    undeleted: Vec<PathBuf>,
    /// Number of files that have been begun.
    begun: u32,
    /// Number in the name of the present file.
    number: u32,
    /// Bytes of the finished files.
    finished: u64,
}

/// The present file.
struct OpenFile {
    path: PathBuf,
    writer: RecordingWriter<BufWriter<File>>,
    since: Instant,
}

/// What [`Files::turn`] has done.
#[derive(Default)]
pub struct Turn {
    /// Whether a new file has begun.
    pub begun: bool,
    /// Why an old file could not be deleted.
    pub undeleted: Option<String>,
}

/// The files that were written. The command prints this value at the end of a recording.
pub struct Written {
    last: PathBuf,
    count: u32,
    bytes: u64,
}

impl Files {
    /// Begins the first file. `time` is the beginning of the recording, ns of the monotonic clock. Without `output`,
    /// the file is in the working directory, and its name consists of the hand's name, the date and the time of day.
    ///
    /// # Errors
    /// Returns an error if the file exists or cannot be written.
    pub fn begin(
        output: Option<PathBuf>,
        description: &Description,
        limits: Limits,
        time: u64,
    ) -> Result<Self, Failure> {
        let first = output.unwrap_or_else(|| PathBuf::from(format!("{}-{}.mcap", description.name, date_and_time())));
        let created = create_new(&first).map_err(|error| uncreated(&first, &error))?;
        let file = OpenFile::begin(first.clone(), created, description, time)?;
        Ok(Self {
            paths: [first.clone()].into(),
            undeleted: Vec::new(),
            first,
            limits,
            description: description.clone(),
            controllers: BTreeMap::new(),
            file,
            begun: 1,
            number: 1,
            finished: 0,
        })
    }

    /// The present file.
    pub fn path(&self) -> &Path {
        &self.file.path
    }

    /// The size of all files that have been written, bytes.
    pub fn bytes(&self) -> u64 {
        self.finished + self.file.bytes()
    }

    /// Writes a message.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write(&mut self, message: &Message) -> Result<(), Failure> {
        if let Message::Controller { finger, .. } = message {
            let known = self.controllers.entry(*finger).or_default();
            known.push_back(message.clone());
            if known.len() > MOST_CONTROLLERS {
                known.pop_front();
            }
        }
        self.file.explain(|writer| writer.write(message))
    }

    /// Marks lost cycles.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write_lost(&mut self, finger: FingerNumber, cycles: u64) -> Result<(), Failure> {
        self.file.explain(|writer| writer.write_lost(finger, cycles))
    }

    /// Ends a batch of messages. Writes the buffered messages if the last write is at least half a second old.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn flush(&mut self) -> Result<(), Failure> {
        self.file.explain(RecordingWriter::flush_if_due)
    }

    /// Begins a new file if the present one has reached a limit.
    ///
    /// # Errors
    /// Returns an error if a file cannot be written.
    pub fn turn(&mut self) -> Result<Turn, Failure> {
        let full = self.limits.bytes.is_some_and(|most| self.file.bytes() >= most);
        let old = self.limits.age.is_some_and(|most| self.file.since.elapsed() >= most);
        if !full && !old {
            return Ok(Turn::default());
        }
        let (path, created) = self.create_next()?;
        // Messages of the new file that precede its first cycle get the time of the newest cycle in the present file.
        let next = OpenFile::begin(path, created, &self.description, self.file.writer.time())?;
        self.begun += 1;
        let last = std::mem::replace(&mut self.file, next);
        self.finished += last.finish()?;
        self.paths.push_back(self.file.path.clone());
        for message in self.controllers.values().flatten() {
            self.file.explain(|writer| writer.write(message))?;
        }
        Ok(Turn { begun: true, undeleted: self.delete_oldest() })
    }

    /// Creates the file with the next free number. Earlier recordings may have left files with higher numbers.
    fn create_next(&mut self) -> Result<(PathBuf, File), Failure> {
        loop {
            self.number += 1;
            let path = numbered(&self.first, self.number);
            match create_new(&path) {
                Ok(created) => return Ok((path, created)),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(error) => return Err(uncreated(&path, &error)),
            }
        }
    }

    /// Deletes the oldest file if there are too many. Tries again to delete earlier files that could not be deleted.
    /// Returns the reason if the oldest file cannot be deleted. The recording then continues, because the cycles matter
    /// more than the space.
    fn delete_oldest(&mut self) -> Option<String> {
        self.undeleted.retain(|path| delete(path).is_err());
        let superfluous = self.limits.keep.is_some_and(|keep| self.paths.len() > keep as usize);
        let path = superfluous.then(|| self.paths.pop_front()).flatten()?;
        let error = delete(&path).err()?;
        let message = undeleted(&path, &error);
        self.undeleted.push(path);
        Some(message)
    }

    /// Ends the last file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn finish(self) -> Result<Written, Failure> {
        let last = self.file.path.clone();
        let bytes = self.finished + self.file.finish()?;
        Ok(Written { last, count: self.begun, bytes })
    }
}

impl OpenFile {
    fn begin(path: PathBuf, file: File, description: &Description, time: u64) -> Result<Self, Failure> {
        match RecordingWriter::new(BufWriter::new(file), description, time) {
            Ok(writer) => Ok(Self { path, writer, since: Instant::now() }),
            Err(error) => {
                // The file has no cycle, and would be in the way of the next attempt.
                let _ = fs::remove_file(&path);
                Err(unwritten(&path, error.as_ref()))
            }
        }
    }

    /// Calls `write`. If it fails, the error that is returned names the file.
    fn explain(
        &mut self,
        write: impl FnOnce(&mut RecordingWriter<BufWriter<File>>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let path = &self.path;
        write(&mut self.writer).map_err(|error| unwritten(path, error.as_ref()))
    }

    /// The size of the file now, bytes. The messages of the last half second are not written yet.
    fn bytes(&self) -> u64 {
        fs::metadata(&self.path).map_or(0, |metadata| metadata.len())
    }

    /// Ends the file, and returns its size.
    fn finish(self) -> Result<u64, Failure> {
        let Self { path, writer, .. } = self;
        let file = writer.finish().map_err(|error| unwritten(&path, error.as_ref()))?;
        let file = file.into_inner().map_err(|error| unwritable(&path, error.error()))?;
        Ok(file.metadata().map_err(|error| unwritable(&path, &error))?.len())
    }
}

impl Display for Written {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", ShownPath(&self.last))?;
        let megabytes = self.bytes as f64 * 1e-6;
        match self.count {
            1 => write!(formatter, ", {megabytes:.1} MB"),
            count => write!(formatter, ", the last of {count} files, together {megabytes:.1} MB"),
        }
    }
}

fn create_new(path: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).create_new(true).open(path)
}

/// Deletes a file, unless the user has moved or deleted it already.
fn delete(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
        deleted => deleted,
    }
}

/// The failure if the writer of recordings cannot write to a file. The text of the writer's error says only that
/// writing failed. So the failure contains the error of the operating system that is the cause of the writer's error.
fn unwritten(path: &Path, error: &(dyn Error + 'static)) -> Failure {
    match successors(Some(error), |&error| error.source()).find_map(|error| error.downcast_ref::<io::Error>()) {
        Some(of_system) => unwritable(path, of_system),
        None => {
            format!("cannot write {}: {error}. This is a defect of sun2xp: please report it", ShownPath(path)).into()
        }
    }
}

/// The message about a file that cannot be deleted.
fn undeleted(path: &Path, error: &io::Error) -> String {
    let later = "The file stays for now: each time sun2xp record begins a new file, it tries again to delete this one";
    format!("cannot delete {}: {error}{}. {later}", ShownPath(path), write_remedy(error))
}

fn uncreated(path: &Path, error: &io::Error) -> Failure {
    let remedy = write_remedy(error);
    let or = if remedy.is_empty() { ":" } else { ", or" };
    format!("cannot create {}: {error}{remedy}{or} name another file with --output", ShownPath(path)).into()
}

/// Returns the name of a further file: `hand.mcap` becomes `hand-2.mcap`.
fn numbered(first: &Path, number: u32) -> PathBuf {
    let stem = first.file_stem().unwrap_or_default().to_string_lossy();
    let extension = first.extension().map(|extension| format!(".{}", extension.to_string_lossy()));
    first.with_file_name(format!("{stem}-{number}{}", extension.unwrap_or_default()))
}

/// Returns date and time for a name, in universal time: 20261122-154900.
fn date_and_time() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    utc(seconds).replace(['-', ':', 'Z'], "").replace('T', "-")
}

#[cfg(test)]
mod tests;

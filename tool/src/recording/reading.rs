//! Reading a recording: an MCAP file that `sun2xp record` has written, complete or not, or a black box.

use super::altered::{named, or_by, unusable};
use super::black_box;
use super::channels::{DESCRIPTION, EVENTS, FORMAT, LOST, OBJECT, POSTCARD, STATUS, VERSION};
use super::entry::{Entry, Item};
use crate::failure::{Failure, unreadable};
use mcap::records::{Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use sun2xp::files::open_regular_file;
use sun2xp::finger::ALTERED;
use sun2xp::model::{FingerNumber, ShownPath};
use sun2xp::telemetry::{Description, Message};

/// Largest record that is read, bytes. A chunk has little more than 4 MB before compression.
const LARGEST_RECORD: usize = 64 << 20;

/// Largest number of channels. A recording has 11.
const MOST_CHANNELS: usize = 1000;

/// An open recording. It is an iterator over the entries, in the order in which they were recorded. The cycles of one
/// finger are in chronological order. Reading an MCAP file takes little memory, however long the file is.
pub struct Recording {
    path: PathBuf,
    source: Source,
    description: Description,
    complete: bool,
    ended: bool,
}

/// Where the entries come from.
enum Source {
    Mcap(Box<Mcap>),
    BlackBox(std::vec::IntoIter<Entry>),
}

struct Mcap {
    file: File,
    reader: LinearReader,
    content: Content,
    /// Size of the file, and number of bytes that have been read.
    bytes: (u64, u64),
}

/// What the records up to now contain.
#[derive(Default)]
struct Content {
    /// Topic and encoding of each channel.
    channels: BTreeMap<u16, (String, String)>,
    /// Number of messages.
    messages: u64,
}

/// A record that this program reads.
#[expect(
    clippy::large_enum_variant,
    reason = "most values are of the large variant, and a box would cost an allocation for each"
)]
enum Found {
    Description(Box<Description>),
    Format { version: String, library: String },
    Entry(Entry),
    End,
}

impl Recording {
    /// Opens a file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or if it is neither a recording nor a black box.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let failed = |error: io::Error| unreadable(path, &error);
        if black_box::is_one(path).map_err(failed)? {
            let (description, entries) = black_box::read(path)?;
            return Ok(Self::new(path, Source::BlackBox(entries.into_iter()), description));
        }
        let file = open_regular_file(path, u64::MAX).map_err(failed)?.into_inner();
        let bytes = (file.metadata().map_err(failed)?.len(), 0);
        let options =
            LinearReaderOptions::default().with_prevalidate_chunk_crcs(true).with_record_length_limit(LARGEST_RECORD);
        let reader = LinearReader::new_with_options(options);
        let mut mcap = Mcap { file, reader, content: Content::default(), bytes };
        let foreign = |reason: &str| {
            format!(
                "{} is not a recording of sun2xp: {reason}. Use a file of `sun2xp record` or a black box, and copy it \
                 again if it was damaged",
                ShownPath(path)
            )
        };
        loop {
            let next = mcap.next().map_err(|error| match error.downcast_ref::<io::Error>() {
                Some(error) => unreadable(path, error),
                None => foreign(&error.to_string()).into(),
            });
            match next? {
                Some(Found::Format { version, .. }) if version == VERSION => {}
                Some(Found::Format { version, library }) => {
                    let text = format!(
                        "{} has format version {version}, and this program reads version {VERSION}: use the sun2xp \
                         program of version {library}, which wrote the file",
                        ShownPath(path)
                    );
                    return Err(text.into());
                }
                Some(Found::Description(description)) => {
                    description.configuration.check().map_err(|wrong| {
                        let reason = format!("{}.{}", wrong.section, named(&wrong.unusable));
                        unusable(path, &description.library, &reason)
                    })?;
                    return Ok(Self::new(path, Source::Mcap(Box::new(mcap)), *description));
                }
                Some(Found::Entry(_)) => return Err(foreign("its first message is not a description").into()),
                Some(Found::End) | None => return Err(foreign("it has no description of a hand").into()),
            }
        }
    }

    fn new(path: &Path, source: Source, description: Description) -> Self {
        let complete = matches!(source, Source::BlackBox(_));
        Self { path: path.to_owned(), source, description, complete, ended: false }
    }

    /// Returns the description of the hand.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Returns whether the file is a black box.
    pub fn is_black_box(&self) -> bool {
        matches!(self.source, Source::BlackBox(_))
    }

    /// Returns whether the recorder has finished the file. For an MCAP file, the result is false until the last entry
    /// has been read, and stays false if the recorder was killed. For a black box, the result is always true.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// Returns the fraction of the file that has been read, 0 to 1.
    pub fn progress(&self) -> f64 {
        match &self.source {
            Source::Mcap(mcap) => mcap.bytes.1 as f64 / mcap.bytes.0.max(1) as f64,
            Source::BlackBox(entries) => {
                if entries.len() == 0 {
                    1.0
                } else {
                    0.0
                }
            }
        }
    }
}

impl Iterator for Recording {
    type Item = Result<Entry, Failure>;

    fn next(&mut self) -> Option<Self::Item> {
        let mcap = match &mut self.source {
            _ if self.ended => return None,
            Source::BlackBox(entries) => return entries.next().map(Ok),
            Source::Mcap(mcap) => mcap,
        };
        loop {
            match mcap.next() {
                Ok(Some(Found::Entry(entry))) => return Some(Ok(entry)),
                Ok(Some(Found::Description(_) | Found::Format { .. })) => {}
                Ok(Some(Found::End)) => {
                    (self.complete, self.ended) = (true, true);
                    return None;
                }
                Ok(None) => {
                    self.ended = true;
                    return None;
                }
                Err(error) => {
                    self.ended = true;
                    return Some(Err(interrupted(&self.path, &self.description.library, &error)));
                }
            }
        }
    }
}

/// The failure of a file that cannot be read further.
fn interrupted(path: &Path, library: &str, error: &Failure) -> Failure {
    match error.downcast_ref::<io::Error>() {
        Some(error) => unreadable(path, error),
        None => format!("{}: {error}. {ALTERED}{}", ShownPath(path), or_by(library)).into(),
    }
}

impl Mcap {
    /// Reads the next record that this program uses. Returns none at the end of a file that is not complete.
    fn next(&mut self) -> Result<Option<Found>, Failure> {
        loop {
            let found = match self.reader.next_event() {
                // The file ends between two records, or within one. A complete file does not get here, because the
                // reading ends at its footer.
                None | Some(Err(mcap::McapError::UnexpectedEof)) => return Ok(None),
                Some(Err(error)) => return Err(error.into()),
                Some(Ok(LinearReadEvent::ReadRequest(count))) => {
                    let count = count.min(LARGEST_RECORD);
                    let read = self.file.read(self.reader.insert(count))?;
                    self.reader.notify_read(read);
                    self.bytes.1 += read as u64;
                    continue;
                }
                Some(Ok(LinearReadEvent::Record { data, opcode })) => self.content.interpret(opcode, data)?,
            };
            if let Some(found) = found {
                return Ok(Some(found));
            }
        }
    }
}

impl Content {
    /// Returns what a record contains; none if this program does not use it.
    fn interpret(&mut self, opcode: u8, data: &[u8]) -> Result<Option<Found>, Failure> {
        if opcode == op::FOOTER {
            return Ok(Some(Found::End));
        }
        if !matches!(opcode, op::CHANNEL | op::MESSAGE | op::METADATA | op::STATISTICS) {
            return Ok(None);
        }
        Ok(match mcap::parse_record(opcode, data)? {
            Record::Channel(channel) if self.channels.len() < MOST_CHANNELS => {
                self.channels.insert(channel.id, (channel.topic, channel.message_encoding));
                None
            }
            Record::Metadata(metadata) if metadata.name == FORMAT => {
                let value = |key| metadata.metadata.get(key).cloned().unwrap_or_default();
                Some(Found::Format { version: value("version"), library: value("library") })
            }
            Record::Message { header, data } => {
                self.messages += 1;
                match self.channels.get(&header.channel_id) {
                    Some((topic, encoding)) => message(topic, encoding, header.log_time, &data)?,
                    None => return Err("a message belongs to no channel".into()),
                }
            }
            // If the opcode of a chunk was altered, the chunk is skipped as an unknown record, and its messages are
            // missing.
            Record::Statistics(written) if written.message_count != self.messages => {
                let (read, written) = (self.messages, written.message_count);
                return Err(format!("{read} messages were read, and {written} were written").into());
            }
            _ => None,
        })
    }
}

/// Cycles that were lost.
#[derive(Deserialize)]
struct Lost {
    finger: FingerNumber,
    cycles: u64,
}

fn message(topic: &str, encoding: &str, time: u64, data: &[u8]) -> Result<Option<Found>, Failure> {
    let wrong = |error: serde_json::Error| format!("a message of {topic} cannot be read: {error}");
    let item = match (topic, encoding) {
        (DESCRIPTION, _) => return Ok(Some(Found::Description(serde_json::from_slice(data).map_err(wrong)?))),
        (EVENTS, _) => Item::Message(Message::Event(serde_json::from_slice(data).map_err(wrong)?)),
        (OBJECT, _) => Item::Message(Message::Object(serde_json::from_slice(data).map_err(wrong)?)),
        (STATUS, _) => Item::Message(Message::Status(serde_json::from_slice(data).map_err(wrong)?)),
        (LOST, _) => {
            let Lost { finger, cycles } = serde_json::from_slice(data).map_err(wrong)?;
            Item::Lost { finger, cycles }
        }
        (_, POSTCARD) => {
            let message =
                Message::decode(data).map_err(|error| format!("a message of {topic} cannot be read: {error}"))?;
            if let Message::Controller { source, .. } = &message {
                source.finger.check().map_err(|wrong| {
                    format!("{topic} describes a controller that cannot be used: {}", named(&wrong))
                })?;
            }
            Item::Message(message)
        }
        _ => return Ok(None),
    };
    Ok(Some(Found::Entry(Entry { time, item })))
}

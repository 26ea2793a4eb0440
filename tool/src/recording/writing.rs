//! Writing a recording.

use super::cdr;
use super::channels::{self, DESCRIPTION, EVENTS, FORMAT, LOST, OBJECT, POSTCARD, STATUS, VERSION};
use crate::failure::Failure;
use mcap::records::{MessageHeader, Metadata};
use mcap::write::{WriteOptions, Writer};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{Seek, Write};
use std::time::{Duration, Instant};
use sun2xp::model::FingerNumber;
use sun2xp::telemetry::{Description, Message, Status, View};

/// Longest time for which messages are collected before they are written as a chunk. This time and the time that a
/// batch of telemetry covers are together less than a second, so a crash of the recorder loses less than a second.
const CHUNK_TIME: Duration = Duration::from_millis(500);

/// Largest size of a chunk before compression, bytes. A chunk that reaches it is written earlier: three fingers at 5000
/// Hz write 8 MB in [`CHUNK_TIME`].
const CHUNK_BYTES: u64 = 4 << 20;

/// Level of the compression. This level halves the size of a recording, and takes 5 % of a core for three fingers at
/// 1000 Hz.
const COMPRESSION: u32 = 1;

/// Writes messages into an MCAP file.
pub struct RecordingWriter<W: Write + Seek> {
    writer: Writer<W>,
    description: Description,
    view: View,
    channels: BTreeMap<String, Channel>,
    samples: [Option<Channel>; 3],
    replay: [Option<Channel>; 3],
    bytes: Vec<u8>,
    /// Time of the newest cycle or of the beginning, ns of the monotonic clock.
    time: u64,
    flushed: Instant,
}

/// A channel, with the number of its messages.
#[derive(Clone, Copy)]
struct Channel {
    id: u16,
    messages: u32,
}

/// An event with the name of its kind, for people.
#[derive(Serialize)]
struct NamedEvent<'a> {
    name: &'static str,
    #[serde(flatten)]
    event: &'a sun2xp::events::Event,
}

/// Cycles that were lost.
#[derive(Serialize)]
struct Lost {
    finger: FingerNumber,
    cycles: u64,
}

impl<W: Write + Seek> RecordingWriter<W> {
    /// Begins a recording of the hand with this description. Events and statuses have times of their own. Other
    /// messages before the first cycle get the time `begin`, ns of the monotonic clock.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn new(output: W, description: &Description, begin: u64) -> Result<Self, Failure> {
        let mut writer = WriteOptions::new()
            .profile("ros2")
            .library(concat!("sun2xp ", env!("CARGO_PKG_VERSION")))
            .chunk_size(Some(CHUNK_BYTES))
            // Without seeking, the writer writes each chunk as a whole. Even a recording that is cut off has complete
            // chunks.
            .disable_seeking(true)
            .compression_level(COMPRESSION)
            .compression_threads(0)
            .create(output)?;
        let of_format = [("version", VERSION), ("library", &description.library)];
        let metadata = of_format.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        writer.write_metadata(&Metadata { name: FORMAT.into(), metadata })?;
        let mut recording = Self {
            writer,
            description: description.clone(),
            view: View::new(&description.configuration),
            channels: BTreeMap::new(),
            samples: [None; 3],
            replay: [None; 3],
            bytes: Vec::new(),
            time: begin,
            flushed: Instant::now(),
        };
        recording.write_json(DESCRIPTION, recording.time, description)?;
        recording.flush()?;
        Ok(recording)
    }

    /// Writes a message.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write(&mut self, message: &Message) -> Result<(), Failure> {
        match message {
            Message::Controller { finger, source, .. } => {
                self.view.note_controller(*finger, source);
                self.write_replay(*finger, message)
            }
            Message::Keyframe { finger, .. } => self.write_replay(*finger, message),
            Message::Cycle { finger, record } => {
                self.time = record.began;
                let sample = self.view.sample(*finger, record);
                let mut bytes = std::mem::take(&mut self.bytes);
                cdr::encode(&sample, &mut bytes);
                let channel = self.sample_channel(*finger)?;
                let written = self.put(channel, &bytes);
                self.samples[finger.index()] = Some(written?);
                self.bytes = bytes;
                self.write_replay(*finger, message)
            }
            Message::Event(event) => {
                let named = NamedEvent { name: event.kind.description().name, event };
                self.write_json(EVENTS, event.time, &named)
            }
            Message::Object(object) => self.write_json(OBJECT, self.time, object),
            // The status is written without its last cycle, because that cycle is in the finger's own channels.
            Message::Status(status) => {
                let status = Status { last: None, ..(**status).clone() };
                self.write_json(STATUS, status.time, &status)
            }
        }
    }

    /// Returns the time of the newest cycle or of the beginning, ns of the monotonic clock.
    pub fn time(&self) -> u64 {
        self.time
    }

    /// Marks cycles that were lost before the messages that follow.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn write_lost(&mut self, finger: FingerNumber, cycles: u64) -> Result<(), Failure> {
        self.write_json(LOST, self.time, &Lost { finger, cycles })
    }

    /// Writes the messages up to now as a chunk, if the last chunk is half a second old.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn flush_if_due(&mut self) -> Result<(), Failure> {
        if self.flushed.elapsed() >= CHUNK_TIME { self.flush() } else { Ok(()) }
    }

    /// Ends the recording, and returns the file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn finish(mut self) -> Result<W, Failure> {
        self.writer.finish()?;
        Ok(self.writer.into_inner())
    }

    fn flush(&mut self) -> Result<(), Failure> {
        self.flushed = Instant::now();
        Ok(self.writer.flush()?)
    }

    fn sample_channel(&mut self, finger: FingerNumber) -> Result<Channel, Failure> {
        if let Some(channel) = self.samples[finger.index()] {
            return Ok(channel);
        }
        let schema = self.writer.add_schema(cdr::SCHEMA_NAME, "ros2msg", cdr::SCHEMA.as_bytes())?;
        let id = self.writer.add_channel(schema, &channels::samples(finger), "cdr", &BTreeMap::new())?;
        Ok(Channel { id, messages: 0 })
    }

    fn write_replay(&mut self, finger: FingerNumber, message: &Message) -> Result<(), Failure> {
        let channel = match self.replay[finger.index()] {
            Some(channel) => channel,
            None => {
                let id = self.writer.add_channel(0, &channels::replay(finger), POSTCARD, &BTreeMap::new())?;
                Channel { id, messages: 0 }
            }
        };
        let channel = self.put(channel, &message.encode()?)?;
        self.replay[finger.index()] = Some(channel);
        Ok(())
    }

    fn write_json(&mut self, topic: &str, time: u64, value: &impl Serialize) -> Result<(), Failure> {
        let channel = match self.channels.get(topic) {
            Some(&channel) => channel,
            None => {
                let (name, schema) = channels::json_schema(topic);
                let schema = self.writer.add_schema(name, "jsonschema", schema.as_bytes())?;
                Channel { id: self.writer.add_channel(schema, topic, "json", &BTreeMap::new())?, messages: 0 }
            }
        };
        let channel = self.put_at(channel, time, &serde_json::to_vec(value)?)?;
        self.channels.insert(topic.into(), channel);
        Ok(())
    }

    /// Writes a message at the time of the newest cycle. Returns the channel, whose number of messages has increased.
    fn put(&mut self, channel: Channel, data: &[u8]) -> Result<Channel, Failure> {
        self.put_at(channel, self.time, data)
    }

    fn put_at(&mut self, channel: Channel, time: u64, data: &[u8]) -> Result<Channel, Failure> {
        let time = time.saturating_add_signed(self.description.clock_offset);
        let (channel_id, sequence) = (channel.id, channel.messages);
        let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, data)?;
        Ok(Channel { messages: channel.messages.wrapping_add(1), ..channel })
    }
}

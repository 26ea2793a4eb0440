//! The hand's end of telemetry: readers attach to it, and it writes the messages.

use super::batch::Batch;
use super::block_ring::{BlockWriter, CONTROL_WORDS};
use super::handshake::Reply;
use super::memory_file::{self, Mapping};
use super::message::{Description, Outgoing};
use super::names::listen;
use super::readers::{Readers, refuse};
use crate::board::descriptor::Descriptor;
use crate::finger::{Outlet, Stage};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, FINGERS};
use crate::realtime::{boot_time, clock_offset, seconds_since_1970, with_remedy};
use std::io;

/// Length of the ring, s. A reader that sleeps for a shorter time loses nothing.
const HELD: f64 = 2.0;

/// Bytes of a cycle with its share of the other messages, rounded up.
const BYTES_OF_CYCLE: f64 = 1000.0;

/// Publishes the messages of a hand. It is used by one ordinary thread.
pub struct Publisher {
    description: Description,
    /// When the hand was opened, ns of [`boot_time`].
    opened: u64,
    readers: Readers,
    /// The ring; none while there is no reader.
    ring: Option<Ring>,
    /// For each finger, the last cycle that was published.
    last: [Option<LastCycle>; FINGERS],
}

struct Ring {
    file: Descriptor,
    writer: BlockWriter<Mapping>,
    batch: Batch,
}

/// A cycle that was published.
#[derive(Clone, Copy)]
struct LastCycle {
    number: u64,
    /// Whether no cycle is recorded after this one until the finger is opened again or recovered.
    ends: bool,
}

/// What [`Publisher::serve`] has found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Serving {
    /// There is no reader, so nothing needs to be published.
    Nobody,
    /// There are readers.
    Readers {
        /// Whether a reader is new. A new reader needs all messages about controllers again.
        new: bool,
    },
}

impl Publisher {
    /// Makes a hand known under its configured name or, if another hand has that name, under that name followed by a
    /// number. `fingers` are the open fingers.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn open(configuration: Configuration, fingers: Vec<FingerNumber>) -> io::Result<Self> {
        let (listener, name) = listen(&configuration.telemetry.name)?;
        let description = Description {
            name,
            process: std::process::id(),
            library: env!("CARGO_PKG_VERSION").into(),
            started: 0,
            clock_offset: 0,
            fingers,
            configuration,
        };
        let readers = Readers::new(listener);
        Ok(Self { description, opened: boot_time(), readers, ring: None, last: [None; FINGERS] })
    }

    /// The name of the hand.
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// Accepts readers and drops those that have left. `prepare` is called before the first reader is attached. If it
    /// fails, or if the memory cannot be created, the readers are refused.
    pub fn serve(&mut self, prepare: impl FnOnce() -> io::Result<()>) -> Serving {
        let requests = self.readers.serve();
        if !requests.is_empty() && self.ring.is_none() {
            match prepare().and_then(|()| self.create_ring()) {
                Ok(ring) => self.ring = Some(ring),
                Err(error) => {
                    let reason =
                        format!("the process of the hand cannot provide the shared memory: {}", with_remedy(&error));
                    requests.iter().for_each(|socket| refuse(socket, &reason));
                    return Serving::Nobody;
                }
            }
        }
        let new = !requests.is_empty();
        if new {
            self.description.clock_offset = clock_offset();
            self.description.started = seconds_since_1970(self.opened);
        }
        if let Some(ring) = &self.ring {
            for socket in requests {
                let reply = Reply::Attached {
                    description: Box::new(self.description.clone()),
                    words: ring.writer.memory().as_ref().len() as u64,
                    position: ring.writer.position(),
                };
                self.readers.attach(socket, &reply, &ring.file);
            }
        }
        match self.readers.attached() {
            0 => {
                self.ring = None;
                self.last = [None; FINGERS];
                Serving::Nobody
            }
            _ => Serving::Readers { new },
        }
    }

    fn create_ring(&self) -> io::Result<Ring> {
        let fingers = self.description.fingers.len() as f64;
        let bytes = HELD * self.description.configuration.hand.rate * fingers * BYTES_OF_CYCLE;
        let words = CONTROL_WORDS + (bytes as usize / size_of::<u64>()).next_power_of_two();
        let (file, mapping) = memory_file::create(words)?;
        Ok(Ring { file, writer: BlockWriter::new(mapping), batch: Batch::new() })
    }

    /// Publishes a message.
    pub fn publish(&mut self, message: &Outgoing) {
        if let Some(ring) = &mut self.ring {
            ring.batch.add(message, &mut ring.writer);
        }
    }

    /// Publishes the records and keyframes of a finger, in the order of the cycles, and empties `outlet`.
    pub fn publish_cycles(&mut self, finger: FingerNumber, outlet: &mut Outlet) {
        let mut keyframes = outlet.keyframes.iter().peekable();
        for record in &outlet.records {
            while let Some(keyframe) = keyframes.next_if(|keyframe| keyframe.cycle <= record.cycle) {
                self.publish(&Outgoing::Keyframe { finger, cycle: keyframe.cycle, state: &keyframe.state });
            }
            let missing = self.missing_before(finger, record.cycle);
            let ends = matches!(record.stage, Stage::Faulted(_) | Stage::Closed);
            self.last[finger.index()] = Some(LastCycle { number: record.cycle, ends });
            if let Some(ring) = &mut self.ring {
                if missing > 0 {
                    // A reader knows lost cycles only from the counts at the beginning of a block. So a block ends
                    // before the lost cycles, and the next one begins after them.
                    ring.batch.write(&mut ring.writer);
                    ring.batch.count(finger.index(), missing);
                    ring.batch.write(&mut ring.writer);
                }
                ring.batch.count(finger.index(), 1);
                ring.batch.add(&Outgoing::Cycle { finger, record }, &mut ring.writer);
            }
        }
        // A servo writes a keyframe before the record of its cycle. That record comes with the next call.
        for keyframe in keyframes {
            self.publish(&Outgoing::Keyframe { finger, cycle: keyframe.cycle, state: &keyframe.state });
        }
        outlet.clear();
    }

    /// Returns the number of cycles of a finger that were lost before this one.
    fn missing_before(&self, finger: FingerNumber, cycle: u64) -> u64 {
        match self.last[finger.index()] {
            Some(last) if !last.ends => cycle.saturating_sub(last.number + 1),
            _ => 0,
        }
    }

    /// Ends a batch, and wakes the readers.
    pub fn end_batch(&mut self) {
        if let Some(ring) = &mut self.ring {
            ring.batch.write(&mut ring.writer);
            self.readers.wake();
        }
    }
}

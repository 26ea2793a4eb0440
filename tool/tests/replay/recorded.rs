//! A recorded run of a simulated hand, and files with its messages.

use crate::rig::{RATE, cycles, eventful, own_board, turn, wait_until};
use mcap::records::{MessageHeader, Metadata};
use mcap::{WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;
use sun2xp::board::protocol::Status;
use sun2xp::model::configuration::Scheme;
use sun2xp::telemetry::{self, Description, Message, Reader};
use tempfile::NamedTempFile;

/// Size of a chunk of a file, bytes. A chunk holds less than one second of messages.
const CHUNK: u64 = 1 << 16;

/// The messages of a run.
pub struct Recorded {
    pub messages: Vec<Message>,
    description: Description,
}

/// The messages of a run with set points, stiffnesses, adjustments, lost replies, a fault and a recovery of finger 2.
pub fn recorded() -> &'static Recorded {
    static RECORDED: OnceLock<Recorded> = OnceLock::new();
    RECORDED.get_or_init(|| {
        let _turn = turn();
        let (board, hand) = own_board(Scheme::StateFeedback, None);
        let (stop, stopped) = channel::<()>();
        let reading = thread::spawn(move || {
            let mut reader = reader_of_this_process();
            let mut messages = Vec::new();
            while stopped.try_recv().is_err() {
                let received = reader.read(Duration::from_millis(100), &mut messages);
                received.unwrap_or_else(|ended| panic!("{ended}"));
            }
            assert_eq!(reader.lost(), [0; 3]);
            (messages, reader.description().clone())
        });
        // The reader attaches during these cycles.
        cycles(&hand, (0.5 * RATE) as u64);
        eventful(&board, &hand);
        board.with_finger(2, |finger| finger.set_faults(Status::EMERGENCY_STOP)).expect("finger 2");
        wait_until("faulted", || hand.position(2).is_err());
        cycles(&hand, 50);
        board.with_finger(2, |finger| finger.set_faults(Status::default())).expect("finger 2");
        hand.recover(2).expect("recovered");
        hand.send_position(2, [0.0, 0.6, 1.1]).expect("sent");
        cycles(&hand, 150);
        stop.send(()).expect("the reader runs");
        let (messages, description) = reading.join().expect("the messages");
        Recorded { messages, description }
    })
}

/// Attaches to the hand of this process. Other test programs may have open hands too.
fn reader_of_this_process() -> Reader {
    let names = telemetry::hands().expect("names");
    let mut readers = names.iter().filter_map(|name| Reader::attach(Some(name)).ok());
    readers.find(|reader| reader.description().process == std::process::id()).expect("a hand")
}

impl Recorded {
    /// Writes a recording that contains only the description and the messages for replay.
    pub fn write(&self, messages: &[Message]) -> NamedTempFile {
        let file = NamedTempFile::with_suffix(".mcap").expect("a file");
        let output = BufWriter::new(File::create(file.path()).expect("created"));
        let options = WriteOptions::new().disable_seeking(true).chunk_size(Some(CHUNK)).library("sun2xp test");
        let mut writer = Writer::with_options(output, options).expect("written");
        let metadata = [("version", "1"), ("library", &self.description.library)];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value.to_owned())).into();
        writer.write_metadata(&Metadata { name: "sun2xp".into(), metadata }).expect("written");
        let mut channels: BTreeMap<String, u16> = BTreeMap::new();
        let mut write = |topic: String, encoding: &str, sequence: usize, data: &[u8]| {
            let add = || writer.add_channel(0, &topic, encoding, &BTreeMap::new()).expect("written");
            let channel_id = *channels.entry(topic.clone()).or_insert_with(add);
            let (sequence, time) = (sequence as u32, sequence as u64);
            let header = MessageHeader { channel_id, sequence, log_time: time, publish_time: time };
            writer.write_to_known_channel(&header, data).expect("written");
        };
        write("/description".into(), "json", 0, &serde_json::to_vec(&self.description).expect("text"));
        for (sequence, message) in messages.iter().enumerate() {
            let finger = match message {
                Message::Controller { finger, .. } => finger,
                Message::Keyframe { finger, .. } => finger,
                Message::Cycle { finger, .. } => finger,
                _ => continue,
            };
            write(format!("/finger{finger}/replay"), "postcard", sequence, &message.encode().expect("encoded"));
        }
        writer.finish().expect("written");
        file
    }
}

//! What an MCAP file contains, as the crate mcap reads it.

use std::collections::BTreeMap;
use sun2xp::model::FingerNumber;
use sun2xp::telemetry::{Description, Message, Sample, View};

/// The contents of a recording.
#[derive(Default)]
pub struct Contents {
    /// Number of messages on each channel.
    pub topics: BTreeMap<String, usize>,
    /// The channel of the first message.
    pub first_topic: String,
    /// For each finger, the cycle numbers of the messages on its channel `/finger<number>/cycle`.
    pub cycles: [Vec<u64>; 3],
    /// For each finger, the number of cycles on the channel for replay.
    pub replayed: [usize; 3],
    /// For each finger, the number of cycles that are marked as lost.
    pub lost: [u64; 3],
    /// For each finger, its last sample, computed from the channel for replay.
    pub last: [Option<Sample>; 3],
    /// Whether the file is complete: it ends with the magic bytes of MCAP.
    pub finished: bool,
}

/// Reads a file that may be incomplete.
pub fn contents(file: &[u8]) -> Contents {
    let mut contents = Contents { finished: file.ends_with(mcap::MAGIC), ..Default::default() };
    let mut view = None;
    let options = mcap::read::Options::IgnoreEndMagic;
    let stream = mcap::MessageStream::new_with_options(file, options.into()).expect("an MCAP file");
    for message in stream {
        let message = match message {
            Ok(message) => message,
            Err(error) if !contents.finished => {
                assert!(matches!(error, mcap::McapError::UnexpectedEof | mcap::McapError::UnexpectedEoc), "{error}");
                break;
            }
            Err(error) => panic!("{error}"),
        };
        let topic = message.channel.topic.clone();
        if contents.topics.is_empty() {
            contents.first_topic = topic.clone();
            let description: Description = serde_json::from_slice(&message.data).expect("a description");
            view = Some(View::new(&description.configuration));
        }
        *contents.topics.entry(topic.clone()).or_default() += 1;
        let has_schema = message.channel.schema.is_some();
        assert!(has_schema || topic.ends_with("/replay"), "{topic} has no schema");
        match topic.as_str() {
            "/lost" => {
                let lost: serde_json::Value = serde_json::from_slice(&message.data).expect("JSON");
                let finger = lost["finger"].as_u64().expect("a number") as usize - 1;
                contents.lost[finger] += lost["cycles"].as_u64().expect("a number");
            }
            _ if topic.ends_with("/cycle") => {
                let number = u64::from_le_bytes(message.data[4..12].try_into().expect("eight bytes"));
                contents.cycles[finger_of(&topic)].push(number);
            }
            _ if topic.ends_with("/replay") => {
                let replay = Message::decode(&message.data).expect("a message");
                let sample = view.as_mut().expect("the description comes first").take(&replay);
                if let Some(sample) = sample {
                    contents.replayed[finger_of(&topic)] += 1;
                    let place = sample.finger.index();
                    contents.last[place] = Some(sample);
                }
            }
            _ => {}
        }
    }
    contents
}

/// The place of the finger that a channel belongs to.
fn finger_of(topic: &str) -> usize {
    let of = |finger: &FingerNumber| topic.starts_with(&format!("/finger{finger}/"));
    FingerNumber::ALL.iter().find(|finger| of(finger)).expect("a finger's channel").index()
}

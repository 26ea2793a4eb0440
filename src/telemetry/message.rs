//! The messages that a hand publishes. They are encoded with postcard in the memory that the hand shares with readers.

use crate::control::State;
use crate::finger::events::Event;
use crate::finger::{ControllerSource, CycleRecord, Fault, Losses, Stage};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, ConfiguredHand};
use crate::model::snapshot;
use crate::realtime::Distribution;
use crate::simulated::ObjectState;
use serde::{Deserialize, Serialize};
use std::io;

/// A message of a hand.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[expect(clippy::large_enum_variant, reason = "almost all messages are cycles, and a box for each would cost time")]
pub enum Message {
    /// A controller. It comes before the first cycle that names it, and again for each new reader.
    Controller {
        /// The finger.
        finger: FingerNumber,
        /// The data from which the controller is constructed.
        source: Box<ControllerSource>,
        /// The hand's configuration, with the rate.
        hand: Box<ConfiguredHand>,
    },
    /// The state of the controller before a cycle, eight times a second. A replay can begin here.
    Keyframe {
        /// The finger.
        finger: FingerNumber,
        /// Number of the cycle.
        cycle: u64,
        /// The state before that cycle.
        state: Box<State>,
    },
    /// A cycle. The cycles of a finger arrive in their order.
    Cycle {
        /// The finger.
        finger: FingerNumber,
        /// The cycle, as in the black box.
        record: CycleRecord,
    },
    /// An event, as planners get it.
    Event(Event),
    /// The object of a simulated hand, once in each batch of messages that the hand publishes.
    Object(ObjectState),
    /// The status of a finger, once a second, and at once for a new reader.
    Status(Box<Status>),
}

impl Message {
    /// Encodes the message in the format of the shared memory. This format keeps every bit of every number.
    ///
    /// # Errors
    /// Returns an error if the message cannot be encoded. Every message of this library can be encoded.
    pub fn encode(&self) -> io::Result<Vec<u8>> {
        postcard::to_stdvec(self).map_err(io::Error::other)
    }

    /// Decodes the message that `bytes` contain.
    ///
    /// # Errors
    /// Returns an error if `bytes` are not exactly one message.
    pub fn decode(bytes: &[u8]) -> io::Result<Self> {
        match postcard::take_from_bytes(bytes) {
            Ok((message, [])) => Ok(message),
            Ok(_) => Err(io::Error::new(io::ErrorKind::InvalidData, "bytes follow the message")),
            Err(error) => Err(io::Error::new(io::ErrorKind::InvalidData, error)),
        }
    }
}

/// The status of a finger.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Status {
    /// The finger.
    pub finger: FingerNumber,
    /// Time of the status, ns of the monotonic clock.
    pub time: u64,
    /// Stage of the finger.
    pub stage: Stage,
    /// Numbers of cycles and of their errors since open.
    pub losses: Losses,
    /// Time from the scheduled beginning of a cycle to its first instruction, microseconds, since open or the last
    /// reset.
    pub wake_up: Distribution,
    /// Time from the scheduled beginning of a cycle to the end of its computation, microseconds, since open or the last
    /// reset.
    pub whole: Distribution,
    /// The newest warning, if it was noted within the last second.
    pub warning: Option<Fault>,
    /// Number of warnings since open. A warning that persists counts once.
    pub warnings: u64,
    /// Number of recoveries from a fault.
    pub recoveries: u32,
    /// The last cycle. A finger that is faulted has no newer ones.
    pub last: Option<CycleRecord>,
}

/// The messages of [`Message`] with borrowed contents. The variants have the order of [`Message`], because postcard
/// writes their indices.
#[derive(Clone, Copy, Serialize)]
pub enum Outgoing<'a> {
    /// See [`Message::Controller`].
    Controller {
        /// The finger.
        finger: FingerNumber,
        /// The data from which the controller is constructed.
        source: &'a ControllerSource,
        /// The hand's configuration.
        #[serde(serialize_with = "snapshot::serialize")]
        hand: &'a ConfiguredHand,
    },
    /// See [`Message::Keyframe`].
    Keyframe {
        /// The finger.
        finger: FingerNumber,
        /// Number of the cycle.
        cycle: u64,
        /// The state before that cycle.
        #[serde(serialize_with = "snapshot::serialize")]
        state: &'a State,
    },
    /// See [`Message::Cycle`].
    Cycle {
        /// The finger.
        finger: FingerNumber,
        /// The cycle.
        record: &'a CycleRecord,
    },
    /// See [`Message::Event`].
    Event(&'a Event),
    /// See [`Message::Object`].
    Object(&'a ObjectState),
    /// See [`Message::Status`].
    Status(&'a Status),
}

/// The description of a hand, which a reader gets when it attaches.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Description {
    /// Name of the hand.
    pub name: String,
    /// Number of the hand's process.
    pub process: u32,
    /// Version of the library in the hand's process.
    pub library: String,
    /// Time at which the hand was opened, s since 1970. Like `clock_offset`, this time is computed with the setting
    /// that the system's clock had when the reader attached.
    pub started: u64,
    /// Time since 1970 minus the time of the monotonic clock, ns, when the reader attached. It converts the times of
    /// the messages.
    pub clock_offset: i64,
    /// The fingers that are open.
    pub fingers: Vec<FingerNumber>,
    /// The configuration with which the hand was opened. [`Message::Controller`] has later changes.
    #[serde(serialize_with = "snapshot::serialize")]
    pub configuration: Configuration,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Controller;
    use proptest::prelude::*;

    #[test]
    fn borrowed_messages_are_read_as_owned_ones() {
        let configuration = Configuration::default();
        let (finger, hand) = (FingerNumber::TWO, &configuration.hand);
        let configured = configuration.fingers[1].clone();
        let controller = Controller::new(&configured, hand.rate).expect("a controller");
        let source = ControllerSource { number: 5, gravity: configuration.gravity(finger), finger: configured };
        let state = controller.start(&Default::default());
        let object = ObjectState::default();
        let check = |outgoing: Outgoing, shown: &dyn Fn(&Message) -> bool| {
            let bytes = postcard::to_stdvec(&outgoing).expect("encoded");
            let message = Message::decode(&bytes).expect("decoded");
            assert!(shown(&message), "{message:?}");
            assert_eq!(message.encode().expect("encoded"), bytes);
            assert!(Message::decode(&bytes[..bytes.len() - 1]).is_err());
            assert!(Message::decode(&[&bytes[..], &[0]].concat()).is_err());
        };
        check(Outgoing::Controller { finger, source: &source, hand }, &|message| {
            matches!(message, Message::Controller { source: read, hand: of, .. }
                    if **read == source && **of == *hand)
        });
        check(Outgoing::Keyframe { finger, cycle: 9, state: &state }, &|message| {
            matches!(message, Message::Keyframe { cycle: 9, state: read, .. }
                if format!("{read:?}") == format!("{state:?}"))
        });
        check(Outgoing::Object(&object), &|message| matches!(message, Message::Object(read) if *read == object));
    }

    proptest! {
        #[test]
        fn no_bytes_make_the_decoder_panic(kind in 0_u8..8, bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
            let _ = Message::decode(&[&[kind], &bytes[..]].concat());
        }
    }
}

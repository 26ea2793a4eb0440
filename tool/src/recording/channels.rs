//! The channels of a recording: their names, encodings and schemas.

use sun2xp::model::FingerNumber;

/// Name of the metadata record that makes an MCAP file a recording of this program.
pub const FORMAT: &str = "sun2xp";

/// Version of the format.
pub const VERSION: &str = "1";

/// Channel of the hand's description, the first message of a file.
pub const DESCRIPTION: &str = "/description";

/// Channel of events.
pub const EVENTS: &str = "/events";

/// Channel of the simulated object.
pub const OBJECT: &str = "/object";

/// Channel of the status of the fingers.
pub const STATUS: &str = "/status";

/// Channel of lost cycles.
pub const LOST: &str = "/lost";

/// Encoding of the messages for replay. The reader of a recording takes the cycles from these messages, and not from
/// the samples.
pub const POSTCARD: &str = "postcard";

/// Returns the channel of a finger's samples.
pub fn samples(finger: FingerNumber) -> String {
    format!("/finger{finger}/cycle")
}

/// Returns the channel of a finger's messages for replay.
pub fn replay(finger: FingerNumber) -> String {
    format!("/finger{finger}/replay")
}

/// The JSON schema of a channel, with the name of the schema.
pub fn json_schema(channel: &str) -> (&'static str, &'static str) {
    match channel {
        DESCRIPTION => ("sun2xp.Description", include_str!("schemas/description.json")),
        EVENTS => ("sun2xp.Event", include_str!("schemas/event.json")),
        OBJECT => ("sun2xp.Object", include_str!("schemas/object.json")),
        STATUS => ("sun2xp.Status", include_str!("schemas/status.json")),
        _ => ("sun2xp.Lost", include_str!("schemas/lost.json")),
    }
}

//! A handshake request of another thread. The servo sends the request after its Commands.

use super::asked::Asked;
use crate::board::protocol::{MAX_WIRE, Message};

/// Number of periods in which the answer may arrive. The longest answer ends in the period after its request. The other
/// periods allow for the delay of a USB bridge.
const ANSWER_PERIODS: u8 = 20;

/// The request of the next period, and the time left for the answer to the previous request.
#[derive(Debug)]
pub(super) struct RelayedRequest {
    bytes: [u8; 1 + MAX_WIRE],
    length: usize,
    /// The properties by which the answer is recognised; none if the bytes of the request are no frame.
    asked: Option<Asked>,
    /// Number of periods for which the answer is still awaited.
    periods: u8,
}

impl RelayedRequest {
    pub fn none() -> Self {
        Self { bytes: [0; 1 + MAX_WIRE], length: 0, asked: None, periods: 0 }
    }

    /// Sets the bytes of the request, with delimiters. A request that is too long is ignored.
    pub fn set(&mut self, bytes: &[u8]) {
        if let Some(room) = self.bytes.get_mut(..bytes.len()) {
            room.copy_from_slice(bytes);
            (self.length, self.asked) = (bytes.len(), Asked::on_wire(bytes));
        }
    }

    /// Takes the request for this period. Returns an empty slice if there is none.
    pub fn take(&mut self) -> &[u8] {
        let length = std::mem::take(&mut self.length);
        self.periods = if length > 0 { ANSWER_PERIODS } else { self.periods.saturating_sub(1) };
        &self.bytes[..length]
    }

    /// Whether an answer is awaited.
    pub fn is_awaited(&self) -> bool {
        self.periods > 0
    }

    /// Returns whether this is the awaited answer. Other frames come too, for example the answer to a Stop that the
    /// servo has sent to another finger.
    pub fn is_answered_by(&self, message: &Message) -> bool {
        self.is_awaited() && self.asked.is_some_and(|asked| asked.is_answered_by(message))
    }

    /// Ends the wait, because the answer has arrived.
    pub fn answered(&mut self) {
        self.periods = 0;
    }
}

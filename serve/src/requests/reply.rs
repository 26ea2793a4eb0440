//! The replies to requests, and the Answers to requests that the server cannot begin.

use crate::desk::Desk;
use sun2xp::realtime::now;
use sun2xp_remote_protocol::{Answer, Code};

/// The text of an Answer while the server ends.
const ENDING: &str = "the server of the hand is shutting down, and its fingers go to their end states: start the \
                      server again, and acquire the hand";

/// Where an Answer goes.
pub trait Reply: Send + 'static {
    /// Sends the Answer.
    fn send(self, answer: &Answer);
}

/// Returns the Answer while the server ends.
pub(super) fn ended(desk: &Desk, epoch: u64) -> Answer {
    desk.answer(Code::Closed, ENDING.into(), epoch, now())
}

/// Returns the Answer while another request that takes long is running.
pub(super) fn in_progress(desk: &Desk, epoch: u64) -> Answer {
    let text = "the hand is being recovered or calibrated already: repeat the request when that has ended".into();
    desk.answer(Code::InProgress, text, epoch, now())
}

//! The cyclic traffic of a link: Commands with their Replies, TactileRequests with their answers, and the answers to
//! relayed requests. A relayed request is a handshake request of another thread, which the servo sends after its
//! Commands.

use crate::board::protocol::{Command, Message, Reply, TactileEvent, TactileRequest};

/// A Command for one finger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutgoingCommand {
    /// The finger's address, 1 to 15.
    pub address: u8,
    /// The sequence number. The Reply contains the same number.
    pub sequence: u8,
    /// The command for the motors.
    pub command: Command,
}

/// A Reply that was received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Received {
    /// The address of the finger that sent it.
    pub address: u8,
    /// The sequence number of the Command that it answers.
    pub sequence: u8,
    /// The content of the Reply.
    pub reply: Reply,
}

/// A TactileRequest for one finger.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutgoingRequest {
    /// The finger's address, 1 to 15.
    pub address: u8,
    /// The sequence number. The answer contains the same number.
    pub sequence: u8,
    /// The request.
    pub request: TactileRequest,
}

/// An answer of the cyclic traffic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// The Reply to a Command.
    Reply(Received),
    /// The answer to a TactileRequest.
    Tactile {
        /// The address of the finger that sent it.
        address: u8,
        /// The sequence number of the request that it answers.
        sequence: u8,
        /// The content of the answer.
        event: TactileEvent,
    },
    /// The answer to a relayed request.
    Relayed(Message),
}

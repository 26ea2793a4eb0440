//! The relay: passes the handshake of one finger through the servo that serves the other fingers of the port.
//!
//! The servo sends at most one relayed request in a period, after the Commands, so the boards answer it after the
//! Replies of that period. The finger of the request gets no Command, which leaves room for the answer. The longest
//! answer, Configured, has 38 bytes more than a Reply. The board may still be sending it when the first Command of the
//! next period arrives. The Replies of that next period are then delayed. They still arrive in time, because the
//! recovering finger does not use its part of the period.

use crate::board::protocol::{Decoder, MAX_WIRE, Message, WireFrame};
use crate::board::{PortError, Transport};
use crate::realtime::{Consumer, LockedMemory, Producer, now, ring};
use std::thread::sleep;
use std::time::Duration;

/// Interval at which the repairing thread looks for an answer.
const POLL_INTERVAL: Duration = Duration::from_micros(500);

/// Number of requests and of answers that may wait. A handshake has at most two requests on their way.
const WAITING: usize = 4;

/// The bytes of a request to a board, with delimiters.
#[derive(Clone, Copy)]
pub(super) struct RelayedRequest {
    /// The address of the finger.
    pub address: u8,
    bytes: [u8; 1 + MAX_WIRE],
    length: usize,
}

impl RelayedRequest {
    /// Returns none if the bytes are not a frame.
    fn new(bytes: &[u8]) -> Option<Self> {
        let address = Decoder::default().next(&mut &*bytes)?.address();
        let mut request = Self { address, bytes: [0; 1 + MAX_WIRE], length: bytes.len() };
        request.bytes.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(request)
    }

    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

/// The servo's end of the relay.
pub(super) struct RelayServoEnd {
    pub requests: Consumer<RelayedRequest>,
    pub answers: Producer<Message>,
}

/// The repairing thread's end of the relay, which is a transport for a [`Link`](crate::board::Link).
pub struct Relay {
    requests: Producer<RelayedRequest>,
    answers: Consumer<Message>,
}

/// Returns both ends of a new relay.
pub(super) fn relay() -> (Relay, RelayServoEnd) {
    let (requests, requests_out) = ring(WAITING);
    let (answers, answers_out) = ring(WAITING);
    (Relay { requests, answers: answers_out }, RelayServoEnd { requests: requests_out, answers })
}

impl RelayServoEnd {
    /// Adds to `memory` the pages that both ends share.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        self.requests.add_to(memory);
        self.answers.add_to(memory);
    }
}

impl Transport for Relay {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        // A request that the servo has no room for is lost, like bytes that a port does not accept. The handshake
        // repeats it.
        let sent = RelayedRequest::new(bytes).is_some_and(|request| self.requests.push(request).is_ok());
        Ok(if sent { bytes.len() } else { 0 })
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        loop {
            if let Some(message) = self.answers.pop() {
                let wire = WireFrame::new(&message);
                let length = wire.as_bytes().len().min(buffer.len());
                buffer[..length].copy_from_slice(&wire.as_bytes()[..length]);
                return Ok(length);
            }
            if now() >= deadline {
                return Ok(0);
            }
            sleep(POLL_INTERVAL);
        }
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        while self.answers.pop().is_some() {}
        Ok(())
    }

    fn now(&self) -> u64 {
        now()
    }
}

//! Something other than the simulated board at the far end of the line.

use sun2xp::board::protocol::*;
use sun2xp::board::*;

/// A far end that answers each frame with the result of a function.
pub struct OtherEnd<F> {
    answer: F,
    /// Bytes that the host has not yet read.
    sent: Vec<u8>,
    /// Simulated time, ns.
    now: u64,
}

impl<F: FnMut(Message) -> Vec<u8>> OtherEnd<F> {
    /// The bytes in `sent` wait for the host from the beginning.
    pub fn new(answer: F, sent: Vec<u8>) -> Self {
        Self { answer, sent, now: 0 }
    }
}

impl<F: FnMut(Message) -> Vec<u8>> Transport for OtherEnd<F> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut decoder = Decoder::default();
        let mut rest = bytes;
        while let Some(packet) = decoder.next(&mut rest) {
            let message = Message::read(&packet).expect("the link sends known frames");
            self.sent.extend((self.answer)(message));
        }
        Ok(bytes.len())
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if self.sent.is_empty() {
            self.now = self.now.max(deadline);
        }
        let taken = self.sent.len().min(buffer.len());
        buffer[..taken].copy_from_slice(&self.sent[..taken]);
        self.sent.drain(..taken);
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.sent.clear();
        Ok(())
    }

    fn now(&self) -> u64 {
        self.now
    }
}

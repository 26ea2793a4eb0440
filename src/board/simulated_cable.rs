//! A simulated board on simulated time, in memory: for experiments and tests that need no port and wait for nothing.

use super::port::PortError;
use super::simulated_board::SimulatedBoard;
use super::transport::Transport;
use std::collections::VecDeque;

/// A cable without length and bit rate, and the clock of the world at both its ends.
#[derive(Debug)]
pub struct SimulatedCable {
    board: SimulatedBoard,
    now: u64,
    to_host: VecDeque<u8>,
}

impl SimulatedCable {
    /// With the clock at 0.
    pub fn new(board: SimulatedBoard) -> Self {
        Self { board, now: 0, to_host: VecDeque::new() }
    }

    /// What is at the other end.
    pub fn board(&mut self) -> &mut SimulatedBoard {
        &mut self.board
    }

    /// Lets time pass until `time`, ns.
    pub fn advance_to(&mut self, time: u64) {
        self.now = self.now.max(time);
        self.board.advance(self.now);
    }
}

impl Transport for SimulatedCable {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let to_host = &mut self.to_host;
        self.board.receive(self.now, bytes, &mut |answer| to_host.extend(answer));
        Ok(bytes.len())
    }

    /// Time passes only while there is nothing to read.
    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if self.to_host.is_empty() {
            self.advance_to(deadline);
        }
        let taken = buffer.len().min(self.to_host.len());
        for (place, byte) in buffer.iter_mut().zip(self.to_host.drain(..taken)) {
            *place = byte;
        }
        Ok(taken)
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        self.to_host.clear();
        Ok(())
    }

    fn now(&self) -> u64 {
        self.now
    }
}

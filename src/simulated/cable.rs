//! Connects the host to a simulated board in memory and in simulated time. Experiments and tests with this cable need
//! no port and no waiting.

use crate::board::{PortError, Transport};
use crate::simulated::board::SimulatedBoard;
use crate::simulated::line::{LineFault, SimulatedLine};
use std::collections::VecDeque;

/// A cable that delays nothing, unless a fault is injected. Both ends use the clock of the cable.
#[derive(Debug)]
pub struct SimulatedCable {
    board: SimulatedBoard,
    now: u64,
    /// The direction from the board to the host.
    line: SimulatedLine,
    /// The direction from the host to the board.
    line_to_board: SimulatedLine,
    to_host: VecDeque<u8>,
    plugged: bool,
}

impl SimulatedCable {
    /// Creates a cable with the clock at 0.
    pub fn new(board: SimulatedBoard) -> Self {
        let [line, line_to_board] = [(); 2].map(|()| SimulatedLine::new());
        Self { board, now: 0, line, line_to_board, to_host: VecDeque::new(), plugged: true }
    }

    /// Returns the board at the other end.
    pub fn board(&mut self) -> &mut SimulatedBoard {
        &mut self.board
    }

    /// Applies `fault` to each frame from the board with this probability. The fault ends at the time `until`, ns. A
    /// stall ignores the probability. `seed` restarts the random numbers.
    pub fn inject(&mut self, fault: LineFault, probability: f64, until: u64, seed: u64) {
        self.line.inject(fault, probability, until, seed);
    }

    /// Applies `fault` to each frame on its way to the board. The parameters are those of [`SimulatedCable::inject`].
    pub fn inject_to_board(&mut self, fault: LineFault, probability: f64, until: u64, seed: u64) {
        self.line_to_board.inject(fault, probability, until, seed);
    }

    /// Removes all faults of the line in both directions.
    pub fn clear(&mut self) {
        self.line.clear();
        self.line_to_board.clear();
    }

    /// Unplugs the cable or plugs it in again. While it is unplugged, reads and writes report a vanished port. Bytes on
    /// their way are lost.
    pub fn set_plugged(&mut self, plugged: bool) {
        self.plugged = plugged;
        if !plugged {
            self.line.cut();
            self.line_to_board.cut();
            self.to_host.clear();
        }
    }

    /// Advances the time to `time`, ns.
    pub fn advance_to(&mut self, time: u64) {
        while let Some(arrival) = self.line_to_board.next_arrival().filter(|&arrival| arrival <= time) {
            self.now = self.now.max(arrival);
            let Self { board, now, line, line_to_board, to_host, .. } = self;
            line_to_board.arrive(*now, &mut |bytes| {
                board.receive(*now, bytes, &mut |answer| line.carry(*now, answer, &mut |frame| to_host.extend(frame)));
            });
        }
        self.now = self.now.max(time);
        self.board.advance(self.now);
        let to_host = &mut self.to_host;
        self.line.arrive(self.now, &mut |frame| to_host.extend(frame));
    }
}

impl Transport for SimulatedCable {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        if !self.plugged {
            return Err(PortError::Vanished);
        }
        let Self { board, now, line, line_to_board, to_host, .. } = self;
        line_to_board.carry_bytes(*now, bytes, &mut |bytes| {
            board.receive(*now, bytes, &mut |answer| line.carry(*now, answer, &mut |frame| to_host.extend(frame)));
        });
        Ok(bytes.len())
    }

    /// Time advances only while there is nothing to read.
    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if !self.plugged {
            return Err(PortError::Vanished);
        }
        while self.to_host.is_empty() {
            let arrivals = [self.line.next_arrival(), self.line_to_board.next_arrival()];
            let next = arrivals.into_iter().flatten().fold(deadline, u64::min);
            self.advance_to(next);
            if self.now >= deadline {
                break;
            }
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

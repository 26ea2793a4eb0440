//! A transport without a line: it plays the part of the board in memory, and drives the hardware that the program
//! provides.
//!
//! The link, its counters, the faults, the recovery and the timing figures are therefore the same as with a serial
//! board. A Command is kept until the servo awaits its Reply. The exchange happens then, so its duration counts as the
//! stage *wire* of the cycle. An exchange that fails has no Reply.

use super::finger_io::{FingerIo, IoProperties};
use super::hardware::Hardware;
use crate::board::port_error::PortError;
use crate::board::protocol::{
    Command, Decoder, Frame, Hello, MAX_WIRE, Message, Reason, Refused, Stopped, VERSION, WireFrame,
};
use crate::board::transport::Transport;
use crate::model::FingerNumber;
use crate::model::configuration::Configuration;
use crate::realtime;
use std::fmt;
use std::thread::sleep;
use std::time::Duration;

/// Room for the answers that the host has not read yet. A host awaits at most two.
const ANSWERS: usize = 4 * MAX_WIRE;

/// Number of attempts to stop hardware that nothing else has stopped.
const ATTEMPTS_TO_STOP: usize = 3;

/// The board of a finger whose hardware the program provides.
pub struct IoBoard {
    hardware: Hardware,
    address: u8,
    decoder: Decoder,
    /// The Command that has no exchange yet, and its sequence number.
    pending: Option<(u8, Command)>,
    /// Bytes for the host. The host has read the first `read` of the `written` bytes.
    answers: [u8; ANSWERS],
    written: usize,
    read: usize,
    /// The error of a start or stop that a Configure has requested, until the host reads it.
    failure: Option<PortError>,
    ready_at: u64,
    /// The process that opened the hand. A forked child inherits this value, but the hardware belongs to its parent.
    process: u32,
}

impl fmt::Debug for IoBoard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.debug_struct("IoBoard").field("finger", &self.hardware.finger()).finish_non_exhaustive()
    }
}

impl IoBoard {
    /// Creates the board of a finger, whose hardware has these `properties`. Returns `None` if
    /// `properties.tension_unit` is not a positive number.
    pub fn new(
        configuration: &Configuration,
        finger: FingerNumber,
        io: Box<dyn FingerIo>,
        properties: IoProperties,
    ) -> Option<Self> {
        Some(Self {
            hardware: Hardware::new(configuration, finger, io, properties)?,
            address: configuration.address(finger),
            decoder: Decoder::default(),
            pending: None,
            answers: [0; ANSWERS],
            written: 0,
            read: 0,
            failure: None,
            ready_at: 0,
            process: std::process::id(),
        })
    }

    /// Returns whether the servo waits for the hardware, as [`IoProperties::in_step`] says.
    pub fn in_step(&self) -> bool {
        self.hardware.in_step()
    }

    /// Answers a request, or keeps a Command for its exchange.
    fn take(&mut self, message: &Message) {
        let Message { address, sequence, frame } = *message;
        if address != self.address && !matches!(frame, Frame::Hello(_)) {
            return;
        }
        let answer = match frame {
            Frame::Hello(hello) => self.greet(&hello),
            Frame::Configure(terms) => match self.hardware.configure(&terms) {
                Ok(answer) => answer,
                Err(failure) => {
                    self.failure = Some(failure);
                    return;
                }
            },
            Frame::Command(command) => {
                self.pending = Some((sequence, command));
                return;
            }
            Frame::Stop(_) => {
                self.pending = None;
                if self.hardware.end().is_err() {
                    // The host repeats a Stop that is not confirmed.
                    return;
                }
                Frame::Stopped(Stopped { status: self.hardware.status() })
            }
            // The hardware does not announce tactile elements, and the other frames are answers.
            _ => return,
        };
        self.answer(sequence, answer);
    }

    fn greet(&self, hello: &Hello) -> Frame {
        match (hello.lowest_version..=hello.highest_version).contains(&VERSION) {
            true => Frame::Identity(self.hardware.identity()),
            false => {
                let detail = u16::from_le_bytes([VERSION, VERSION]);
                Frame::Refused(Refused { request: 0x1, reason: Reason::Version, detail })
            }
        }
    }

    /// Adds an answer to those that the host can read. The buffer can be full only if the host does not read.
    fn answer(&mut self, sequence: u8, frame: Frame) {
        let wire = WireFrame::new(&Message { address: self.address, sequence, frame });
        let wire = wire.as_bytes();
        if let Some(room) = self.answers.get_mut(self.written..self.written + wire.len()) {
            room.copy_from_slice(wire);
            self.written += wire.len();
        }
        self.ready_at = realtime::now();
    }
}

impl Transport for IoBoard {
    fn write(&mut self, mut bytes: &[u8]) -> Result<usize, PortError> {
        let length = bytes.len();
        loop {
            let before = bytes.len();
            let message = self.decoder.next(&mut bytes).map(|packet| Message::read(&packet));
            match message {
                Some(Ok(message)) => self.take(&message),
                Some(Err(_)) => {}
                None if bytes.is_empty() || bytes.len() == before => return Ok(length),
                None => {}
            }
        }
    }

    /// Carries out the exchange of a pending Command, and reads answers. The exchange may end after the deadline. If it
    /// fails, the Command has no answer, so the call does not wait for one.
    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        if let Some((sequence, command)) = self.pending.take() {
            match self.hardware.exchange(sequence, &command, deadline) {
                Some(reply) => self.answer(sequence, reply),
                None if self.read == self.written => return Ok(0),
                None => {}
            }
        }
        if self.read == self.written {
            sleep(Duration::from_nanos(deadline.saturating_sub(realtime::now())));
            return Ok(0);
        }
        let taken = buffer.len().min(self.written - self.read);
        buffer[..taken].copy_from_slice(&self.answers[self.read..self.read + taken]);
        self.read += taken;
        if self.read == self.written {
            (self.read, self.written) = (0, 0);
        }
        Ok(taken)
    }

    fn ready_at(&self) -> u64 {
        self.ready_at
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        (self.read, self.written, self.pending, self.failure) = (0, 0, None, None);
        Ok(())
    }

    fn now(&self) -> u64 {
        realtime::now()
    }
}

impl Drop for IoBoard {
    fn drop(&mut self) {
        if self.process == std::process::id() {
            // The servo has already stopped the hardware, unless the hand could not be opened. A stop can fail because
            // one telegram was lost. The stop is therefore repeated, and not left to the watchdog.
            let _ = (0..ATTEMPTS_TO_STOP).any(|_| self.hardware.end().is_ok());
        }
    }
}

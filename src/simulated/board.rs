//! A board without hardware. It answers the board protocol, and computes the physics of its fingers. It has no clock
//! and no thread. [`SimulatedPort`](crate::simulated::SimulatedPort) connects it to a serial port, and
//! [`SimulatedCable`](crate::simulated::SimulatedCable) runs it in simulated time.

use crate::board::protocol::{
    ANY_ADDRESS, Decoder, Frame, HIGHEST_ADDRESS, Kind, Malformed, Message, Packet, Reason, Refused, WireFrame,
};
use crate::model::FingerNumber;
use crate::model::TendonsError;
use crate::model::configuration::Configuration;
use crate::plant::PLANT_STEP_SECONDS;
use crate::simulated::finger::SimulatedFinger;
use crate::simulated::line::DELIMITER;
use crate::simulated::scene::Scene;
use thiserror::Error;

/// Why a simulated board cannot be built.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SimulatedBoardError {
    /// The address is not between 1 and 15, or two fingers have it.
    #[error(
        "finger address {0} is not between 1 and {HIGHEST_ADDRESS}, or two fingers of one port have it, or a finger \
         was given twice: give each finger of the port once, and leave finger.address out or make it different for \
         each finger"
    )]
    Address(u8),
    /// The tendons of a finger are unusable.
    #[error("finger address {address}: {source}")]
    Tendons {
        /// The finger's address.
        address: u8,
        /// What is wrong with the tendons.
        source: TendonsError,
    },
}

/// A board with its fingers. A command takes effect when its last byte arrives, and its reply contains the measurements
/// of that instant.
#[derive(Debug)]
pub struct SimulatedBoard {
    decoder: Decoder,
    /// The fingers in the order of their addresses.
    fingers: Vec<SimulatedFinger>,
    /// The object that the fingers can touch.
    scene: Option<Scene>,
    /// Time up to which the physics has been computed, ns. `None` before the first call that passes a time.
    time: Option<u64>,
}

/// Duration of one step of the physics, ns.
pub(super) const STEP: u64 = (PLANT_STEP_SECONDS * 1e9) as u64;
const _: () = assert!(STEP == 100_000, "the conversion to whole nanoseconds has rounded the step");

impl SimulatedBoard {
    /// Creates a board with these `fingers` of a hand, at their configured addresses. The fingers are braked at their
    /// start poses. Each finger has its own noise. The board has its own object if one is configured.
    pub fn new(hand: &Configuration, fingers: &[FingerNumber]) -> Result<Self, SimulatedBoardError> {
        Ok(Self { scene: Scene::new(hand), ..Self::without_object(hand, fingers)? })
    }

    /// Does the same as [`SimulatedBoard::new`], but the board has no object.
    pub(super) fn without_object(hand: &Configuration, fingers: &[FingerNumber]) -> Result<Self, SimulatedBoardError> {
        let mut board = Self { decoder: Decoder::default(), fingers: Vec::new(), scene: None, time: None };
        for &number in fingers {
            let address = hand.address(number);
            let mut configured = hand.fingers[number.index()].clone();
            configured.simulation.seed = configured.simulation.seed.wrapping_add(number.index() as u64);
            if !(1..=HIGHEST_ADDRESS).contains(&address) || board.finger(address).is_some() {
                return Err(SimulatedBoardError::Address(address));
            }
            let finger = SimulatedFinger::new(number, address, &configured, hand.gravity(number))
                .map_err(|source| SimulatedBoardError::Tendons { address, source })?;
            board.fingers.push(finger);
        }
        board.fingers.sort_by_key(SimulatedFinger::address);
        Ok(board)
    }

    /// Writes `number` into the unique numbers of the board's fingers. A hand can distinguish two boards with the
    /// same finger only if their numbers differ.
    pub fn numbered(mut self, number: u32) -> Self {
        self.fingers.iter_mut().for_each(|finger| finger.set_board_number(number));
        self
    }

    /// Returns the finger at this address.
    pub fn finger(&mut self, address: u8) -> Option<&mut SimulatedFinger> {
        self.fingers.iter_mut().find(|finger| finger.address() == address)
    }

    /// Returns all fingers, in the order of their addresses.
    pub fn fingers(&mut self) -> &mut [SimulatedFinger] {
        &mut self.fingers
    }

    /// Advances the physics to `now`, ns. The first call only sets the time at which the physics begins. A `now` that
    /// the physics has already reached has no effect.
    pub fn advance(&mut self, now: u64) {
        let mut time = *self.time.get_or_insert(now);
        while time + STEP <= now {
            time += STEP;
            self.scene.iter_mut().for_each(|scene| scene.step(self.fingers.iter_mut()));
            self.step(time);
        }
    }

    /// Advances the fingers by one step, which ends at `time`, ns.
    pub(super) fn step(&mut self, time: u64) {
        self.time = Some(time);
        for finger in &mut self.fingers {
            finger.step(time);
        }
    }

    /// Returns the object of this board and the places of the fingers around it, or `None` if the board has no object.
    pub fn scene(&mut self) -> Option<&mut Scene> {
        self.scene.as_mut()
    }

    /// Receives bytes at `now`, ns, and passes each complete answer to `send`.
    pub fn receive(&mut self, now: u64, bytes: &[u8], send: &mut dyn FnMut(&[u8])) {
        self.advance(now);
        // The physics advances in whole steps, so its time may be a fraction of a step behind.
        let now = self.time.unwrap_or(now);
        // The bytes are decoded one frame at a time, because an answer reports whether damaged frames arrived before
        // its request.
        for mut piece in bytes.split_inclusive(|&byte| byte == DELIMITER) {
            let damaged = self.decoder.counters().damaged;
            let answer =
                self.decoder.next(&mut piece).and_then(|packet| answer(&mut self.fingers, now, &packet, damaged));
            answer.iter().for_each(|answer| send(WireFrame::new(answer).as_bytes()));
        }
    }
}

/// Returns the answer to a frame, or `None` if the frame is not a request or not for this board.
fn answer(fingers: &mut [SimulatedFinger], now: u64, packet: &Packet, damaged: u64) -> Option<Message> {
    const ANSWER: u8 = 0x8;
    if packet.kind() & ANSWER != 0 {
        return None;
    }
    let addresses = fingers.iter().fold(0, |addresses, finger| addresses | 1 << finger.address());
    let message = Message::read(packet);
    let greeted_all = packet.address() == ANY_ADDRESS && packet.kind() == Kind::Hello as u8;
    let finger = match greeted_all {
        true => fingers.first_mut(),
        false => fingers.iter_mut().find(|finger| finger.address() == packet.address()),
    }?;
    let refuse = |reason, detail| Frame::Refused(Refused { request: packet.kind(), reason, detail });
    let frame = match message {
        Ok(Message { frame: Frame::Hello(hello), .. }) => finger.greet(&hello, addresses),
        Ok(Message { frame: Frame::Configure(terms), .. }) => finger.configure(&terms),
        Ok(Message { frame: Frame::Command(command), .. }) => finger.command(now, &command, damaged),
        Ok(Message { frame: Frame::Stop(_), .. }) => finger.stop(now),
        Ok(Message { frame: Frame::TactileRequest(request), .. }) => match finger.touched(&request) {
            Some(event) => Frame::TactileEvent(event),
            // A finger without tactile elements does not announce the capability for this request. For such a finger,
            // the request is a frame of an unknown type.
            None => refuse(Reason::UnknownFrame, packet.body().len() as u16),
        },
        // Answers were rejected above.
        Ok(_) => return None,
        Err(Malformed::Value { offset, .. }) => finger.refuses_any_terms().unwrap_or_else(|| {
            // Only the end state of a Configure can have an undefined value. The fields before it may be wrong too.
            let earlier = match packet.body() {
                &[version, low, high, ..] => {
                    SimulatedFinger::wrong_before_end_state(version, u16::from_le_bytes([low, high]))
                }
                _ => None,
            };
            refuse(Reason::Value, earlier.unwrap_or(offset.into()))
        }),
        Err(Malformed::UnknownKind(_) | Malformed::Length { .. }) => {
            refuse(Reason::UnknownFrame, packet.body().len() as u16)
        }
    };
    Some(Message { address: finger.address(), sequence: packet.sequence(), frame })
}

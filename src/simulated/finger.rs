//! One finger of a simulated board. It answers the frames of the protocol, and computes the physics.

mod ending;
mod greeting;
mod identity;
mod present_faults;
mod touching;

use crate::board::protocol::{Command, Configure, Configured, Frame, Reason, Refused, Reply, Status, VERSION};
use crate::model::FingerNumber;
use crate::model::TendonsError;
use crate::model::configuration::ConfiguredFinger;
use crate::plant::{PLANT_STEP_SECONDS, Plant, Sensors};
use crate::simulated::pads::Pads;
use crate::simulated::wiring::Wiring;
use identity::SHORTEST_WATCHDOG_MS;
use nalgebra::{Vector3, Vector4};

const MILLISECOND: u64 = 1_000_000;

/// The states of `docs/board-protocol.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    /// The state after power-up.
    Idle,
    /// Terms are agreed; the motors are off.
    Ready,
    /// The motors follow the Commands.
    Enabled,
    /// The end state has been entered. Only a Configure leaves it.
    Ended {
        /// When *hold* ends, ns. `None`: the motors are off.
        holds_until: Option<u64>,
    },
}

/// One finger of a [`SimulatedBoard`](crate::simulated::SimulatedBoard).
#[derive(Debug)]
pub struct SimulatedFinger {
    number: FingerNumber,
    address: u8,
    unique_number: [u8; 12],
    plant: Plant,
    sensors: Sensors,
    wiring: Wiring,
    pads: Pads,
    /// Velocity of the tip relative to an object that several fingers share, cm/s, in the finger's frame.
    sliding: Vector3<f64>,
    state: State,
    /// Time up to which the physics has been computed, ns.
    clock: u64,
    /// Arrival time of the last Command that the motors followed, ns. `None`: there was none since the last Configure.
    commanded_at: Option<u64>,
    /// When silence or a Stop led to the end state, ns. `None`: not since the last Configure.
    ended_at: Option<u64>,
    terms: Configure,
    /// Torques of the motors, torque units.
    torques: [i16; 4],
    /// Faults that are present now.
    present: Status,
    /// Status bits that stay set until the next Configure.
    latched: Status,
    torque_unit: u32,
    torque_limit: u16,
    counts_per_revolution: u32,
    /// Number of damaged frames on the port at the last Reply of this finger.
    damaged_before: u64,
    zero_valid: bool,
}

impl SimulatedFinger {
    /// `number` is the finger's number in its hand. `gravity` is in the finger's frame, m/s^2.
    pub(super) fn new(
        number: FingerNumber,
        address: u8,
        finger: &ConfiguredFinger,
        gravity: Vector3<f64>,
    ) -> Result<Self, TendonsError> {
        let strongest = finger.motor.torque_limit.into_iter().fold(0.0, f64::max);
        // The finest unit, in whole nN m (1e-7 N cm), in which the strongest motor's limit is at most 30 000 units.
        let torque_unit = (strongest * 1e7 / 30_000.0).ceil().max(1.0);
        let counts = finger.encoder.counts_per_revolution;
        Ok(Self {
            number,
            address,
            unique_number: identity::unique_number(number, address),
            plant: Plant::new(finger, gravity)?,
            sensors: Sensors::new(finger),
            wiring: Wiring::default(),
            pads: Pads::new(&finger.touch),
            sliding: Vector3::zeros(),
            state: State::Idle,
            clock: 0,
            commanded_at: None,
            ended_at: None,
            terms: Configure::default(),
            torques: [0; 4],
            present: Status::default(),
            latched: Status::default(),
            torque_unit: torque_unit as u32,
            torque_limit: (strongest * 1e7 / torque_unit).ceil() as u16,
            counts_per_revolution: if counts.iter().all(|&count| count == counts[0]) { counts[0] } else { 0 },
            damaged_before: 0,
            zero_valid: true,
        })
    }

    /// Returns the finger's number in its hand.
    pub(super) fn number(&self) -> FingerNumber {
        self.number
    }

    /// Returns the finger's address.
    pub fn address(&self) -> u8 {
        self.address
    }

    /// Returns the physics of the finger: its true state, and external forces and obstacles.
    pub fn plant(&mut self) -> &mut Plant {
        &mut self.plant
    }

    /// Returns whether the motors follow Commands.
    pub fn enabled(&self) -> bool {
        self.state == State::Enabled
    }

    /// Returns the board's clock, ns.
    pub fn clock(&self) -> u64 {
        self.clock
    }

    /// Returns the arrival time of the last Command that the motors followed, board time in ns. `None`: there was none
    /// since the last Configure.
    pub fn commanded_at(&self) -> Option<u64> {
        self.commanded_at
    }

    /// Returns when silence or a Stop led to the end state, board time in ns. `None`: not since the last Configure.
    pub fn ended_at(&self) -> Option<u64> {
        self.ended_at
    }

    /// Returns the current torques of the motors, N cm.
    pub fn motor_torques(&self) -> Vector4<f64> {
        Vector4::from(self.torques.map(f64::from)) * (f64::from(self.torque_unit) * 1e-7)
    }

    /// Returns the status that a Reply would contain now.
    pub fn status(&self) -> Status {
        let state = match self.state {
            State::Idle => Status::default(),
            State::Ready => Status::CONFIGURED,
            State::Enabled => Status::CONFIGURED | Status::ENABLED,
            State::Ended { holds_until: None } => Status::CONFIGURED | Status::ENDED,
            State::Ended { holds_until: Some(_) } => Status::CONFIGURED | Status::ENDED | Status::HOLDING,
        };
        let zero = if self.zero_valid { Status::ZERO_VALID } else { Status::default() };
        state | zero | self.latched
    }

    pub(super) fn set_zero_valid(&mut self, valid: bool) {
        self.zero_valid = valid;
    }

    /// Returns the wiring between the board and the finger, which can be changed.
    pub fn wiring(&mut self) -> &mut Wiring {
        &mut self.wiring
    }

    pub(super) fn sensors(&mut self) -> &mut Sensors {
        &mut self.sensors
    }

    /// Resets the finger as a loss of power does: it forgets its terms, stored faults and tactile events, and the
    /// motors are off. The encoders are absolute and keep their zeros.
    pub fn reset(&mut self) {
        self.state = State::Idle;
        self.torques = [0; 4];
        self.latched = self.present;
        self.pads.reset();
    }

    /// Computes one step of the physics, which ends at `now`, ns.
    pub(super) fn step(&mut self, now: u64) {
        self.clock = now;
        match self.state {
            State::Enabled => {
                let silence = now - self.commanded_at.unwrap_or(now);
                if silence > u64::from(self.terms.watchdog_ms) * MILLISECOND {
                    self.latched |= Status::WATCHDOG_TRIPPED;
                    self.end(now);
                }
            }
            State::Ended { holds_until: Some(until) } if now >= until => {
                self.torques = [0; 4];
                self.state = State::Ended { holds_until: None };
            }
            State::Idle | State::Ready | State::Ended { .. } => {}
        }
        let newton_metres = self.motor_torques() * 0.01;
        self.plant.step(self.wiring.torques(newton_metres.into()));
        self.sensors.pass(PLANT_STEP_SECONDS);
        self.feel();
    }

    pub(super) fn configure(&mut self, terms: &Configure) -> Frame {
        if let Some(refusal) = self.refuses_any_terms() {
            return refusal;
        }
        let refuse = |reason, detail| Frame::Refused(Refused { request: 0x2, reason, detail });
        if let Some(offset) = Self::wrong_before_end_state(terms.version, terms.watchdog_ms) {
            return refuse(Reason::Value, offset);
        }
        if let Some(motor) = terms.torque_limits.iter().position(|&limit| limit > self.torque_limit) {
            return refuse(Reason::Value, 10 + 2 * motor as u16);
        }
        self.terms = *terms;
        self.torques = [0; 4];
        self.latched = Status::default();
        (self.commanded_at, self.ended_at) = (None, None);
        self.state = State::Ready;
        let (encoders, gauges) = self.wiring.counts(self.sensors.read(&self.plant));
        Frame::Configured(Configured { terms: *terms, encoders, gauges, status: self.status() })
    }

    /// Checks the fields of a Configure that precede the field *end state*. Returns the offset of the first wrong one,
    /// if there is one.
    pub(super) fn wrong_before_end_state(version: u8, watchdog_ms: u16) -> Option<u16> {
        match (version, watchdog_ms) {
            (VERSION, SHORTEST_WATCHDOG_MS..) => None,
            (VERSION, _) => Some(3),
            _ => Some(2),
        }
    }

    /// Returns the refusal if the finger now refuses every Configure, even one whose terms cannot be decoded.
    pub(super) fn refuses_any_terms(&self) -> Option<Frame> {
        let refuse = |reason, detail| Some(Frame::Refused(Refused { request: 0x2, reason, detail }));
        if self.enabled() {
            return refuse(Reason::Running, 0);
        }
        if self.present != Status::default() {
            return refuse(Reason::Fault, self.present.0);
        }
        None
    }

    /// `damaged` is the number of damaged frames on the port so far.
    pub(super) fn command(&mut self, now: u64, command: &Command, damaged: u64) -> Frame {
        let mut clipped = false;
        match (self.state, command.enable) {
            (State::Idle, _) => {
                return Frame::Refused(Refused { request: 0x3, reason: Reason::NotConfigured, detail: 0 });
            }
            (State::Ended { .. }, _) => {}
            (State::Ready | State::Enabled, true) => {
                self.plant.release_brake();
                (self.state, self.commanded_at) = (State::Enabled, Some(now));
                self.torques = Self::clipped(command.torques, self.terms.torque_limits);
                clipped = self.torques != command.torques;
            }
            (State::Ready | State::Enabled, false) => {
                self.state = State::Ready;
                self.torques = [0; 4];
            }
        }
        let (encoders, gauges) = self.wiring.counts(self.sensors.read(&self.plant));
        let mut status = self.status();
        if clipped {
            status |= Status::TORQUE_CLIPPED;
        }
        if damaged != self.damaged_before {
            status |= Status::DAMAGED_INPUT;
            self.damaged_before = damaged;
        }
        Frame::Reply(Reply {
            status,
            encoders: encoders.map(|count| count as u16),
            gauges,
            sampled_at: (now / 1000) as u16,
        })
    }
}

//! Presents the hardware of a finger as a board of the board protocol: keeps the states of the board, converts samples
//! to the counts of the protocol, and checks the watchdog time.

use super::finger_io::{FingerIo, IoCommand, IoFaults, IoProperties, IoSample, IoTerms};
use super::identity::identity;
use super::tension_scale::TensionScale;
use crate::board::port_error::PortError;
use crate::board::protocol::{Command, Configure, Configured, Frame, Identity, Reason, Refused, Reply, Status};
use crate::model::FingerNumber;
use crate::model::configuration::Configuration;
use crate::realtime;
use nalgebra::Vector4;
use std::io;

/// uN m in one N cm.
const MICRO_PER_CENTI: f64 = 1e4;

/// The states of `docs/board-protocol.md`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Idle,
    Ready,
    Enabled,
    Ended,
}

/// The hardware of a finger.
pub(super) struct Hardware {
    io: Box<dyn FingerIo>,
    properties: IoProperties,
    scale: TensionScale,
    finger: FingerNumber,
    rate: f64,
    identity: Identity,
    state: State,
    /// Whether the hardware was started and has not confirmed a stop.
    started: bool,
    terms: Configure,
    /// Status bits that stay set until the next Configure.
    latched: Status,
    zero_lost: bool,
    /// Whether the last sample reported that the zero is lost. True before the first sample, so that a zero that is
    /// already missing at opening does not count as lost after opening.
    reports_lost_zero: bool,
    /// Whether the zero was lost after opening, and no start has reported it valid since.
    lost_since_open: bool,
    /// The last sample that could be converted.
    encoders: [i32; 4],
    gauges: [u16; 4],
    sampled_at: u16,
    /// When the hardware was started or the last successful exchange began, ns.
    exchanged_at: u64,
    last_sequence: Option<u8>,
    /// Number of the last Command since the start.
    number: u64,
}

impl Hardware {
    /// Returns `None` if `properties.tension_unit` is not a positive number.
    pub fn new(
        configuration: &Configuration,
        finger: FingerNumber,
        io: Box<dyn FingerIo>,
        properties: IoProperties,
    ) -> Option<Self> {
        Some(Self {
            scale: TensionScale::new(properties.tension_unit)?,
            identity: identity(configuration, finger, &properties),
            io,
            properties,
            finger,
            rate: configuration.hand.rate,
            state: State::Idle,
            started: false,
            terms: Configure::default(),
            latched: Status::default(),
            zero_lost: false,
            reports_lost_zero: true,
            lost_since_open: false,
            encoders: [0; 4],
            gauges: [0; 4],
            sampled_at: 0,
            exchanged_at: 0,
            last_sequence: None,
            number: 0,
        })
    }

    pub fn finger(&self) -> FingerNumber {
        self.finger
    }

    pub fn identity(&self) -> Identity {
        self.identity
    }

    pub fn in_step(&self) -> bool {
        self.properties.in_step
    }

    /// Returns the status of a Reply. If the flag *zero valid* was already clear at opening, it cannot show a later
    /// loss of the zero. Therefore each loss after opening also clears *configured*, as on a serial board that
    /// restarts.
    pub fn status(&self) -> Status {
        let configured = if self.lost_since_open { Status::default() } else { Status::CONFIGURED };
        let state = match self.state {
            State::Idle => Status::default(),
            State::Ready => configured,
            State::Enabled => configured | Status::ENABLED,
            State::Ended => configured | Status::ENDED,
        };
        let zero = if self.zero_lost { Status::default() } else { Status::ZERO_VALID };
        state | zero | self.latched
    }

    /// Stops the hardware if it was started, and starts it with `terms`. The motors stay off until the first enabling
    /// Command. Refuses the terms while the motors follow Commands, or if the first sample reports a fault.
    pub fn configure(&mut self, terms: &Configure) -> Result<Frame, PortError> {
        if self.state == State::Enabled {
            return Ok(Frame::Refused(Refused { request: 0x2, reason: Reason::Running, detail: 0 }));
        }
        self.end().map_err(|source| PortError::Hardware { doing: "stop", source })?;
        let torque = |count: u16| self.identity.torque(count.min(i16::MAX as u16) as i16);
        let io_terms = IoTerms {
            finger: self.finger,
            rate: self.rate,
            watchdog_ms: terms.watchdog_ms,
            end_state: terms.end_state,
            hold_time_ms: terms.hold_time_ms,
            hold_torque_limit: torque(terms.hold_torque_limit),
            torque_limits: Vector4::from(terms.torque_limits.map(torque)),
            torque_constants: Vector4::from(
                terms.torque_constants.map(|constant| f64::from(constant) / MICRO_PER_CENTI),
            ),
        };
        let first = self.io.start(&io_terms).map_err(|source| PortError::Hardware { doing: "start", source })?;
        (self.started, self.terms) = (true, *terms);
        (self.latched, self.zero_lost, self.state) = (Status::default(), false, State::Ready);
        (self.last_sequence, self.number) = (None, 0);
        self.exchanged_at = realtime::now();
        self.note(&first, true);
        self.lost_since_open &= self.zero_lost;
        // The board protocol refuses terms while a fault is present.
        if self.latched != Status::default() {
            let detail = self.latched.0;
            self.end().map_err(|source| PortError::Hardware { doing: "stop", source })?;
            return Ok(Frame::Refused(Refused { request: 0x2, reason: Reason::Fault, detail }));
        }
        let (encoders, gauges, status) = (self.encoders, self.gauges, self.status());
        Ok(Frame::Configured(Configured { terms: *terms, encoders, gauges, status }))
    }

    /// Brings the hardware to its end state, if it is not there.
    pub fn end(&mut self) -> io::Result<()> {
        if self.state != State::Idle {
            self.state = State::Ended;
        }
        if self.started {
            self.io.stop()?;
            self.started = false;
        }
        Ok(())
    }

    /// Carries out a Command. Returns the Reply, or `None` if the exchange failed. After the end state was entered, the
    /// Reply repeats the last sample. Before the first Configure, returns a refusal.
    pub fn exchange(&mut self, sequence: u8, command: &Command, deadline: u64) -> Option<Frame> {
        let now = realtime::now();
        let watchdog = u64::from(self.terms.watchdog_ms) * 1_000_000;
        match self.state {
            State::Idle => {
                return Some(Frame::Refused(Refused { request: 0x3, reason: Reason::NotConfigured, detail: 0 }));
            }
            State::Ended => return Some(self.reply(false)),
            // The hardware has stopped by itself, even if it does not report that.
            State::Enabled if !self.in_step() && now.saturating_sub(self.exchanged_at) > watchdog => {
                self.latched |= Status::WATCHDOG_TRIPPED;
                self.state = State::Ended;
                return Some(self.reply(false));
            }
            State::Ready | State::Enabled => {}
        }
        if self.last_sequence != Some(sequence) {
            (self.last_sequence, self.number) = (Some(sequence), self.number + 1);
        }
        let limited: [i16; 4] = std::array::from_fn(|motor| {
            let limit = self.terms.torque_limits[motor].min(i16::MAX as u16) as i16;
            if command.enable { command.torques[motor].clamp(-limit, limit) } else { 0 }
        });
        let torques = Vector4::from(limited.map(|count| self.identity.torque(count)));
        let request = IoCommand { number: self.number, enable: command.enable, torques, deadline };
        let sample = self.io.exchange(&request).ok()?;
        self.exchanged_at = now;
        self.state = if command.enable { State::Enabled } else { State::Ready };
        self.note(&sample, false);
        Some(self.reply(command.enable && limited != command.torques))
    }

    /// Stores a sample. A value that cannot be expressed as a count means that the sensor cannot be read. In the
    /// `first` sample, the encoders may have any count.
    fn note(&mut self, sample: &IoSample, first: bool) {
        for (io, status) in [
            (IoFaults::WATCHDOG, Status::WATCHDOG_TRIPPED),
            (IoFaults::ENDED, Status::ENDED),
            (IoFaults::EMERGENCY_STOP, Status::EMERGENCY_STOP),
            (IoFaults::SUPPLY, Status::SUPPLY_FAULT),
            (IoFaults::DRIVER, Status::DRIVER_FAULT),
            (IoFaults::SENSOR, Status::SENSOR_FAULT),
        ] {
            if sample.faults.has(io) {
                self.latched |= status;
            }
        }
        let zero_lost = sample.faults.has(IoFaults::ZERO_LOST);
        self.lost_since_open |= zero_lost && !self.reports_lost_zero;
        (self.reports_lost_zero, self.zero_lost) = (zero_lost, self.zero_lost || zero_lost);
        let counts = sample.tensions.map(|tension| self.scale.count(tension));
        // A Reply has only the low 16 bits of a count.
        let moved_too_far = |motor: usize| {
            let moved = sample.encoders[motor].wrapping_sub(self.encoders[motor]);
            !first && i16::try_from(moved).is_err()
        };
        if counts.contains(&None) || (0..4).any(moved_too_far) {
            self.latched |= Status::SENSOR_FAULT;
            return;
        }
        self.gauges = counts.map(Option::unwrap_or_default);
        self.encoders = sample.encoders;
        self.sampled_at = (sample.time.unwrap_or_else(realtime::now) / 1000) as u16;
    }

    fn reply(&self, clipped: bool) -> Frame {
        let clipped = if clipped { Status::TORQUE_CLIPPED } else { Status::default() };
        Frame::Reply(Reply {
            status: self.status() | clipped,
            encoders: self.encoders.map(|count| count as u16),
            gauges: self.gauges,
            sampled_at: self.sampled_at,
        })
    }
}

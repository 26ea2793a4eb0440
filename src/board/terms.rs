//! The terms that a finger's configuration requires of its board.

use super::protocol::{Capabilities, Configure, Identity};
use crate::model::configuration::{ConfiguredFinger, ConfiguredHand, EndState};
use nalgebra::Vector4;
use thiserror::Error;

/// The protocol limits a board's shortest watchdog time to this value, ms. A board within this limit gets its shortest
/// time even if the configured one is shorter.
const LONGEST_NEEDED_MS: u16 = 20;

/// The largest torque unit of a board, as a fraction of a motor's torque limit. Rounding lowers the limit by up to one
/// unit.
const COARSEST_UNIT: f64 = 0.01;

/// uN m in one N cm.
const MICRO_PER_CENTI: f64 = 1e4;

/// The terms in physical units. [`Terms::configure`] converts them to a [`Configure`] in the units that the board's
/// [`Identity`] states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Silence after which the board enters its end state, ms. If the board's shortest time is longer than this and at
    /// most 20 ms, the board gets its shortest time.
    pub watchdog_ms: u16,
    /// What the board does when commands stop.
    pub end_state: EndState,
    /// Duration of *hold*, ms.
    pub hold_time_ms: u16,
    /// The largest torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// The largest torque of each motor, N cm.
    pub torque_limits: Vector4<f64>,
    /// Torque constant of each motor, N cm/A.
    pub torque_constants: Vector4<f64>,
}

/// Terms that a board cannot meet.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TermsError {
    /// The board's shortest watchdog time exceeds both the configured time and the protocol's limit.
    #[error(
        "its shortest watchdog time is {shortest} ms, which is longer than hand.watchdog_ms ({wanted} ms), and the \
         protocol requires a board to offer {LONGEST_NEEDED_MS} ms or less: update its firmware, or raise \
         hand.watchdog_ms to {shortest}; its motors then continue for that time when commands stop"
    )]
    Watchdog {
        /// The board's shortest time, ms.
        shortest: u16,
        /// The configured time, ms.
        wanted: u16,
    },
    /// The board does not support *hold*.
    #[error("it does not support holding the last torques: set hand.end_state = \"release\"")]
    Hold,
    /// A configured torque limit exceeds the board's.
    #[error(
        "its largest motor torque is {strongest:.3} N cm, but motor {motor} is configured for {wanted:.3} N cm: lower \
         finger.motor.torque_limit"
    )]
    TorqueLimit {
        /// The board's limit, N cm.
        strongest: f64,
        /// The motor's number, 1 to 4.
        motor: usize,
        /// The configured limit, N cm.
        wanted: f64,
    },
    /// The board's torque unit is zero.
    #[error("it reports a torque unit of 0: update its faulty firmware")]
    TorqueUnit,
    /// The board's torque unit is too coarse for the configured limits.
    #[error(
        "its torque unit is {unit:.3} N cm, more than 1 % of the torque limit of motor {motor}, {limit:.3} N cm: \
         update its firmware to a finer unit, or connect the board that the motor is meant for"
    )]
    CoarseUnit {
        /// The board's unit, N cm.
        unit: f64,
        /// The motor's number, 1 to 4.
        motor: usize,
        /// The configured limit, N cm.
        limit: f64,
    },
}

impl Terms {
    /// Takes the terms from the configuration.
    pub fn new(hand: &ConfiguredHand, finger: &ConfiguredFinger) -> Self {
        Self {
            watchdog_ms: hand.watchdog_ms,
            end_state: hand.end_state,
            hold_time_ms: hand.hold_time_ms,
            hold_torque_limit: hand.hold_torque_limit,
            torque_limits: Vector4::from(finger.motor.torque_limit),
            torque_constants: Vector4::from(finger.motor.torque_constant),
        }
    }

    /// Converts the terms to the board's units.
    pub fn configure(&self, board: &Identity) -> Result<Configure, TermsError> {
        if board.torque_unit == 0 {
            return Err(TermsError::TorqueUnit);
        }
        if board.shortest_watchdog_ms > self.watchdog_ms.max(LONGEST_NEEDED_MS) {
            return Err(TermsError::Watchdog { shortest: board.shortest_watchdog_ms, wanted: self.watchdog_ms });
        }
        if self.end_state == EndState::Hold && !board.capabilities.has(Capabilities::HOLD) {
            return Err(TermsError::Hold);
        }
        let unit = board.torque(1);
        let strongest = board.torque(board.torque_limit.min(i16::MAX as u16) as i16);
        for (index, &wanted) in self.torque_limits.iter().enumerate() {
            let motor = index + 1;
            // The first comparison is in N cm, because a count saturates. It accepts a torque that exceeds the board's
            // limit by less than one unit, because `count` rounds such a torque down to the limit.
            if wanted >= strongest + unit || count(board, wanted) > board.torque_limit {
                return Err(TermsError::TorqueLimit { strongest, motor, wanted });
            }
            if unit > COARSEST_UNIT * wanted {
                return Err(TermsError::CoarseUnit { unit, motor, limit: wanted });
            }
        }
        Ok(Configure {
            version: board.version,
            watchdog_ms: self.watchdog_ms.max(board.shortest_watchdog_ms),
            end_state: self.end_state,
            hold_time_ms: self.hold_time_ms,
            hold_torque_limit: count(board, self.hold_torque_limit),
            torque_limits: self.torque_limits.map(|limit| count(board, limit)).into(),
            torque_constants: self.torque_constants.map(micro).into(),
        })
    }
}

/// Returns a torque limit in the board's unit, rounded down. A negative limit gives zero.
fn count(board: &Identity, limit: f64) -> u16 {
    board.torque_count(limit).max(0) as u16
}

/// Converts a torque constant from N cm/A to uN m/A, rounded up. The board divides a torque by it, so a larger constant
/// gives a smaller current.
fn micro(constant: f64) -> u32 {
    let nearest = (constant * MICRO_PER_CENTI).round();
    let up = if nearest / MICRO_PER_CENTI < constant { nearest + 1.0 } else { nearest };
    up as u32
}

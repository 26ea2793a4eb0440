//! The terms that a finger's configuration asks of its board.

use super::protocol::{Capabilities, Configure, Identity};
use crate::model::configuration::{ConfiguredFinger, ConfiguredHand, EndState};
use nalgebra::Vector4;
use thiserror::Error;

/// The protocol lets a board need a watchdog of up to so many ms. It gets what it needs, even where a shorter one is
/// configured.
const LONGEST_NEEDED_MS: u16 = 20;

/// A board's torque unit is this part of a motor's torque limit at most: rounding takes as much off the limit.
const COARSEST_UNIT: f64 = 0.01;

/// uN m in one N cm.
const MICRO_PER_CENTI: f64 = 1e4;

/// The terms in physical units; a board's [`Identity`] turns them into a [`Configure`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Terms {
    /// Silence after which the board goes to its end state, ms. A board that needs more gets more, 20 ms at most.
    pub watchdog_ms: u16,
    /// What the board does when commands stop.
    pub end_state: EndState,
    /// How long *hold* holds, ms.
    pub hold_time_ms: u16,
    /// The largest torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// The largest torque of each motor, N cm.
    pub torque_limits: Vector4<f64>,
    /// Torque constant of each motor, N cm/A.
    pub torque_constants: Vector4<f64>,
}

/// Terms that a board cannot keep.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TermsError {
    /// The watchdog is shorter than the board's, and that is longer than the protocol lets it be.
    #[error(
        "its shortest watchdog is {shortest} ms, though the protocol allows {LONGEST_NEEDED_MS} ms, and {wanted} ms \
         are configured: update its firmware, or raise hand.watchdog_ms to {shortest}, after which its motors go on \
         for as long when commands stop"
    )]
    Watchdog {
        /// The board's, ms.
        shortest: u16,
        /// The configured one, ms.
        wanted: u16,
    },
    /// *hold* is not there.
    #[error("it cannot hold its last torques: set hand.end_state = \"release\"")]
    Hold,
    /// A limit beyond the board's.
    #[error(
        "it drives no motor beyond {strongest:.3} N cm, but motor {motor} is configured for {wanted:.3} N cm: lower \
         finger.motor.torque_limit"
    )]
    TorqueLimit {
        /// The board's, N cm.
        strongest: f64,
        /// Which motor, 1 to 4.
        motor: usize,
        /// The configured one, N cm.
        wanted: f64,
    },
    /// The board's torque unit is zero.
    #[error("it reports 0 as its torque unit: its firmware is faulty. Update it")]
    TorqueUnit,
    /// The board's torque unit is too coarse for the configured limits.
    #[error(
        "its torque unit is {unit:.3} N cm, more than 1 % of the torque limit of motor {motor}, {limit:.3} N cm: \
         update its firmware to a finer unit, or connect the board that the motor is meant for"
    )]
    CoarseUnit {
        /// The board's unit, N cm.
        unit: f64,
        /// Which motor, 1 to 4.
        motor: usize,
        /// Its configured limit, N cm.
        limit: f64,
    },
}

impl Terms {
    /// What the configuration says.
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

    /// In the board's units.
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
            // Compared in N cm, because counts saturate. What is left of a unit is rounded away.
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

/// A torque limit in the board's unit, rounded down. Never negative: a limit below zero reads as zero.
fn count(board: &Identity, limit: f64) -> u16 {
    board.torque_count(limit).max(0) as u16
}

/// A torque constant, N cm/A, in uN m/A, rounded up: the board divides a torque by it, and a larger one makes the
/// current smaller.
fn micro(constant: f64) -> u32 {
    let nearest = (constant * MICRO_PER_CENTI).round();
    let up = if nearest / MICRO_PER_CENTI < constant { nearest + 1.0 } else { nearest };
    up as u32
}

//! `[hand]`: values that all fingers share.

use super::object::ConfiguredObject;
use crate::model::fingers::Fingers;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Admissible rates of a hand, Hz. With the gains for 500 Hz, the finger is stable at rates down to 470 Hz, and
/// oscillates at a rate of 450 Hz.
pub const RATES: RangeInclusive<f64> = 500.0..=5000.0;

/// The largest magnitude of a component of gravity, m/s^2.
pub const LARGEST_GRAVITY: f64 = 100.0;

/// Permitted baud rates of a port, bit/s.
pub const BAUDS: RangeInclusive<u32> = 9600..=12_000_000;

/// The behaviour of the motors when commands stop. Commands stop when the hand is closed or stopped, when a finger
/// faults, and when the planner exits or dies.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum EndState {
    /// The torque goes to zero: in a ramp when the hand is closed, and otherwise at once.
    #[default]
    Release,
    /// The board keeps the last torque, up to `hold_torque_limit`, for `hold_time_ms`. Then it releases.
    Hold,
}

/// The fingers that stop when a finger faults.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OnFault {
    /// Only that finger. The others continue.
    #[default]
    Finger,
    /// Every finger.
    Hand,
}

/// The handling of a command outside the limits.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum OutOfRange {
    /// The call fails with ERANGE, and nothing changes.
    #[default]
    Refuse,
    /// The command is clamped to the nearest admissible value.
    Clamp,
}

/// What opening the hand does to make the servo threads real-time: SCHED_FIFO, locked memory, and a core for each.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RealTime {
    /// Opening fails if SCHED_FIFO, locked memory or a core is not available.
    Enforce,
    /// If SCHED_FIFO, locked memory or a core is not available, opening continues without it, and reports this.
    #[default]
    Try,
    /// Opening requests neither SCHED_FIFO nor locked memory nor cores.
    Ignore,
}

/// The clock that determines the periods of the servos.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum PeriodClock {
    /// The host's CLOCK_MONOTONIC.
    #[default]
    Host,
    /// The clock of the board, whose time the replies contain. If a thread serves several boards, it follows the clock
    /// of the first. Threads that follow different boards do not stay staggered.
    Board,
}

/// `[hand]`: values that all fingers share.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredHand {
    /// The fingers that the hand has: one, two or three. Calls for another finger are refused.
    pub fingers: Fingers,
    /// The ports at which the library looks for the boards that `finger.board` names. A * in the last part of a path
    /// stands for any text.
    pub search_ports: Vec<String>,
    /// Rate of every finger servo, Hz: 500 to 5000. No gains are known that keep a finger stable at a much lower rate.
    pub rate: f64,
    /// The clock that determines the rate.
    pub clock: PeriodClock,
    /// What opening the hand does to make the servo threads real-time.
    pub real_time: RealTime,
    /// The behaviour of the motors when commands stop.
    pub end_state: EndState,
    /// Time for which *hold* keeps the torque, ms: 1 to 60 000.
    pub hold_time_ms: u16,
    /// Largest motor torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// Time in which the torque is ramped down when the hand is closed with the end state *release*, ms: 0 to 5000.
    pub release_ramp_ms: u16,
    /// Time without a command after which the board goes to its end state, ms: 2 to 1000.
    pub watchdog_ms: u16,
    /// Whether opening the hand checks the wiring of every finger before the finger follows set points.
    pub self_test: bool,
    /// Time-out for the board's reply and for the tensioning of a finger during open, ms. It is a time and not a number
    /// of cycles.
    pub open_timeout_ms: u32,
    /// The fingers that stop when a finger faults.
    pub on_fault: OnFault,
    /// The handling of a command outside the limits.
    pub out_of_range: OutOfRange,
    /// Whether the first refusal of each kind is reported in one line: to the program's log callback, or on standard
    /// error if there is no callback.
    pub print_refusals: bool,
    /// Folder for files with the last two seconds of a finger that faults. Without a folder, no file is written.
    pub black_box: Option<String>,
    /// Gravity in palm coordinates, m/s^2.
    pub gravity: [f64; 3],
    /// Object that the fingers of a simulated hand can touch. If it is absent, there is no object.
    pub simulated_object: Option<ConfiguredObject>,
}

impl ConfiguredHand {
    /// Returns the period of the servos, ns.
    #[must_use]
    pub fn period(&self) -> u64 {
        (1e9 / self.rate).round() as u64
    }
}

impl Default for ConfiguredHand {
    fn default() -> Self {
        Self {
            fingers: Fingers::ALL,
            search_ports: ["/dev/serial/by-id/*", "/dev/ttyACM*", "/dev/ttyUSB*"].map(String::from).into(),
            rate: 1000.0,
            clock: PeriodClock::Host,
            real_time: RealTime::Try,
            end_state: EndState::Release,
            hold_time_ms: 2000,
            hold_torque_limit: 1.0,
            release_ramp_ms: 200,
            // A finger must be in its end state 20 ms after the last good reply, or after the death of its planner. A
            // board's timer may have a resolution of 1 ms and an error of 1 %. The servo counts `watchdog_ms` in whole
            // periods from the last good reply, and then sends a Stop. If `watchdog_ms` were 20, a Stop that leaves
            // late in its period would be too late.
            watchdog_ms: 18,
            self_test: false,
            open_timeout_ms: 10_000,
            on_fault: OnFault::Finger,
            out_of_range: OutOfRange::Refuse,
            print_refusals: true,
            black_box: None,
            gravity: [0.0; 3],
            simulated_object: None,
        }
    }
}

//! `[hand]`: what all fingers share.

use serde::{Deserialize, Serialize};

/// What happens to the motors when commands stop: by CloseHand, by exit, or by the planner's death.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EndState {
    /// Torque goes to zero: in a ramp while the servo lives, at once where only the board is left to do it.
    #[default]
    Release,
    /// The board keeps the last torque, within `hold_torque_limit`, for `hold_time_ms`; then it releases.
    Hold,
}

/// What stops when a finger faults.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OnFault {
    /// That finger; the others go on.
    #[default]
    Finger,
    /// Every finger.
    Hand,
}

/// What happens to a command outside the limits.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum OutOfRange {
    /// ERANGE, and nothing changes.
    #[default]
    Refuse,
    /// The nearest admissible value is taken.
    Clamp,
}

/// What OpenHand does for the servo threads to be real-time: SCHED_FIFO, locked memory, a core of their own.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RealTime {
    /// It fails where any of it cannot be had.
    Enforce,
    /// It goes on without, and says so.
    #[default]
    Try,
    /// It does not try.
    Ignore,
}

/// Whose clock the periods of the servos are counted by.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PeriodClock {
    /// The host's CLOCK_MONOTONIC.
    #[default]
    Host,
    /// The clock of the board, which its replies tell; of the first, where a thread serves several. Threads that follow
    /// different boards do not stay staggered.
    Board,
}

/// `[hand]`: what all fingers share.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredHand {
    /// Cycles of every finger servo in a second, Hz: 500 to 5000. No gains are known that keep a finger stable at much
    /// less.
    pub rate: f64,
    /// Whose clock the rate is counted by.
    pub clock: PeriodClock,
    /// Whether the servo threads have to be real-time.
    pub real_time: RealTime,
    /// What the board does when commands stop.
    pub end_state: EndState,
    /// How long *hold* holds, ms: 1 to 60 000.
    pub hold_time_ms: u16,
    /// Largest motor torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// How long CloseHand takes to ramp the torque down with *release*, ms: 0 to 5000.
    pub release_ramp_ms: u16,
    /// Silence after which the board goes to its end state, ms: 2 to 1000.
    pub watchdog_ms: u16,
    /// How long a board may take to answer, and a finger to come under tension, at open, ms by the clock.
    pub open_timeout_ms: u32,
    /// What stops when a finger faults.
    pub on_fault: OnFault,
    /// What happens to a command outside the limits.
    pub out_of_range: OutOfRange,
    /// One line on standard error at the first refusal of each kind.
    pub print_refusals: bool,
    /// Folder into which the last two seconds of a finger that faults are written; none: nowhere.
    pub black_box: Option<String>,
    /// Gravity in palm coordinates, m/s^2.
    pub gravity: [f64; 3],
}

impl ConfiguredHand {
    /// The period of the servos, ns.
    pub fn period(&self) -> u64 {
        (1e9 / self.rate).round() as u64
    }
}

impl Default for ConfiguredHand {
    fn default() -> Self {
        Self {
            rate: 1000.0,
            clock: PeriodClock::Host,
            real_time: RealTime::Try,
            end_state: EndState::Release,
            hold_time_ms: 2000,
            hold_torque_limit: 1.0,
            release_ramp_ms: 200,
            // A finger shall be in its end state 20 ms after the last good reply, or the death of its planner. A
            // board's timer may be 1 ms coarse and 1 % slow, and with 20 ms in whole periods a Stop that leaves a
            // moment late would come too late.
            watchdog_ms: 18,
            open_timeout_ms: 5000,
            on_fault: OnFault::Finger,
            out_of_range: OutOfRange::Refuse,
            print_refusals: true,
            black_box: None,
            gravity: [0.0; 3],
        }
    }
}

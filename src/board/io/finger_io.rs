//! The interface to the hardware of one finger.

use super::tension_scale::DEFAULT_TENSION_UNIT;
use crate::model::FingerNumber;
use crate::model::configuration::{EndState, FINGERS};
use nalgebra::Vector4;
use std::io;
use std::ops::{BitOr, BitOrAssign};

/// The hardware of one finger, for example drives and load cells on a field bus. A program implements this trait and
/// opens the hand with [`Hand::open_with_io`](crate::Hand::open_with_io).
///
/// The library calls [`start`](Self::start), then [`exchange`](Self::exchange) once a cycle, then [`stop`](Self::stop).
/// After a start that has succeeded, the library calls `stop` until it succeeds, or gives up after several failures. A
/// recovery stops the hardware if necessary and starts it again. No two calls for a finger overlap, but they may come
/// from different threads. Calls for different fingers may overlap. If the fingers share a servo thread, their
/// exchanges do not overlap, but a start, or the stop of a recovery, may overlap with the exchange of another finger.
///
/// The hardware has the watchdog: if no exchange comes for [`IoTerms::watchdog_ms`], it must enter the end state by
/// itself, because a program that hangs or dies makes no more calls.
///
/// `exchange` runs in the servo thread of the finger, and `stop` usually runs there too. They must not allocate memory,
/// wait for a lock, write to files or use the hand. A panic faults every finger of the servo thread.
pub trait FingerIo: Send {
    /// Returns what the library must know before it starts the hardware. The library calls this function once, at open.
    fn properties(&self) -> IoProperties {
        IoProperties::default()
    }

    /// Prepares the hardware for exchanges, with the motors off, and returns the first sample. The library calls it at
    /// open and at every recovery, and never in a servo thread, so it may take as long as it needs.
    ///
    /// # Errors
    /// The hand is not opened, or the finger stays faulted. The call that opens or recovers returns the error.
    fn start(&mut self, terms: &IoTerms) -> io::Result<IoSample>;

    /// Applies the torques of `command`, and returns what the sensors measure. If it returns a sample after the
    /// deadline, the sample is used nevertheless. If the next period has begun by then, the cycle counts as an overrun.
    ///
    /// # Errors
    /// A failed exchange counts like a lost reply of a serial board.
    fn exchange(&mut self, command: &IoCommand) -> io::Result<IoSample>;

    /// Enters the end state, [`IoTerms::end_state`].
    ///
    /// # Errors
    /// The library calls `stop` again. If `stop` keeps failing, the library calls it at least three times in all.
    fn stop(&mut self) -> io::Result<()>;
}

/// The hardware of fingers 1, 2 and 3. With `None`, the finger uses the port or the board of its configuration.
pub type HandIo = [Option<Box<dyn FingerIo>>; FINGERS];

/// What the library must know before it starts the hardware. Later versions add fields, so end a value with
/// `..Default::default()`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IoProperties {
    /// Step in which the library stores tensions, N. A tension may be from -8191 to 57 342 steps.
    pub tension_unit: f64,
    /// Shortest watchdog time of the hardware, ms.
    pub shortest_watchdog_ms: u16,
    /// Whether the hardware has the end state *hold*.
    pub holds: bool,
    /// Whether the hardware is a simulation that advances by one period in every exchange, however long the exchange
    /// takes. The servo then waits for the simulation: after an exchange that failed, the servo repeats the same
    /// command later, and the finger faults only if no exchange succeeds for five seconds.
    pub in_step: bool,
}

impl Default for IoProperties {
    fn default() -> Self {
        Self { tension_unit: DEFAULT_TENSION_UNIT, shortest_watchdog_ms: 0, holds: false, in_step: false }
    }
}

/// The terms under which the motors may move.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IoTerms {
    /// The finger, 1 to 3.
    pub finger: FingerNumber,
    /// Exchanges per second, Hz.
    pub rate: f64,
    /// Time without an exchange after which the hardware must enter the end state by itself, ms.
    pub watchdog_ms: u16,
    /// What the motors do when exchanges stop.
    pub end_state: EndState,
    /// Duration of *hold*, ms.
    pub hold_time_ms: u16,
    /// The largest torque that *hold* keeps, N cm.
    pub hold_torque_limit: f64,
    /// The largest torque of each motor, N cm. No commanded torque exceeds it.
    pub torque_limits: Vector4<f64>,
    /// Torque constant of each motor, N cm/A.
    pub torque_constants: Vector4<f64>,
}

/// The command of one exchange.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IoCommand {
    /// Number of the command, counted from the last call of [`FingerIo::start`]. If an exchange fails and
    /// [`IoProperties::in_step`] is true, the library repeats the exchange with the same number.
    pub number: u64,
    /// False: the motors are off, and the torques are zero.
    pub enable: bool,
    /// Torques of motors 1 to 4, N cm. The library has already applied `motor.sign`: a positive torque pulls
    /// the tendon if the sign of its motor is 1, and pays it out if the sign is -1.
    pub torques: Vector4<f64>,
    /// Time by which the exchange should return, ns of CLOCK_MONOTONIC. All fingers of a servo thread get the same
    /// deadline in a cycle, and a later one in the next cycle. So the first exchange of a cycle is the one with a new
    /// deadline.
    pub deadline: u64,
}

/// What the sensors of a finger measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IoSample {
    /// Time of the measurement, ns, of any clock that advances evenly. None: the time at which the exchange returned.
    pub time: Option<u64>,
    /// Counts of the motor encoders. The counters may wrap around.
    pub encoders: [i32; 4],
    /// Tensions at the gauges, N. A tension that is NaN, infinite or out of range counts as a gauge that cannot be
    /// read.
    pub tensions: [f64; 4],
    /// Faults of the hardware.
    pub faults: IoFaults,
}

/// Faults that the hardware reports. Each bit faults the finger, except [`IoFaults::ZERO_LOST`] if every sample since
/// the call of [`FingerIo::start`] at opening has had this bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IoFaults(pub u32);

impl IoFaults {
    /// The watchdog of the hardware has tripped since the last call of [`FingerIo::start`].
    pub const WATCHDOG: Self = Self(1 << 0);
    /// The hardware has entered the end state, but not by its watchdog.
    pub const ENDED: Self = Self(1 << 1);
    /// The emergency stop is active.
    pub const EMERGENCY_STOP: Self = Self(1 << 2);
    /// The supply of the motors is missing or out of range.
    pub const SUPPLY: Self = Self(1 << 3);
    /// A motor driver reports a fault.
    pub const DRIVER: Self = Self(1 << 4);
    /// An encoder or a gauge cannot be read.
    pub const SENSOR: Self = Self(1 << 5);
    /// The encoder counts have lost their reference to the zero. If [`FingerIo::start`] sets this bit when the hand is
    /// opened, the finger does not fault while the bit stays set: a message reports it, and the finger must be zeroed.
    /// Once a sample has come without the bit, the next sample with the bit reports a loss. In [`FingerIo::exchange`]
    /// the loss faults the finger. In [`FingerIo::start`] it makes the recovery fail.
    pub const ZERO_LOST: Self = Self(1 << 6);

    /// Returns whether any of these bits is set.
    #[must_use]
    pub fn has(self, bits: Self) -> bool {
        self.0 & bits.0 != 0
    }
}

impl BitOr for IoFaults {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for IoFaults {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

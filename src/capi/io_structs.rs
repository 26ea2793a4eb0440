//! The exported structs and constants for hardware that the program provides.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use std::ffi::{c_int, c_uint, c_ulong, c_void};

/// The watchdog of the hardware has tripped since the library last called start (struct sun2xp_io).
pub const SUN2XP_IO_WATCHDOG: c_uint = 1;

/// The hardware has entered the end state, but not by its watchdog.
pub const SUN2XP_IO_ENDED: c_uint = 2;

/// The emergency stop is active.
pub const SUN2XP_IO_EMERGENCY_STOP: c_uint = 4;

/// The supply of the motors is missing or out of range.
pub const SUN2XP_IO_SUPPLY: c_uint = 8;

/// A motor driver reports a fault.
pub const SUN2XP_IO_DRIVER: c_uint = 16;

/// An encoder or a gauge cannot be read.
pub const SUN2XP_IO_SENSOR: c_uint = 32;

/// The encoder counts have lost their reference to the zero. If start sets this bit when the hand is opened, the finger
/// does not fault while the bit stays set: a message reports it, and the finger must be zeroed (sun2xp_zero).
pub const SUN2XP_IO_ZERO_LOST: c_uint = 64;

/// The terms under which the motors of a finger may move. The library sets all members.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_io_terms {
    /// sizeof (struct sun2xp_io_terms) in the library.
    pub size: usize,
    /// Finger, 1 to 3.
    pub finger: c_int,
    /// 1: the end state is "hold"; 0: it is "release". sun2xp_stop_all explains both.
    pub hold: c_int,
    /// Exchanges per second, Hz.
    pub rate: f64,
    /// Time without an exchange after which the hardware must enter the end state by itself, s.
    pub watchdog: f64,
    /// Duration of "hold", s.
    pub hold_time: f64,
    /// Largest torque that "hold" keeps, N cm.
    pub hold_torque: f64,
    /// Largest torque of each motor, N cm. No commanded torque is larger.
    pub torque_limits: [f64; 4],
    /// Torque constant of each motor, N cm/A.
    pub torque_constants: [f64; 4],
}

/// The command of one exchange. The library sets all members.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_io_command {
    /// sizeof (struct sun2xp_io_command) in the library.
    pub size: usize,
    /// Number of the command, counted from the last call of start. If an exchange fails and the member in_step of
    /// struct sun2xp_io is 1, the library repeats the exchange with the same number.
    pub number: c_ulong,
    /// 0: the motors must be off, and the torques are zero.
    pub enable: c_int,
    /// Torques of motors 1 to 4, N cm.
    pub torques: [f64; 4],
    /// Time by which the exchange should return, s of CLOCK_MONOTONIC.
    pub deadline: f64,
}

/// What the sensors of a finger measured. Before the library calls start or exchange, it sets size, and sets all other
/// members to 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_io_sample {
    /// sizeof (struct sun2xp_io_sample) in the library.
    pub size: usize,
    /// Time of the measurement, s of any clock that advances evenly. 0 stands for the time at which the
    /// exchange returned.
    pub time: f64,
    /// Tensions at the gauges, N.
    pub tensions: [f64; 4],
    /// Counts of the motor encoders.
    pub encoders: [c_int; 4],
    /// Sum of the SUN2XP_IO_... bits of all present faults. Each bit stops the finger with a fault, with one exception:
    /// SUN2XP_IO_ZERO_LOST does not stop the finger if every sample since the call of start at opening has had this
    /// bit.
    pub faults: c_uint,
}

/// The hardware of one finger (sun2xp_open_io). Set unused members to 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_io {
    /// sizeof (struct sun2xp_io), the same in every element of an array.
    pub size: usize,
    /// Finger, 1 to 3.
    pub finger: c_int,
    /// 1: the hardware supports the end state "hold".
    pub holds: c_int,
    /// 1: the hardware is a simulation that advances by one period in each exchange. The servo waits for the
    /// simulation.
    pub in_step: c_int,
    /// Shortest watchdog time that the hardware supports, s.
    pub shortest_watchdog: f64,
    /// Resolution with which the library stores tensions, N. 0 selects 0.005 N.
    pub tension_unit: f64,
    /// First argument of the functions.
    pub user: *mut c_void,
    /// Prepares the hardware, with the motors off, and gets the first sample.
    pub start: Option<extern "C" fn(*mut c_void, *const sun2xp_io_terms, *mut sun2xp_io_sample) -> c_int>,
    /// Applies the torques, and gets what the sensors measure.
    pub exchange: Option<extern "C" fn(*mut c_void, *const sun2xp_io_command, *mut sun2xp_io_sample) -> c_int>,
    /// Enters the end state.
    pub stop: Option<extern "C" fn(*mut c_void) -> c_int>,
}

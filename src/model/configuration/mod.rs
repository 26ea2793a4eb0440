//! The types of a hand's configuration, with defaults for everything: the finger of the report and plausible values for
//! what the report leaves out. Reading them from a file is the business of the hand; checking them is done here.

mod controller;
mod drive;
mod hand;
mod mechanics;
mod simulation;
mod zeroing;

pub use controller::{ConfiguredController, Law, Scheme};
pub use drive::{
    ConfiguredEncoder, ConfiguredGauge, ConfiguredGeometry, ConfiguredJoints, ConfiguredMotor, ConfiguredTendon,
    GaugeReference,
};
pub use hand::{ConfiguredHand, EndState, OnFault, OutOfRange, PeriodClock, RealTime};
pub use mechanics::{ConfiguredFriction, ConfiguredLinks};
pub use simulation::{ConfiguredSimulation, Surface};
pub use zeroing::{ConfiguredZeroing, ZeroingMethod};

use crate::model::kinematics::Links;
use crate::model::tendons::{Tendons, TendonsError};
use nalgebra::{Isometry3, Matrix3, Matrix3x4, RowVector4, Vector3, Vector4};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// How many fingers a hand has.
pub const FINGERS: usize = 3;

/// The rates that a hand may have, Hz. The gains of 500 Hz are stable down to 470, and swing at 450.
pub const RATES: RangeInclusive<f64> = 500.0..=5000.0;

/// How far beyond the soft limits a mechanical stop is where none is configured, degrees.
const STOP_MARGIN: f64 = 3.0;

/// A key whose value cannot be used, and why. The key is relative to the finger's table, with dots: `tendon.maximum`.
#[derive(Clone, Debug, PartialEq)]
pub struct Unusable {
    /// Dotted path of the key.
    pub key: &'static str,
    /// Why, with the numbers, and what would be usable.
    pub reason: String,
}

/// `[finger]`, overridden by `[finger.1]` to `[finger.3]`: one finger, its port, thread and controller.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredFinger {
    /// Path of the serial port, or `simulated`.
    pub port: String,
    /// Bits a second on the port.
    pub baud: u32,
    /// Whether a port that has failed is looked for and opened again. The finger goes on only when it is told to
    /// recover.
    pub reconnect: bool,
    /// Address of the finger on its board, 1 to 15; 0: the finger's number.
    pub address: u8,
    /// Servo thread that runs the finger, 1 to 3; 0: the finger's number. Fingers on one port share a thread.
    pub thread: u8,
    /// Core the thread is bound to; none: the kernel chooses.
    pub core: Option<usize>,
    /// SCHED_FIFO priority of the thread, 1 to 99; 0: not real-time.
    pub priority: u8,
    /// Where the base of the finger is in the palm, cm; none: where the finger with this number is.
    pub base: Option<[f64; 3]>,
    /// Turn of the finger's frame about the palm's z axis, degrees; none: that of the finger with this number.
    pub turn_degrees: Option<f64>,
    /// `[finger.geometry]`
    pub geometry: ConfiguredGeometry,
    /// `[finger.motor]`
    pub motor: ConfiguredMotor,
    /// `[finger.encoder]`
    pub encoder: ConfiguredEncoder,
    /// `[finger.gauge]`
    pub gauge: ConfiguredGauge,
    /// `[finger.tendon]`
    pub tendon: ConfiguredTendon,
    /// `[finger.joints]`
    pub joints: ConfiguredJoints,
    /// `[finger.links]`
    pub links: ConfiguredLinks,
    /// `[finger.friction]`
    pub friction: ConfiguredFriction,
    /// `[finger.zeroing]`
    pub zeroing: ConfiguredZeroing,
    /// `[finger.stiffness]`
    pub stiffness: ConfiguredStiffness,
    /// `[finger.controller]`
    pub controller: ConfiguredController,
    /// `[finger.simulation]`
    pub simulation: ConfiguredSimulation,
}

/// `[finger.stiffness]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredStiffness {
    /// Kx that the finger holds its pose with after OpenHand, N/cm, row-major.
    pub initial: [[f64; 3]; 3],
    /// Bound on the largest eigenvalue of Kx, N/cm; none: 6 from 1000 Hz up, 5 below.
    pub bound: Option<f64>,
}

/// A whole hand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Configuration {
    /// What all fingers share.
    pub hand: ConfiguredHand,
    /// Fingers 1, 2 and 3.
    pub fingers: [ConfiguredFinger; FINGERS],
}

impl Configuration {
    /// The servo thread of a finger, 1 to 3.
    pub fn thread(&self, finger: usize) -> u8 {
        own_or(self.fingers[finger].thread, finger)
    }

    /// The address of a finger on its board, 1 to 15.
    pub fn address(&self, finger: usize) -> u8 {
        own_or(self.fingers[finger].address, finger)
    }

    /// From the finger's frame (Figure 8), cm, to the palm's. Two fingers stand side by side, the thumb faces them.
    pub fn finger_to_palm(&self, finger: usize) -> Isometry3<f64> {
        let (base, turn) = match finger {
            0 => ([3.0, 3.5, 0.0], 0.0),
            1 => ([-3.0, 3.5, 0.0], 0.0),
            _ => ([0.0, -3.5, 0.0], 180.0),
        };
        let configured = &self.fingers[finger];
        let base = Vector3::from(configured.base.unwrap_or(base));
        let turn = configured.turn_degrees.unwrap_or(turn).to_radians();
        Isometry3::new(base, Vector3::z() * turn)
    }

    /// Gravity in the finger's frame, m/s^2.
    pub fn gravity(&self, finger: usize) -> Vector3<f64> {
        self.finger_to_palm(finger).rotation.inverse() * Vector3::from(self.hand.gravity)
    }
}

fn own_or(configured: u8, finger: usize) -> u8 {
    // At most three fingers: the conversion cannot fail.
    if configured == 0 { finger as u8 + 1 } else { configured }
}

impl Default for ConfiguredFinger {
    fn default() -> Self {
        Self {
            port: "simulated".into(),
            baud: 1_000_000,
            reconnect: false,
            address: 0,
            thread: 0,
            core: None,
            priority: 80,
            base: None,
            turn_degrees: None,
            geometry: Default::default(),
            motor: Default::default(),
            encoder: Default::default(),
            gauge: Default::default(),
            tendon: Default::default(),
            joints: Default::default(),
            links: Default::default(),
            friction: Default::default(),
            zeroing: Default::default(),
            stiffness: Default::default(),
            controller: Default::default(),
            simulation: Default::default(),
        }
    }
}

impl Default for ConfiguredStiffness {
    fn default() -> Self {
        Self { initial: [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]], bound: None }
    }
}

impl ConfiguredStiffness {
    /// The bound that holds for the default finger under every controller at `rate` Hz, N/cm: less than what `sun2xp
    /// bound` finds for any of them (`docs/stiffness.md`).
    pub fn default_bound(rate: f64) -> f64 {
        if rate >= 1000.0 { 6.0 } else { 5.0 }
    }
}

impl ConfiguredFinger {
    /// Whether the finger has a simulated board instead of a port.
    pub fn simulated(&self) -> bool {
        self.port == "simulated"
    }

    /// The links.
    pub fn links(&self) -> Links {
        Links(self.geometry.links)
    }

    /// R of eq. 14, cm.
    pub fn r(&self) -> Matrix3x4<f64> {
        Matrix3x4::from_fn(|joint, tendon| self.geometry.r[joint][tendon])
    }

    /// R of eq. 14, Q of eq. 23 and M of eq. 22.
    ///
    /// # Errors
    /// Geometry without an arrangement of tendons: `geometry.r` or `geometry.ghost_row` is not of full rank.
    pub fn tendons(&self) -> Result<Tendons, TendonsError> {
        let ghost = self.geometry.ghost_row.map(RowVector4::from);
        Tendons::new(self.r(), Vector4::from(self.geometry.motor_radius), ghost)
    }

    /// The initial Kx, N/cm.
    pub fn initial_stiffness(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.stiffness.initial[row][column])
    }

    /// The bound on the largest eigenvalue of Kx, N/cm, at `rate` Hz.
    pub fn stiffness_bound(&self, rate: f64) -> f64 {
        self.stiffness.bound.unwrap_or_else(|| ConfiguredStiffness::default_bound(rate))
    }

    /// Soft joint limits, rad: lower, upper.
    pub fn joint_limits(&self) -> (Vector3<f64>, Vector3<f64>) {
        let radians = |degrees: [f64; 3]| Vector3::from(degrees.map(f64::to_radians));
        (radians(self.joints.minimum_degrees), radians(self.joints.maximum_degrees))
    }

    /// How the zero of the encoders is found: as configured. Where nothing is configured, by the mechanical stops if it
    /// is known where they are: both `zeroing.lower_stop_degrees` and `zeroing.upper_stop_degrees` are given, or the
    /// finger is simulated. Else by the pose.
    pub fn zeroing_method(&self) -> ZeroingMethod {
        let stops = self.zeroing.lower_stop_degrees.is_some() && self.zeroing.upper_stop_degrees.is_some();
        self.zeroing.method.unwrap_or(match stops || self.simulated() {
            true => ZeroingMethod::Stops,
            false => ZeroingMethod::Pose,
        })
    }

    /// Angles of the mechanical stops, rad: lower, upper.
    pub fn stops(&self) -> (Vector3<f64>, Vector3<f64>) {
        let beyond = |limits: [f64; 3], margin: f64| limits.map(|limit| limit + margin);
        let lower = self.zeroing.lower_stop_degrees.unwrap_or(beyond(self.joints.minimum_degrees, -STOP_MARGIN));
        let upper = self.zeroing.upper_stop_degrees.unwrap_or(beyond(self.joints.maximum_degrees, STOP_MARGIN));
        (Vector3::from(lower.map(f64::to_radians)), Vector3::from(upper.map(f64::to_radians)))
    }
}

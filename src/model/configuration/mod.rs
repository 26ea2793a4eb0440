//! The types of a hand's configuration, with a default for every value. The defaults describe the finger of the report,
//! with plausible values for what the report omits. Each table of the configuration file, except `[serve]` and
//! `[remote]`, has a Rust file here, and each key is a field of the table's type. `[finger]` itself is in this file.
//! The layer `hand` reads the values from a file. `model/validation.rs` checks them.

mod board_number;
mod contact;
mod controller;
mod encoder;
mod events;
mod finger_port;
mod friction;
mod gauge;
mod geometry;
mod hand;
mod io;
mod joints;
mod links;
mod monitors;
mod motion;
mod motor;
mod named_hand;
mod named_values;
mod object;
mod simulation;
mod stiffness;
mod telemetry;
mod tendon;
mod touch;
mod unusable;
mod zeroing;

pub use board_number::BoardNumber;
pub use contact::ConfiguredContact;
pub use controller::{ConfiguredController, Law, Scheme};
pub use encoder::ConfiguredEncoder;
pub use events::ConfiguredEvents;
pub use friction::ConfiguredFriction;
pub use gauge::{ConfiguredGauge, GaugeReference};
pub use geometry::ConfiguredGeometry;
pub use hand::{BAUDS, ConfiguredHand, EndState, LARGEST_GRAVITY, OnFault, OutOfRange, PeriodClock, RATES, RealTime};
pub use joints::ConfiguredJoints;
pub use links::ConfiguredLinks;
pub use monitors::ConfiguredMonitors;
pub use motion::{ConfiguredMotion, ExpiryReaction};
pub use motor::ConfiguredMotor;
pub use named_hand::NamedHand;
pub use object::{ConfiguredObject, ObjectShape};
pub use simulation::{ConfiguredSimulation, Surface};
pub use stiffness::ConfiguredStiffness;
pub use telemetry::ConfiguredTelemetry;
pub use tendon::ConfiguredTendon;
pub use touch::{ConfiguredTouch, MOST_ELEMENTS, TouchElement};
pub use unusable::Unusable;
pub use zeroing::{ConfiguredZeroing, ZeroingMethod};

pub use crate::model::finger_number::FINGERS;

use crate::model::finger_number::FingerNumber;
use crate::model::kinematics::Links;
use crate::model::tendons::{Tendons, TendonsError};
use nalgebra::{Isometry3, Matrix3, Matrix3x4, RowVector4, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Distance of a mechanical stop beyond the soft limit if no stop is configured, degrees.
const STOP_MARGIN: f64 = 3.0;

/// `[finger]`, overridden by `[finger.1]` to `[finger.3]`: one finger, its port, thread and controller.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredFinger {
    /// Path of the serial port, or `simulated`.
    pub port: String,
    /// Unique number of the finger, instead of a port: the hand opens the port at which a board reports it. Each finger
    /// of a board has a number of its own.
    pub board: Option<BoardNumber>,
    /// Bit rate of the port, bit/s.
    pub baud: u32,
    /// Whether the library searches for a port that has failed, and opens it again. The finger continues only after a
    /// recovery is requested.
    pub reconnect: bool,
    /// Address of the finger on its board, 1 to 15. With 0 it is the finger's number.
    pub address: u8,
    /// Servo thread that runs the finger, 1 to 3. With 0 it is the finger's number. Fingers on one port share a thread.
    pub thread: u8,
    /// Core to which the thread is bound. Without it the kernel selects the core.
    pub core: Option<usize>,
    /// SCHED_FIFO priority of the thread, 1 to 99. With 0 the thread is not real-time.
    pub priority: u8,
    /// Position of the finger's base in the palm, cm. Without it the default for the finger's number is used.
    pub base: Option<[f64; 3]>,
    /// Rotation of the finger's frame about the palm's z axis, degrees. Without it the default for the finger's
    /// number is used.
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
    /// `[finger.monitors]`
    pub monitors: ConfiguredMonitors,
    /// `[finger.events]`
    pub events: ConfiguredEvents,
    /// `[finger.touch]`
    pub touch: ConfiguredTouch,
    /// `[finger.contact]`
    pub contact: ConfiguredContact,
    /// `[finger.zeroing]`
    pub zeroing: ConfiguredZeroing,
    /// `[finger.stiffness]`
    pub stiffness: ConfiguredStiffness,
    /// `[finger.controller]`
    pub controller: ConfiguredController,
    /// `[finger.motion]`
    pub motion: ConfiguredMotion,
    /// `[finger.simulation]`
    pub simulation: ConfiguredSimulation,
}

/// The configuration of a complete hand.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Configuration {
    /// Values that all fingers share.
    pub hand: ConfiguredHand,
    /// What other processes may read.
    pub telemetry: ConfiguredTelemetry,
    /// Fingers 1, 2 and 3.
    pub fingers: [ConfiguredFinger; FINGERS],
}

impl Configuration {
    /// Returns the servo thread of a finger, 1 to 3.
    #[must_use]
    pub fn thread(&self, finger: FingerNumber) -> u8 {
        own_or(self.fingers[finger.index()].thread, finger)
    }

    /// Returns the address of a finger on its board, 1 to 15.
    #[must_use]
    pub fn address(&self, finger: FingerNumber) -> u8 {
        own_or(self.fingers[finger.index()].address, finger)
    }

    /// Returns the transformation from the finger's frame (Figure 8) to the palm's frame. Lengths are in cm. By default
    /// two fingers are side by side, and the thumb faces them.
    #[must_use]
    pub fn finger_to_palm(&self, finger: FingerNumber) -> Isometry3<f64> {
        let (base, turn) = match finger {
            FingerNumber::ONE => ([3.0, 3.5, 0.0], 0.0),
            FingerNumber::TWO => ([-3.0, 3.5, 0.0], 0.0),
            _ => ([0.0, -3.5, 0.0], 180.0),
        };
        let configured = &self.fingers[finger.index()];
        let base = Vector3::from(configured.base.unwrap_or(base));
        let turn = configured.turn_degrees.unwrap_or(turn).to_radians();
        Isometry3::new(base, Vector3::z() * turn)
    }

    /// Returns gravity in the finger's frame, m/s^2.
    #[must_use]
    pub fn gravity(&self, finger: FingerNumber) -> Vector3<f64> {
        self.finger_to_palm(finger).rotation.inverse() * Vector3::from(self.hand.gravity)
    }
}

fn own_or(configured: u8, finger: FingerNumber) -> u8 {
    // The conversion changes no value, because a hand has three fingers.
    if configured == 0 { finger.get() as u8 } else { configured }
}

impl Default for ConfiguredFinger {
    fn default() -> Self {
        Self {
            port: "simulated".into(),
            board: None,
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
            monitors: Default::default(),
            events: Default::default(),
            touch: Default::default(),
            contact: Default::default(),
            zeroing: Default::default(),
            stiffness: Default::default(),
            controller: Default::default(),
            motion: Default::default(),
            simulation: Default::default(),
        }
    }
}

impl ConfiguredFinger {
    /// Returns the link lengths.
    #[must_use]
    pub fn links(&self) -> Links {
        Links(self.geometry.links)
    }

    /// Returns R of eq. 14, cm.
    #[must_use]
    pub fn r(&self) -> Matrix3x4<f64> {
        Matrix3x4::from_fn(|joint, tendon| self.geometry.r[joint][tendon])
    }

    /// Returns R of eq. 14, Q of eq. 17 and M of eq. 21.
    ///
    /// # Errors
    /// Returns an error if the tendons cannot hold the finger: R with its ghost row is singular, or an entry of the
    /// ghost column of Q is not positive.
    pub fn tendons(&self) -> Result<Tendons, TendonsError> {
        let ghost = self.geometry.ghost_row.map(RowVector4::from);
        Tendons::new(self.r(), Vector4::from(self.geometry.motor_radius), ghost)
    }

    /// Returns the tendons of the simulated finger, with their true moment arms.
    ///
    /// # Errors
    /// Returns an error if tendons with these moment arms cannot hold the finger.
    pub fn true_tendons(&self) -> Result<Tendons, TendonsError> {
        let ratios = &self.simulation.moment_arm_ratio;
        let r = Matrix3x4::from_fn(|joint, tendon| self.geometry.r[joint][tendon] * ratios[joint][tendon]);
        Tendons::new(r, Vector4::from(self.geometry.motor_radius), self.geometry.ghost_row.map(RowVector4::from))
    }

    /// Returns the initial Kx, N/cm.
    #[must_use]
    pub fn initial_stiffness(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|row, column| self.stiffness.initial[row][column])
    }

    /// Returns the bound of the largest eigenvalue of Kx, N/cm, at `rate` Hz.
    #[must_use]
    pub fn stiffness_bound(&self, rate: f64) -> f64 {
        self.stiffness.bound.unwrap_or_else(|| ConfiguredStiffness::default_bound(rate))
    }

    /// Returns the soft joint limits, rad: lower, upper.
    #[must_use]
    pub fn joint_limits(&self) -> (Vector3<f64>, Vector3<f64>) {
        let radians = |degrees: [f64; 3]| Vector3::from(degrees.map(f64::to_radians));
        (radians(self.joints.minimum_degrees), radians(self.joints.maximum_degrees))
    }

    /// Returns the configured zeroing method. If none is configured, it is `Stops` if the angles of the mechanical
    /// stops are known: both `zeroing.lower_stop_degrees` and `zeroing.upper_stop_degrees` are configured, or the
    /// finger is simulated. Otherwise it is `Pose`.
    #[must_use]
    pub fn zeroing_method(&self) -> ZeroingMethod {
        self.zeroing.method.unwrap_or(match self.stops_known() {
            true => ZeroingMethod::Stops,
            false => ZeroingMethod::Pose,
        })
    }

    /// Returns whether the angles of the mechanical stops are known: they are configured, or the finger is simulated.
    pub fn stops_known(&self) -> bool {
        let configured = self.zeroing.lower_stop_degrees.is_some() && self.zeroing.upper_stop_degrees.is_some();
        configured || self.simulated()
    }

    /// Returns the angles of the mechanical stops, rad: lower, upper.
    pub fn stops(&self) -> (Vector3<f64>, Vector3<f64>) {
        let beyond = |limits: [f64; 3], margin: f64| limits.map(|limit| limit + margin);
        let lower = self.zeroing.lower_stop_degrees.unwrap_or(beyond(self.joints.minimum_degrees, -STOP_MARGIN));
        let upper = self.zeroing.upper_stop_degrees.unwrap_or(beyond(self.joints.maximum_degrees, STOP_MARGIN));
        (Vector3::from(lower.map(f64::to_radians)), Vector3::from(upper.map(f64::to_radians)))
    }
}

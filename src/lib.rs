//! The parallel stiffness controller of the Stanford/JPL hand (COINS TR 90-48, 1990) as a library.
//!
//! A planner is the program that commands the hand. C planners use `include/Sun2Xp.h`. Rust planners open a [`Hand`],
//! whose fingers are numbered 1 to 3, and send set points to it. Each fingertip then behaves as a spring of the
//! stiffness that was sent. Lengths are in cm, forces in N, torques in N cm, angles in rad and stiffnesses in N/cm.
//!
//! ```no_run
#![doc = include_str!("../examples/spring.rs")]
//! ```
//!
//! # Features
//!
//! `internals` exports the modules behind the types of this page, for example the controller, the board protocol, the
//! simulated boards and the physics. The benchmarks and tools of this project use these modules. Simulators of other
//! projects can use them too. The modules may change in any version.

#![deny(unsafe_code)]
#![warn(missing_docs)]
#![cfg_attr(not(feature = "internals"), warn(clippy::missing_errors_doc))]
#![cfg_attr(
    not(feature = "internals"),
    allow(dead_code, unused_imports, reason = "benchmarks, tools and tests use them")
)]

#[cfg(not(feature = "internals"))]
mod board;
#[cfg(feature = "internals")]
pub mod board;
#[cfg(not(feature = "internals"))]
mod calibration;
#[cfg(feature = "internals")]
pub mod calibration;
#[cfg(not(feature = "internals"))]
mod capi;
#[cfg(feature = "internals")]
pub mod capi;
#[cfg(not(feature = "internals"))]
mod control;
#[cfg(feature = "internals")]
pub mod control;
#[cfg(not(feature = "internals"))]
mod files;
#[cfg(feature = "internals")]
pub mod files;
#[cfg(not(feature = "internals"))]
mod finger;
#[cfg(feature = "internals")]
pub mod finger;
#[cfg(not(feature = "internals"))]
mod hand;
#[cfg(feature = "internals")]
pub mod hand;
#[cfg(not(feature = "internals"))]
mod model;
#[cfg(feature = "internals")]
pub mod model;
#[cfg(not(feature = "internals"))]
mod plant;
#[cfg(feature = "internals")]
pub mod plant;
#[cfg(not(feature = "internals"))]
mod realtime;
#[cfg(feature = "internals")]
pub mod realtime;
#[cfg(not(feature = "internals"))]
mod simulated;
#[cfg(feature = "internals")]
pub mod simulated;
#[cfg(not(feature = "internals"))]
mod stability;
#[cfg(feature = "internals")]
pub mod stability;
#[cfg(not(feature = "internals"))]
mod telemetry;
#[cfg(feature = "internals")]
pub mod telemetry;

pub use calibration::{Findings, Identified, Obstacle, Progress, Signs, Step, Task, Zeros};
pub use finger::{Fault, FaultKind, Losses, Recording, RecordingError, Stage, stop_all};
pub use hand::{
    Calibrating, CalibrationState, ConfigurationError, Configured, FingerFault, FingerStatus, FingerTip, Fingers, Hand,
    HandError, Recovering, RecoveryError, SetPointError,
};
pub use model::configuration::{
    Configuration, ConfiguredController, ConfiguredEncoder, ConfiguredFinger, ConfiguredFriction, ConfiguredGauge,
    ConfiguredGeometry, ConfiguredHand, ConfiguredJoints, ConfiguredLinks, ConfiguredMonitors, ConfiguredMotor,
    ConfiguredSimulation, ConfiguredStiffness, ConfiguredTendon, ConfiguredZeroing, EndState, GaugeReference, Law,
    OnFault, OutOfRange, PeriodClock, RealTime, Scheme, Surface, ZeroingMethod,
};
pub use model::{Contact, ContactError, FingerNumber, Part};
pub use realtime::Distribution;

/// Boards that a configuration names by their unique numbers.
pub mod boards {
    pub use crate::model::configuration::BoardNumber;
}

/// Contact without touch sensors: the thresholds of `[finger.contact]`.
pub mod contact {
    pub use crate::model::configuration::ConfiguredContact;
}

/// What other processes of the same user may see of an open hand: `[telemetry]`. The tool `sun2xp` is such a process.
pub mod monitoring {
    pub use crate::model::configuration::ConfiguredTelemetry;
}

/// Commands to several fingers that take effect in the same period, and waiting until fingers have arrived or settled.
pub mod groups {
    pub use crate::hand::{FingerCommand, Pose, Until, Waiting};
}

/// Hardware that the program provides, instead of boards at serial ports: [`Hand::open_with_io`].
pub mod io {
    pub use crate::board::{FingerIo, HandIo, IoCommand, IoFaults, IoProperties, IoSample, IoTerms};
}

/// The results of a finger's kinematics: joint torques, limits, and the pose of the finger in the palm.
pub mod kinematics {
    pub use crate::hand::{FingerLimits, JointTorques, PalmPose};
}

/// Events: what happens to a finger, with the cycle to which it belongs. [`Hand::events`] and [`Hand::on_event`] give
/// them to planners.
pub mod events {
    pub use crate::control::events::Arrival;
    pub use crate::finger::events::{Event, EventKind, ValueKind};
    pub use crate::hand::{EventListener, EventQueue};
    pub use crate::model::configuration::ConfiguredEvents;
}

/// Reflexes: rules that a servo carries out by itself. [`Hand::install_reflex`] installs them.
pub mod reflexes {
    pub use crate::finger::{Condition, MOST_RULES, Reaction, Reflex};
    pub use crate::hand::ReflexError;
}

/// The newest readings of the tactile elements ([`Hand::touch`]).
pub mod touch {
    pub use crate::finger::TouchReading;
    pub use crate::model::configuration::{ConfiguredTouch, MOST_ELEMENTS, TouchElement};
}

/// An object that all fingers of a simulated hand can touch.
pub mod object {
    pub use crate::model::configuration::{ConfiguredObject, ObjectShape};
    pub use crate::simulated::ObjectState;
}

/// Timed motion: paths, the validity of set points, and the configuration of motion.
pub mod motion {
    pub use crate::finger::Validity;
    pub use crate::hand::{PathError, PathPose, Pose};
    pub use crate::model::configuration::{ConfiguredMotion, ExpiryReaction};
}

/// The matrix library of the public signatures.
pub use nalgebra;

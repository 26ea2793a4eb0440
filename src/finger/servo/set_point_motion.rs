//! State of the motion of a set point: its path, its interpolation and its expiry.

use crate::control::motion::{Follower, InterpolationState};
use crate::finger::validity::Renewal;
use nalgebra::Vector3;

/// State of the motion of one finger's set point.
pub(super) struct SetPointMotion {
    /// Number of the period of the next cycle.
    pub next_period: u64,
    pub path: Following,
    /// The joint angles at which the interpolation of the set point ends, rad.
    pub target: Vector3<f64>,
    pub interpolation: InterpolationState,
    pub expiry: Option<Expiry>,
    /// The newest renewal of a validity. Its set point may not have taken effect yet.
    pub renewal: Option<Renewal>,
}

/// The path that is followed, or that was followed last.
pub(super) struct Following {
    /// Number of the path; 0 before the first one.
    pub number: u32,
    pub follower: Option<Follower>,
    /// Whether the path changes the stiffness.
    pub stiffness: bool,
}

/// When the set point expires, in periods. [`NEVER`] is later than every period.
pub(super) struct Expiry {
    /// The period in which the servo took the set point, or the last renewal of its validity.
    pub sent: u64,
    /// The period in which the set point expires.
    pub expires: u64,
    /// The period in which the finger faults.
    pub ends: u64,
}

/// The number of a period that is never reached.
pub(super) const NEVER: u64 = u64::MAX;

impl SetPointMotion {
    pub fn new() -> Self {
        Self {
            next_period: 1,
            path: Following { number: 0, follower: None, stiffness: false },
            target: Vector3::zeros(),
            interpolation: InterpolationState::default(),
            expiry: None,
            renewal: None,
        }
    }

    /// Begins a spring phase with a set point that rests at `joints`, rad.
    pub fn begin(&mut self, joints: Vector3<f64>) {
        self.rest(joints);
        self.expiry = None;
        self.renewal = None;
    }

    /// Ends a path and an interpolation. The set point rests at `joints`, rad.
    pub fn rest(&mut self, joints: Vector3<f64>) {
        self.path.follower = None;
        self.target = joints;
        self.interpolation = InterpolationState::at_rest(joints);
    }
}

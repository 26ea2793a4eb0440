//! State of the motion of a set point: its path, its interpolation and its expiry.

use crate::control::motion::{Follower, InterpolationState};
use crate::finger::sent::SentSetPoint;
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
    /// The newest renewal of the validity of a set point. This set point may not have taken effect yet.
    pub renewal: Option<Renewal>,
    /// The spring phase (`FingerReport::springs`) and the number of the set point that a planner sent last.
    planned: (u32, u32),
}

/// The path that is followed, or that was followed last.
pub(super) struct Following {
    /// Number of the path; 0 before the first one.
    pub number: u32,
    pub follower: Option<Follower>,
    /// Whether the path changes the stiffness.
    pub stiffness: bool,
    /// Whether the path begins in the next cycle.
    pub begins: bool,
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
            path: Following { number: 0, follower: None, stiffness: false, begins: false },
            target: Vector3::zeros(),
            interpolation: InterpolationState::default(),
            expiry: None,
            renewal: None,
            planned: (0, 0),
        }
    }

    /// Notes the planner's set point that is in `sent`, and returns whether it is new. It is not new if the library has
    /// only corrected it. `in_force` is the number of the set point in force.
    pub fn note_planned(&mut self, sent: &SentSetPoint, in_force: u32) -> bool {
        let planned = (sent.spring, sent.planned);
        // The library may also have corrected a set point that the servo set itself, or a set point of the previous
        // spring phase. The correction then started from the set point in force, so `sent.planned` equals `in_force`.
        let new = planned != self.planned && sent.planned != in_force;
        self.planned = planned;
        new
    }

    /// Returns whether this is the number of the planner's set point that the servo took last.
    pub fn is_planned_last(&self, number: u32) -> bool {
        self.planned.1 == number
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

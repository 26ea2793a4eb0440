//! What a servo computes with.

use crate::control::Controller;
use nalgebra::Vector3;

/// What a servo computes with, and what a planner may change while it runs.
#[derive(Clone, Debug)]
pub struct Adjustable {
    /// Of the controller, in the finger's black box.
    pub number: u32,
    /// The boxes of Figure 9.
    pub controller: Controller,
    /// Joint angles that a finger under tension can have, rad: lowest and highest.
    pub pose: (Vector3<f64>, Vector3<f64>),
}

// A servo copies it out of a buffer: nothing may be allocated or freed then.
const _: () = assert!(!std::mem::needs_drop::<Adjustable>());

//! The part of a servo's data that a planner can change while the servo runs.

use crate::control::Controller;
use crate::control::events::Detectors;
use crate::finger::ReactionLimits;
use crate::finger::motion_settings::MotionSettings;
use nalgebra::Vector3;

/// The data that a servo computes with and that a planner can change while the servo runs.
#[derive(Clone, Debug)]
pub struct Adjustable {
    /// Number of the controller. The records in the finger's black box name their controller by this number.
    pub number: u32,
    /// The controller (see [`crate::control`]).
    pub controller: Controller,
    /// What the servo does with the set points of its planner.
    pub motion: MotionSettings,
    /// The limits of the reactions of reflexes.
    pub reactions: ReactionLimits,
    /// Lowest and highest joint angles that a finger under tension can have, rad.
    pub pose: (Vector3<f64>, Vector3<f64>),
    /// The detectors of events.
    pub detectors: Detectors,
}

// The servo copies a value of this type out of a buffer. The copy must neither allocate nor free.
const _: () = assert!(!std::mem::needs_drop::<Adjustable>());

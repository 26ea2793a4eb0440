//! The changes that a planner requests for one finger.

use crate::command::{FingerCommand, Pose};
use sun2xp_remote_protocol::Place;

/// Values for one finger. A field that is none or [`Place::Kept`] changes nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    pub place: Place,
    pub stiffness: Option<[[f64; 3]; 3]>,
    pub damping: Option<f64>,
}

impl Change {
    pub fn of(command: &FingerCommand) -> Self {
        let place = match command.pose {
            None => Place::Kept,
            Some(Pose::Joints(joints)) => Place::Joints(joints),
            Some(Pose::Tip(tip)) => Place::Tip(tip),
        };
        Self { place, stiffness: command.stiffness, damping: command.damping }
    }

    pub fn is_nothing(&self) -> bool {
        self.place == Place::Kept && self.stiffness.is_none() && self.damping.is_none()
    }

    /// Adds a later change. Its values replace the values of this one.
    pub fn add(&mut self, later: Change) {
        if later.place != Place::Kept {
            self.place = later.place;
        }
        self.stiffness = later.stiffness.or(self.stiffness);
        self.damping = later.damping.or(self.damping);
    }
}

//! Contact without touch sensors: the torques that the surroundings exert on the joints follow from the tensions and
//! from the motion. The force at the fingertip follows from these torques.

mod detection;
mod estimate;
mod momentum_observer;
mod observer;
mod tip_force;

pub use estimate::ContactEstimate;
pub(super) use observer::{ContactObserver, ContactState};

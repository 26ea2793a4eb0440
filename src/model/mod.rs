//! The model of a finger: geometry, kinematics, tendons and the types of its configuration. Lengths are in cm, forces
//! in N, torques in N cm and angles in rad, as in the report (COINS TR 90-48, 1990), unless a name or a comment says
//! otherwise. Numbers of equations, figures and sections are those of the report.

pub mod configuration;
mod contact;
mod counted;
mod direction;
mod finger_number;
mod fingers;
mod inverse_kinematics;
mod kinematics;
mod link_dynamics;
mod link_momentum;
mod link_weight;
mod part;
pub mod path;
pub(crate) mod physics;
mod shown;
pub(crate) mod snapshot;
mod tendons;
mod validation;

pub use contact::{Contact, ContactError, spring};
pub use counted::Counted;
pub use direction::direction;
pub use finger_number::FingerNumber;
pub use fingers::Fingers;
pub use inverse_kinematics::{InverseKinematics, OutOfReach};
pub use kinematics::{JointSines, Links};
pub use link_dynamics::LinkDynamics;
pub use link_momentum::LinkMomentum;
pub(crate) use link_weight::LinkWeight;
pub use part::Part;
pub use shown::{OneLine, Shown, ShownPath, one_line};
pub use tendons::{Tendons, TendonsError};
pub use validation::{Section, UnusableConfiguration};

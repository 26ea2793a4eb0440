//! The pure core: one servo cycle is a function of feedback, set point and controller state. The core has no access to
//! threads, ports or clocks, and a cycle allocates nothing.
//!
//! Figures 9, 10 and 11 of the report (COINS TR 90-48, 1990) are block diagrams of the controller. `spring`, `tendons`,
//! `motors` and `sensing` contain their blocks, and `state_feedback` can replace most of them. [`Controller::cycle`]
//! connects the blocks. Equation numbers are those of the report.

mod contact;
mod culprit;
mod cycle;
mod eigenvalues;
pub mod events;
pub mod monitors;
pub mod motion;
mod motors;
mod number_checks;
mod rate_table;
pub(crate) mod sensing;
pub(crate) mod signals;
pub(crate) mod spring;
mod state_feedback;
mod take_up;
pub(crate) mod tendons;

pub use contact::ContactEstimate;
pub use cycle::{Controller, State};
pub use motion::Motion;
pub use signals::{Activity, Feedback, Law, Measured, MotorCommand, Report, SetPoint, spatial};
pub use spring::admissible_damping::AdmissibleDamping;
pub use spring::joint_spring::JointSpring;
pub use spring::joint_springs::JointSprings;
pub use spring::joint_stiffness::JointStiffness;
pub use spring::spring_transition::Spring;
pub use state_feedback::Numbers;
pub use tendons::tension_distribution::{BoundedDistribution, DistributedTensions, TensionDistribution};

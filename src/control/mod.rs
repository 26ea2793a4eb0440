//! The pure core: one servo cycle is a function of feedback, set point and controller state. It knows neither threads nor
//! ports nor clocks, and allocates nothing.
//!
//! One file is one box of Figure 9 (or of Figures 10 and 11), or one part of the state feedback that can stand in their place; [`Controller::cycle`] connects them.

mod admissible_damping;
mod admissible_stiffness;
pub mod calibration;
mod cycle;
mod damping_design;
mod dither;
mod eigenvalues;
mod figure10;
mod figure11;
mod figure9;
mod friction_feed_forward;
mod gains;
mod gravity_compensation;
mod inverse_kinematics;
mod joint_hold;
mod joint_positions;
mod joint_stiffness;
mod low_pass;
pub mod monitors;
mod motor_friction;
mod motor_heating;
mod motor_torque;
mod reference;
mod release;
mod sensors;
mod signals;
mod slack;
mod slew;
mod soft_limits;
mod spring_transition;
mod state_feedback;
mod stillness;
mod tendon_controller;
mod tendon_observer;
mod tension_distribution;
mod tension_integral;
mod transition;
mod usable;

pub use admissible_damping::AdmissibleDamping;
pub use cycle::{Controller, State};
pub use inverse_kinematics::{InverseKinematics, OutOfReach};
pub use joint_stiffness::JointStiffness;
pub use signals::{Activity, Command, Feedback, Law, Measured, Report, SetPoint, spatial};
pub use spring_transition::Spring;
pub use tension_distribution::{BoundedDistribution, Distribution, TensionDistribution};

//! The servo's core drives the simulated finger: quantised and noisy sensors, friction, one cycle of delay.

mod adjustment;
mod behaviour;
mod bumps;
mod damping;
mod figure11;
mod joint_solutions;
mod joint_spring;
mod limits;
mod rig;
mod robustness;
mod settling;
mod slack;
mod slack_hands;
mod state_feedback;
mod switching;
mod tip_stiffness;
mod turning_gravity;

//! The servo's core drives the simulated finger: quantised and noisy sensors, friction, one cycle of delay.

mod behaviour;
mod rig;
mod robustness;
mod state_feedback;

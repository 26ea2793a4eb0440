//! The motors: their torques, friction and heat.

pub(crate) mod motor_friction;
pub(crate) mod motor_heating;
pub(crate) mod motor_torque;

//! The struct of sun2xp_limits. Its doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

/// Result of sun2xp_limits.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_limits {
    /// sizeof (struct sun2xp_limits), set before the call.
    pub size: usize,
    /// Smallest angles of joints 0, 1, 2, rad.
    pub joint_minimum: [f64; 3],
    /// Largest angles of joints 0, 1, 2, rad.
    pub joint_maximum: [f64; 3],
    /// Smallest tension of a tendon, N.
    pub tension_minimum: f64,
    /// Largest tension of a tendon, N.
    pub tension_maximum: f64,
    /// Largest torques of the motors, N cm.
    pub motor_torque: [f64; 4],
    /// Largest permitted eigenvalue of a stiffness, N/cm.
    pub stiffness: f64,
}

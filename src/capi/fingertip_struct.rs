//! The struct of sun2xp_tip. Its doc comments are the C manual, as in `calls.rs`.

// The names of the header.
#![allow(non_camel_case_types)]

use std::ffi::c_int;

/// Result of sun2xp_tip. Vectors are in the finger's frame.
///
/// The member force is computed from the measured tensions, so it includes friction, weight and inertia of
/// the finger. This member is never NaN. Near singular poses there are directions in which a force on the
/// tip causes almost no joint torque, so that the force cannot be computed from the joint torques. Along
/// these directions, the members force and stiffness are zero. The member contact_force does not contain
/// constant errors of the gauges. The member stiffness is the part of Kx, or of the joint stiffness, that
/// the present pose admits, plus three other stiffnesses: that of the spring that pushes a joint back from
/// beyond its limit, that of the spring that holds joint 0 while the tip is near the axis of this joint, and
/// the rotational stiffness of a contact. After a change of Kx, this member has its new value in the next
/// cycle, although the stiffness of the finger itself changes over 50 ms. The members contact_force,
/// stiffness and touching are zero while the finger is not running. The member slide_speed is 0 while the
/// member touching is 0. While touching is 1, the tip slides on the object at this speed, or tip and object
/// move together at this speed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_tip {
    /// sizeof (struct sun2xp_tip), set before the call.
    pub size: usize,
    /// Number of directions in which the member force can be computed, 0 to 3.
    pub force_directions: c_int,
    /// Position of the tip: x, y, z, cm.
    pub position: [f64; 3],
    /// Force of the tip on an object, with friction, weight, inertia: x, y, z, N.
    pub force: [f64; 3],
    /// Measured tendon tensions, N.
    pub tensions: [f64; 4],
    /// Stiffness of the tip in its present pose, N/cm, row by row.
    pub stiffness: [[f64; 3]; 3],
    /// Force of the tip on an object, without friction, weight, inertia: x, y, z, N.
    pub contact_force: [f64; 3],
    /// Speed of the tip perpendicular to contact_force, cm/s.
    pub slide_speed: f64,
    /// 1: tensions and motion show that the finger touches something.
    pub touching: c_int,
}

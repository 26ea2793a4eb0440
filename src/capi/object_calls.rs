//! The exported function for the object in the simulated hand. Its doc comment is the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::memory::{fill, size_up_to};
use crate::simulated;
use std::ffi::{c_int, c_uint};

/// Result of GetObject. Vectors are in the palm's frame.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct ObjectState {
    /// In: sizeof (struct ObjectState). Out: bytes written, at most that.
    pub Size: c_uint,
    /// Number of fingers that touch the object.
    pub Touching: c_int,
    /// Simulated time since OpenHand, s. It stops while the machine is too busy for the simulation.
    pub Time: f64,
    /// Position of the middle: x, y, z, cm.
    pub Position: [f64; 3],
    /// Rotation matrix from the object's frame to the palm's, row by row. At the start it is the unit matrix.
    pub Rotation: [[f64; 3]; 3],
    /// Velocity of the middle, cm/s.
    pub Velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub Spin: [f64; 3],
    /// Force of each finger on the object, N: Force[0] is that of finger 1. It is the true force, without the errors of
    /// GetTip. It is zero for a finger that does not touch the object.
    pub Force: [[f64; 3]; 3],
}

/// GetObject - read pose and motion of the object in the simulated hand
///
///     int GetObject(struct ObjectState *Object);
///
///   Object   result, some milliseconds old at most; set Object->Size before the call
///
/// All simulated fingers touch one object if hand.simulated_object is configured: a ball or a box with
/// mass, friction and gravity, on a table or not. hand.gravity is its gravity.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Object is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small
///   ENOTSUP  no object is configured; no finger is simulated
///
/// Threads: any. Never waits for a servo or for the simulation. Takes less than 1 us.
///
/// Example:
///
///     struct ObjectState Object;
///     Object.Size = sizeof Object;
///     if (GetObject(&Object) == 0)
///         printf("z is %g cm, %d fingers touch\n", Object.Position[2], Object.Touching);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetObject(Object: *mut ObjectState) -> c_int {
    guarded("GetObject", || {
        let least = size_up_to!(ObjectState, Force: [[f64; 3]; 3]);
        // SAFETY: by the contract in the manual, `Object` is null or points to as many bytes as its first member gives.
        unsafe { fill(Object, "Object", least, |hand| hand.object().map(|object| to_c(&object))) }
    })
}

/// Converts everything except `Size`. [`fill`] sets `Size`, because it depends on the room of the caller.
fn to_c(object: &simulated::ObjectState) -> ObjectState {
    let touches = |force: &&[f64; 3]| force.iter().any(|&part| part != 0.0);
    ObjectState {
        Size: 0,
        Touching: object.forces.iter().filter(touches).count() as c_int, // 0 to 3
        Time: object.time,
        Position: object.position,
        Rotation: object.rotation,
        Velocity: object.velocity,
        Spin: object.angular_velocity,
        Force: object.forces,
    }
}

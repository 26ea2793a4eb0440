//! The exported functions for simulated fingers and their object. Their doc comments are the C manual, as in
//! `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::load;
use crate::capi::sized_struct::fill_from;
use crate::simulated;
use std::ffi::c_int;

/// Result of sun2xp_object. Vectors are in the palm's frame.
///
/// The member time stops while the machine is too busy for the simulation. The member rotation is the unit
/// matrix at the start. The member force comes from the simulation and not from the gauges. It is zero for a
/// finger that does not touch the object.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_object {
    /// sizeof (struct sun2xp_object), set before the call.
    pub size: usize,
    /// Number of fingers that touch the object.
    pub touching: c_int,
    /// Simulated time since sun2xp_open, s.
    pub time: f64,
    /// Position of the centre: x, y, z, cm.
    pub position: [f64; 3],
    /// Rotation from the object's frame to the palm's, row by row.
    pub rotation: [[f64; 3]; 3],
    /// Velocity of the centre, cm/s.
    pub velocity: [f64; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [f64; 3],
    /// True force of each finger on the object, N; [0]: finger 1.
    pub force: [[f64; 3]; 3],
}

/// sun2xp_object - read pose and motion of the object in the simulated hand
///
///   object   result, at most some milliseconds old; set object->size before the call
///
/// If hand.simulated_object is configured, the hand has one object that all simulated fingers can touch: a
/// ball or a box with mass and friction. It can lie on a table. hand.gravity also acts on the object.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   object is null
///   ENODEV   no such hand
///   EINVAL   size is too small
///   ENOTSUP  no object is configured; no finger is simulated
///
/// Threads: any. Never waits for a servo or for the simulation. Takes less than 1 us.
///
/// Example:
///
///     struct sun2xp_object object;
///     object.size = sizeof object;
///     if (sun2xp_object(hand, &object) == 0)
///         printf("z is %g cm, %d fingers touch\n", object.position[2], object.touching);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_object(hand: *mut sun2xp_hand, object: *mut sun2xp_object) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_object", hand, || {
        // SAFETY: by the contract in the manual, `object` is null or points to as many bytes as its first member gives.
        unsafe { fill_from(hand, object, "object", |hand| hand.object().map(|object| to_c(&object))) }
    })
}

/// sun2xp_push - push the fingertip of a simulated finger
///
///   finger   1 to 3
///   force    force[3]: force on the fingertip along x, y, z of the finger's frame, N. It
///            acts until the next sun2xp_push for this finger; zero ends it
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   force is null
///   ENODEV   no such hand
///   EINVAL   no such finger; an entry is NaN or infinite
///   ENOTSUP  the finger is not simulated by the library
///   ERANGE   a component is beyond 1000 N
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_push(hand: *mut sun2xp_hand, finger: c_int, force: *const f64) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_push", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let force = unsafe { load::<f64, 3>(force, "force") }?;
        hand_table::command(hand, |hand| hand.push_simulated(finger, force))
    })
}

/// Converts everything except `size`, which belongs to the caller.
fn to_c(object: &simulated::ObjectState) -> sun2xp_object {
    let touches = |force: &&[f64; 3]| force.iter().any(|&part| part != 0.0);
    sun2xp_object {
        size: 0,
        touching: object.forces.iter().filter(touches).count() as c_int, // 0 to 3
        time: object.time,
        position: object.position,
        rotation: object.rotation,
        velocity: object.velocity,
        angular_velocity: object.angular_velocity,
        force: object.forces,
    }
}

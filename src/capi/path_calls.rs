//! The exported functions for timed motion. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::default_hand;
use crate::capi::memory::{load, load_rows, non_null, size_up_to};
use crate::capi::refusal::{Refusal, Wanted};
use crate::finger::MOST_POSES;
use crate::hand::{self, HandError, PathError, Pose};
use crate::realtime::is_memory_free;
use std::ffi::{c_int, c_uint};
use std::time::Duration;

/// Memory that the computation of a path may need, bytes.
const MEMORY_OF_PATH: usize = 1 << 20;

/// Pose of a path (SendPath).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct PathPose {
    /// sizeof (struct PathPose), the same in every pose of the path.
    pub Size: c_uint,
    /// 0: Place holds joint angles. Otherwise: Place holds a position of the tip. The same in every pose.
    pub IsTip: c_int,
    /// Time since the beginning of the path, s.
    pub Time: f64,
    /// Angles of joints 0, 1, 2, rad, or x, y, z of the tip in the finger's frame, cm.
    pub Place: [f64; 3],
    /// Kx[9] of SendKx at this pose, row by row, always double. Null: the pose does not affect the stiffness.
    pub Kx: *const f64,
}

/// SendPath - send a timed path to a finger
///
///     int SendPath(int i, int Count, const struct PathPose *Poses, double ValidMs);
///
///   i         finger, 1 to 3
///   Count     number of poses, 1 to 128
///   Poses     Poses[Count], in the order of their times; set Size of every pose
///   ValidMs   how long the end of the path is valid, ms; 0 for finger.motion.valid_ms
///
/// The path begins at once where the anchor of the fingertip's spring is, continues its motion, passes
/// every pose at its time and rests at the last one. Between poses the joint angles, or the tip, follow
/// a spline. From rest to a single position of the tip, the tip moves along a straight line. Speed,
/// acceleration and jerk are continuous. Because they are fed forward, the finger follows without the
/// lag of SendPos. Kx changes linearly from the last pose that has a Kx, or from the beginning.
///
/// The whole path is checked before anything moves: against the joint limits, and against speed,
/// acceleration and jerk of finger.motion. With hand.out_of_range = "clamp" a path that is too fast is
/// made slower as a whole instead. Another path, SendPos or SendTip replaces the path without a jump,
/// even while the finger follows it. A Kx that is sent while a path runs takes effect at once, and the path no longer
/// changes Kx. After a refused call the finger continues as before.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Poses is null
///   ENOMEM   there is not enough memory for the computation
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger; Count is not 1 to 128; a time is less than 1 ms later
///            than the one before; joint angles and tip positions are mixed; an entry is NaN or infinite
///   EDOM     a Kx is not symmetric, or has a negative eigenvalue
///   ERANGE   a pose or a place between two poses is out of reach or outside the joint limits, a Kx is
///            too stiff, or the path is too fast; HandError names the pose, and the factor by which the
///            path must be slower
///   EIO      the finger is faulted
///   EBUSY    the finger is being opened or calibrated, or is limp
///   EAGAIN   the finger has become a spring again during the call
///
/// Threads: any. Never waits for a servo. Takes about 1 ms, depending on the number of poses.
///
/// Example:
///
///     static struct PathPose Poses[2];
///
///     Poses[0].Size = Poses[1].Size = sizeof Poses[0];
///     Poses[0].Time = 0.5;
///     Poses[0].Place[1] = 0.5, Poses[0].Place[2] = 0.8;
///     Poses[1].Time = 1.0;
///     Poses[1].Place[1] = 0.7, Poses[1].Place[2] = 1.1;
///     if (SendPath(1, 2, Poses, 0) != 0)
///         fprintf(stderr, "%s\n", HandError());
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPath(i: c_int, Count: c_int, Poses: *const PathPose, ValidMs: f64) -> c_int {
    guarded("SendPath", || {
        non_null(Poses, "Poses", Wanted::Struct("PathPose"))?;
        if !is_memory_free(MEMORY_OF_PATH) {
            return Err(Refusal::NoMemory);
        }
        // SAFETY: by the contract in the manual, `Poses` points to `Count` poses.
        let poses = unsafe { load_poses(Count, Poses) };
        default_hand::command(|hand| -> Result<(), Refusal> {
            Ok(hand.send_path(i, &poses?, valid(ValidMs).map_err(HandError::from)?)?)
        })
    })
}

/// SendPosFor - send desired joint angles that expire
///
///     int SendPosFor(int i, const double *Pos, double ValidMs);
///
///   i         finger, 1 to 3
///   Pos       Pos[3]: desired angles of joints 0, 1, 2, rad, as for SendPos. Always double
///   ValidMs   how long the angles are valid, ms; 0 for finger.motion.valid_ms
///
/// Has the effect of SendPos. If no other command of the planner arrives within ValidMs, the finger no
/// longer follows the angles: by default it holds the pose in which it then is with the soft
/// finger.motion.expired_stiffness. With finger.motion.on_expiry = "end state" it faults.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Pos is null
///   ENODEV   no hand is open
///   EINVAL   ValidMs is NaN, negative or more than 3600000; no such finger; an angle is NaN or infinite
///   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 200 ns.
///
/// Example, from a planner that sends every 20 ms:
///
///     double Pos[3] = {0.0, 0.5, 0.8};
///     SendPosFor(1, Pos, 60.0);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPosFor(i: c_int, Pos: *const f64, ValidMs: f64) -> c_int {
    guarded("SendPosFor", || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array of the synopsis.
        let joints = unsafe { load::<f64, 3>(Pos, "Pos") }?;
        default_hand::command(|hand| -> Result<(), HandError> { hand.send_position_for(i, joints, valid(ValidMs)?) })
    })
}

/// Returns the time for which a set point is valid; none for the configured time.
fn valid(milliseconds: f64) -> Result<Option<Duration>, PathError> {
    // This form of the comparison rejects NaN.
    if !(0.0..=3.6e6).contains(&milliseconds) {
        return Err(PathError::Valid(milliseconds));
    }
    Ok((milliseconds > 0.0).then(|| Duration::from_secs_f64(milliseconds * 1e-3)))
}

/// Copies the poses of a path.
///
/// # Safety
/// `poses` points to `count` poses, and at least to a Size. Every pose has as many bytes as the Size of the first one,
/// and its Kx is null or points to nine numbers.
unsafe fn load_poses(count: c_int, poses: *const PathPose) -> Result<Vec<hand::PathPose>, Refusal> {
    let number = usize::try_from(count).unwrap_or(0);
    if !(1..=MOST_POSES).contains(&number) {
        return Err(HandError::from(PathError::Count { count: number, most: MOST_POSES }).into());
    }
    // SAFETY: there is a pose, so its first member exists.
    let size = unsafe { poses.cast::<c_uint>().read_unaligned() } as usize;
    let least = size_up_to!(PathPose, Kx: *const f64);
    if size < least {
        return Err(Refusal::SmallStruct { name: "Poses", size, least });
    }
    (0..number)
        .map(|place| {
            // SAFETY: by the contract of this function there are `number` poses of `size` bytes, and `size` is not
            // smaller than a `PathPose`.
            let PathPose { IsTip, Time, Place, Kx, .. } = unsafe { poses.byte_add(place * size).read_unaligned() };
            let pose = if IsTip != 0 { Pose::Tip(Place) } else { Pose::Joints(Place) };
            // SAFETY: the pointer is not null, and points to its array by the contract of this function.
            let stiffness = (!Kx.is_null()).then(|| unsafe { load_rows(Kx, "Kx") }).transpose()?;
            Ok(hand::PathPose { time: Time, pose, stiffness })
        })
        .collect()
}

//! The exported functions for timed motion. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::memory::{load, load_rows, non_null};
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::sized_struct::SizedStruct;
use crate::finger::MOST_POSES;
use crate::hand::{self, HandError, PathError, Pose};
use crate::realtime::is_memory_free;
use std::ffi::c_int;
use std::time::Duration;

/// Memory that the computation of a path may need, bytes.
const MEMORY_OF_PATH: usize = 1 << 20;

/// Pose of a path (sun2xp_send_path).
///
/// The member is_tip must be the same in every pose of a path.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_path_pose {
    /// sizeof (struct sun2xp_path_pose), the same in every pose of the path.
    pub size: usize,
    /// 0: the member place holds joint angles. 1: it holds a position of the tip.
    pub is_tip: c_int,
    /// Time since the beginning of the path, s.
    pub time: f64,
    /// Joint angles, rad, or x, y, z of the tip in the finger's frame, cm.
    pub place: [f64; 3],
    /// Matrix Kx of sun2xp_send_stiffness. Null: the pose has no Kx.
    pub stiffness: *const f64,
}

/// sun2xp_send_path - send a timed path to a finger
///
///   finger    1 to 3
///   count     number of poses, 1 to 128
///   poses     poses[count], in the order of their times; set size of every pose
///   seconds   how long the path stays valid after its end, s; 0 for finger.motion.valid_ms
///
/// The path begins at once. Its first point is the present place of the anchor of the fingertip's spring,
/// and the path continues the anchor's motion. It passes every pose at its time and rests at the last one.
/// Between poses the joint angles, or the tip, follow a spline. If the path begins at rest and its only pose
/// is a position of the tip, the tip moves along a straight line. Speed, acceleration and jerk are
/// continuous, with one exception: if a path from the present motion would violate a limit, the finger first
/// brakes for 0.15 s. The braking begins with the present speed, but without acceleration and jerk. The
/// controller "state feedback" (finger.controller.scheme) smooths this step in acceleration and jerk. This
/// controller also feeds speed, acceleration and jerk forward, so the finger follows without the lag of
/// sun2xp_send_position.
///
/// Between two poses that have a Kx, Kx changes linearly. Until the first pose that has a Kx, Kx changes
/// linearly from its value at the beginning of the path. After sun2xp_send_joint_stiffness this value is 0,
/// and the joint stiffness ends when a path with a Kx begins. So call sun2xp_send_stiffness before such a
/// path. A path without a Kx leaves the joint stiffness as it is.
///
/// The whole path is checked before anything moves: against the joint limits, and against speed,
/// acceleration and jerk of finger.motion. With hand.out_of_range = "clamp" joint angles and Kx are clamped,
/// and a path that is too fast is made slower as a whole. A path that is out of reach, or that is outside the
/// joint limits between two poses, is refused nevertheless. Another path, sun2xp_send_position or
/// sun2xp_send_tip replaces the path without a jump, even while the finger follows it. A Kx that is sent
/// while a path runs takes effect at once, and the path no longer changes Kx. After a refused call the finger
/// continues as before.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   poses is null
///   ENOMEM   there is not enough memory for the computation
///   ENODEV   no such hand
///   EINVAL   size is too small; count is not 1 to 128; seconds is NaN, negative or more than 3600; no such
///            finger; a time is more than 3600 s, or less than 1 ms later than that of the pose before it
///            (0 for the first pose); joint angles and tip positions are mixed; an entry is NaN or infinite
///   EDOM     a Kx is not symmetric, or has a negative eigenvalue
///   ERANGE   a pose or a place between two poses is out of reach or outside the joint limits, a Kx is too
///            stiff, or the path is too fast; sun2xp_error_text names the pose. If the path is too
///            fast, the text also gives the factor by which it must be slower
///   EIO      the finger is faulted
///   EBUSY    the finger is being recovered or calibrated, or is limp
///   EAGAIN   during the call the finger was recovered or calibrated, its set point expired, a reflex reacted,
///            or the inhibition of a reflex ended. Send the path again
///   ERANGE   a Kx is too stiff for the ratio of sun2xp_send_damping ("clamp" clamps the ratio instead)
///
/// Threads: any. Never waits for a servo. Takes about 1 ms, depending on the number of poses.
///
/// Example:
///
///     static struct sun2xp_path_pose poses[2];
///
///     poses[0].size = poses[1].size = sizeof poses[0];
///     poses[0].time = 0.5;
///     poses[0].place[1] = 0.5, poses[0].place[2] = 0.8;
///     poses[1].time = 1.0;
///     poses[1].place[1] = 0.7, poses[1].place[2] = 1.1;
///     if (sun2xp_send_path(hand, 1, 2, poses, 0) != 0)
///         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_path(
    hand: *mut sun2xp_hand,
    finger: c_int,
    count: c_int,
    poses: *const sun2xp_path_pose,
    seconds: f64,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_path", hand, || {
        non_null(poses, "poses", Wanted::Struct("sun2xp_path_pose"))?;
        if !is_memory_free(MEMORY_OF_PATH) {
            return Err(Refusal::NoMemory);
        }
        // SAFETY: `poses` is not null, as checked above. By the contract in the manual it points to `count` poses. Each
        // of them has as many bytes as the first member of the first pose gives.
        let poses = unsafe { load_poses(count, poses) };
        hand_table::command(hand, |hand| -> Result<(), Refusal> {
            Ok(hand.send_path(finger, &poses?, valid(seconds).map_err(HandError::from)?)?)
        })
    })
}

/// sun2xp_send_position_for - send desired joint angles that expire
///
///   finger     1 to 3
///   position   position[3]: desired angles of joints 0, 1, 2, rad, as for sun2xp_send_position
///   seconds    how long the angles are valid, s; 0 for finger.motion.valid_ms
///
/// Has the effect of sun2xp_send_position. If the time given by seconds passes without another command to
/// the finger, the finger no longer follows the angles. By default it then holds its present pose, with the
/// soft stiffness finger.motion.expired_stiffness. With finger.motion.on_expiry = "end state" it faults.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   position is null
///   ENODEV   no such hand
///   EINVAL   seconds is NaN, negative or more than 3600; no such finger; an angle is NaN or infinite
///   ERANGE   an angle is outside the joint limits (hand.out_of_range = "clamp" clamps it instead)
///   EIO      the finger is faulted
///
/// Threads: any. Never waits for a servo. Takes about 200 ns.
///
/// Example, from a planner that sends every 20 ms:
///
///     double position[3] = {0.0, 0.5, 0.8};
///     sun2xp_send_position_for(hand, 1, position, 0.06);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_position_for(
    hand: *mut sun2xp_hand,
    finger: c_int,
    position: *const f64,
    seconds: f64,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_position_for", hand, || {
        // SAFETY: by the contract in the manual, the pointer is null or points to the array that the manual describes.
        let joints = unsafe { load::<f64, 3>(position, "position") }?;
        hand_table::command(hand, |hand| -> Result<(), HandError> {
            hand.send_position_for(finger, joints, valid(seconds)?)
        })
    })
}

/// Returns the time for which a set point is valid, or none if the configured time applies.
fn valid(seconds: f64) -> Result<Option<Duration>, PathError> {
    // This form of the comparison rejects NaN.
    if !(0.0..=3600.0).contains(&seconds) {
        return Err(PathError::Valid(seconds));
    }
    Ok((seconds > 0.0).then(|| Duration::from_secs_f64(seconds)))
}

/// Copies the poses of a path.
///
/// # Safety
/// There are `count` poses with the size of the first one, and the stiffness of each is null or points to nine numbers.
unsafe fn load_poses(count: c_int, poses: *const sun2xp_path_pose) -> Result<Vec<hand::PathPose>, Refusal> {
    let wrong_number = || PathError::Count { count: count.into(), most: MOST_POSES }.into();
    // SAFETY: by the contract of this function, the first pose has as many bytes as its size gives.
    let (poses, number) = unsafe { SizedStruct::array(poses, "poses", count, MOST_POSES, wrong_number) }?;
    (0..number)
        .map(|place| {
            // SAFETY: the size is right, as checked above, and by the contract of this function there are `number`
            // poses.
            let sun2xp_path_pose { is_tip, time, place, stiffness, .. } = unsafe { poses.load(place) };
            let pose = if is_tip != 0 { Pose::Tip(place) } else { Pose::Joints(place) };
            // SAFETY: the pointer is not null, and points to its array by the contract of this function.
            let matrix = || unsafe { load_rows(stiffness, "stiffness") };
            let stiffness = (!stiffness.is_null()).then(matrix).transpose()?;
            Ok(hand::PathPose { time, pose, stiffness })
        })
        .collect()
}

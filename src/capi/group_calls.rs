//! The exported functions for groups of fingers. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::{MEMORY_OF_THREAD, delegated, guarded};
use crate::capi::fingers::fingers;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::long_operations;
use crate::capi::memory::{load, load_rows, non_null};
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::sized_struct::SizedStruct;
use crate::hand::{self, SetPointError};
use crate::model::configuration::FINGERS;
use std::ffi::c_int;
use std::time::Duration;

/// Since the set point that was sent last took effect, there was a cycle in which every joint was within
/// finger.events.arrived_degrees of this set point.
pub const SUN2XP_WAIT_ARRIVED: c_int = 1;

/// Since the set point that was sent last took effect, there was a time of finger.events.settled_ms in which no joint
/// moved by more than finger.events.settled_degrees.
pub const SUN2XP_WAIT_SETTLED: c_int = 2;

/// Command to one finger of a group (sun2xp_send_group).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_set_point {
    /// sizeof (struct sun2xp_set_point), the same in every set point.
    pub size: usize,
    /// Finger, 1 to 3.
    pub finger: c_int,
    /// Angles of sun2xp_send_position. Null: the member tip gives the pose, or the pose stays.
    pub position: *const f64,
    /// Position of sun2xp_send_tip. Null: the member position gives the pose, or the pose stays.
    pub tip: *const f64,
    /// Matrix of sun2xp_send_stiffness. Null: the stiffness stays.
    pub stiffness: *const f64,
    /// Ratio of sun2xp_send_damping. 0: the damping stays.
    pub damping: f64,
}

/// sun2xp_send_group - command several fingers in the same cycle
///
///   count        number of commands, 0 to 3
///   set_points   set_points[count]: one command for each finger of the group, in any order; set size of
///                every command, and set unused members to 0
///
/// Each command has the effect of sun2xp_send_position or sun2xp_send_tip, sun2xp_send_stiffness and
/// sun2xp_send_damping. All fingers of the group follow their commands from the same cycle on, even if
/// different threads serve them. The periods of the servos are numbered for the whole hand, and the group
/// takes effect in the same period for every finger, at most two periods after the call. If the call is
/// refused, no finger gets its command.
///
/// If a servo is so late that it skips this period, its finger follows in its next cycle. With hand.clock =
/// "board" the cycles of a thread follow the clock of its board, but the periods are counted by the host's
/// clock. So the cycles skip or repeat a period now and then, and a group may then take effect one period
/// later in the fingers of this thread.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   EFAULT   set_points is null, and count is not 0
///   ENODEV   no such hand
///   EINVAL   size is too small; count is not 0 to 3; no such finger; two commands for one finger, or
///            position and tip for one finger; an entry is NaN or infinite
///   EDOM, ERANGE  as sun2xp_send_position, sun2xp_send_tip and sun2xp_send_stiffness
///   EIO      a finger of the group is faulted
///   ERANGE   a ratio is outside the range of sun2xp_send_damping, or a stiffness is too stiff for the ratio
///            (hand.out_of_range = "clamp" clamps the ratio)
///   EBUSY    16 groups of a finger have not taken effect yet, because the program sends more
///            than one in each period, or because the servo does not run
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, two fingers close together:
///
///     double position_1[3] = {0.0, 0.5, 0.8}, position_2[3] = {0.0, 0.6, 0.9};
///     static struct sun2xp_set_point set_points[2];
///
///     set_points[0].size = set_points[1].size = sizeof set_points[0];
///     set_points[0].finger = 1;
///     set_points[0].position = position_1;
///     set_points[1].finger = 2;
///     set_points[1].position = position_2;
///     sun2xp_send_group(hand, 2, set_points);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_send_group(
    hand: *mut sun2xp_hand,
    count: c_int,
    set_points: *const sun2xp_set_point,
) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_send_group", hand, || {
        let commands = if count == 0 {
            Ok(([hand::FingerCommand::default(); FINGERS], 0))
        } else {
            non_null(set_points, "set_points", Wanted::Struct("sun2xp_set_point"))?;
            // SAFETY: `set_points` is not null, as checked above. By the contract in the manual it points to `count`
            // set points. Each of them has as many bytes as the first member of the first set point gives.
            unsafe { load_commands(count, set_points) }
        };
        if let Some(remote) = hand_table::remote_to_command(hand)? {
            let (commands, count) = commands?;
            return Ok(remote.send(&commands[..count])?);
        }
        hand_table::command(hand, |hand| -> Result<(), Refusal> {
            let (commands, count) = commands?;
            Ok(hand.send_group(&commands[..count])?)
        })
    })
}

/// sun2xp_wait - wait until fingers have arrived or settled
///
///   finger    1 to 3, or SUN2XP_ALL_FINGERS
///   until     SUN2XP_WAIT_ARRIVED or SUN2XP_WAIT_SETTLED
///   seconds   longest time to wait
///
/// If the condition holds already, the call returns at once. With SUN2XP_ALL_FINGERS the condition must hold
/// for each finger and its own set point. The fingers may arrive or settle in different cycles. A finger that
/// an object blocks settles without arriving. If the set point is a position of the tip, the finger arrives
/// at the joint angles that were computed for it. If a reflex has replaced the set point that was sent last,
/// the condition must hold for the set point of the reflex. This is also so if the finger ignored a later set
/// point because the reflex inhibits set points for some time. In this case the wait returns only after that
/// time. If the set point that was sent last has expired, the condition must be true for the pose in which the
/// finger has stayed since then. The event SUN2XP_EVENT_REFLEX_FIRED reports the reaction of a reflex, and the
/// event SUN2XP_EVENT_EXPIRED reports that a set point has expired. Other calls work during the wait.
/// sun2xp_close works too, and then the wait is refused.
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand, or it was closed meanwhile
///   EINVAL   no such finger; until is neither of the two constants; seconds is negative or NaN
///   EIO      a finger is faulted
///   EBUSY    a finger is limp or is being calibrated, or the process is exiting (SUN2XP_STATE_CLOSED)
///   ETIMEDOUT  the time has expired; sun2xp_error_text names a finger that has not arrived or settled
///
/// Threads: any.
///
/// Example:
///
///     if (sun2xp_wait(hand, SUN2XP_ALL_FINGERS, SUN2XP_WAIT_SETTLED, 5.0) != 0)
///         fprintf(stderr, "%s\n", sun2xp_error_text(hand));
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_wait(hand: *mut sun2xp_hand, finger: c_int, until: c_int, seconds: f64) -> c_int {
    let hand = Handle::of(hand);
    delegated("sun2xp_wait", hand, MEMORY_OF_THREAD, || {
        Ok(move || {
            if let Some(remote) = hand_table::remote(hand)? {
                return Ok(remote.wait(finger, condition(until)?, time_limit(seconds)?)?);
            }
            let all: Vec<c_int> =
                hand_table::with(hand, |hand| Ok::<_, hand::HandError>(fingers(hand, finger).collect()))?;
            let exists = |&finger: &c_int| hand_table::with(hand, |hand| hand.report(finger).map(drop));
            all.iter().try_for_each(exists)?;
            long_operations::wait(hand, &all, condition(until)?, time_limit(seconds)?)
        })
    })
}

fn condition(until: c_int) -> Result<hand::Until, Refusal> {
    match until {
        SUN2XP_WAIT_ARRIVED => Ok(hand::Until::Arrived),
        SUN2XP_WAIT_SETTLED => Ok(hand::Until::Settled),
        _ => Err(hand::HandError::from(SetPointError::NoSuchCondition(until)).into()),
    }
}

/// The longest time to wait. A limit that is too long for a Duration is no limit.
fn time_limit(seconds: f64) -> Result<Duration, Refusal> {
    match seconds {
        limit if limit >= 0.0 => Ok(Duration::try_from_secs_f64(limit).unwrap_or(Duration::MAX)),
        _ => Err(hand::HandError::from(SetPointError::NoSuchLimit(seconds)).into()),
    }
}

/// Copies the commands of a group, and returns them with their number.
///
/// # Safety
/// There are `count` commands with the size of the first one, and their pointers are null or point to their arrays.
unsafe fn load_commands(
    count: c_int,
    commands: *const sun2xp_set_point,
) -> Result<([hand::FingerCommand; FINGERS], usize), Refusal> {
    let wrong_number = || SetPointError::GroupSize(count).into();
    // SAFETY: by the contract of this function, the first command has as many bytes as its size gives.
    let (commands, number) = unsafe { SizedStruct::array(commands, "set_points", count, FINGERS, wrong_number) }?;
    let mut loaded = [hand::FingerCommand::default(); FINGERS];
    for (place, loaded) in loaded[..number].iter_mut().enumerate() {
        // SAFETY: the size is right, as checked above, and by the contract of this function there are `number`
        // commands.
        let command = unsafe { commands.load(place) };
        // SAFETY: by the contract of this function the pointers are null or point to their arrays.
        *loaded = unsafe { from_c(&command) }?;
    }
    Ok((loaded, number))
}

/// Converts a command.
///
/// # Safety
/// Every pointer is null or points to its array.
unsafe fn from_c(command: &sun2xp_set_point) -> Result<hand::FingerCommand, Refusal> {
    let sun2xp_set_point { finger, position, tip, stiffness, damping, .. } = *command;
    let mut converted = hand::FingerCommand::new(finger);
    if !position.is_null() && !tip.is_null() {
        return Err(hand::HandError::from(SetPointError::TwoPoses(finger)).into());
    }
    // SAFETY: here and below, the pointer is not null, and points to its array by the contract of this function.
    if !position.is_null() {
        converted = converted.joints(unsafe { load::<f64, 3>(position, "position") }?);
    }
    if !tip.is_null() {
        converted = converted.tip(unsafe { load::<f64, 3>(tip, "tip") }?);
    }
    if !stiffness.is_null() {
        converted = converted.stiffness(unsafe { load_rows(stiffness, "stiffness") }?);
    }
    if damping != 0.0 {
        converted = converted.damping(damping);
    }
    Ok(converted)
}

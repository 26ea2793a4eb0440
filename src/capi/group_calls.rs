//! The exported functions for groups of fingers. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::{MEMORY_OF_THREAD, delegated, guarded};
use crate::capi::default_hand;
use crate::capi::memory::{load, load_rows, non_null, size_up_to};
use crate::capi::refusal::{Refusal, Wanted};
use crate::hand::{self, SetPointError};
use crate::model::configuration::FINGERS;
use std::ffi::{c_int, c_uint};
use std::time::Duration;

/// Every joint has been within finger.events.arrived_degrees of the set point sent last.
pub const WAIT_ARRIVED: c_int = 1;

/// Since the set point sent last took effect, no joint has moved by more than finger.events.settled_degrees for
/// finger.events.settled_ms.
pub const WAIT_SETTLED: c_int = 2;

/// Command to one finger of a group (SendGroup).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerCommand {
    /// sizeof (struct FingerCommand), the same in every command of the group.
    pub Size: c_uint,
    /// Finger, 1 to 3.
    pub Finger: c_int,
    /// Pos[3] of SendPos, always double. Null: the pose stays, or is that of Tip.
    pub Pos: *const f64,
    /// Tip[3] of SendTip. Null: the pose stays, or is that of Pos.
    pub Tip: *const f64,
    /// Kx[9] of SendKx, row by row, always double. Null: the stiffness stays.
    pub Kx: *const f64,
    /// Ratio of SendDamping. 0: the damping stays.
    pub Damping: f64,
}

/// SendGroup - command several fingers in the same cycle
///
///     int SendGroup(int Count, const struct FingerCommand *Commands);
///
///   Count      number of commands, 0 to 3
///   Commands   Commands[Count]: one command for each finger of the group, in any order; set Size of
///              every command, and set members that are not used to 0
///
/// Each command has the effect of SendPos or SendTip, SendKx and SendDamping. All fingers of the group
/// follow their commands from the same cycle on, also if different threads serve them: the periods of
/// the servos are numbered for the whole hand, and the group takes effect in the same period for every
/// finger, within two periods. If the call is refused, no finger gets its command.
///
/// If a servo is so late that it skips this period, its finger follows in its next cycle. With
/// hand.clock = "board" the periods of the threads follow different clocks. Then a finger may follow
/// one period later, about once in the time in which two of the clocks differ by a period.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Commands is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; Count is not 0 to 3; no such finger; two commands for one finger, or
///            Pos and Tip for one finger; an entry is NaN or infinite
///   EDOM, ERANGE  as SendPos, SendTip, SendKx and SendDamping
///   EIO      a finger of the group is faulted
///   EBUSY    16 groups of a finger have not taken effect yet, because they are sent faster than one in
///            a period, or the servo does not run
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, two fingers close together:
///
///     double Pos1[3] = {0.0, 0.5, 0.8}, Pos2[3] = {0.0, 0.6, 0.9};
///     static struct FingerCommand Commands[2];
///
///     Commands[0].Size = Commands[1].Size = sizeof Commands[0];
///     Commands[0].Finger = 1;
///     Commands[0].Pos = Pos1;
///     Commands[1].Finger = 2;
///     Commands[1].Pos = Pos2;
///     SendGroup(2, Commands);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendGroup(Count: c_int, Commands: *const FingerCommand) -> c_int {
    guarded("SendGroup", || {
        non_null(Commands, "Commands", Wanted::Struct("FingerCommand"))?;
        // SAFETY: by the contract in the manual, `Commands` points to `Count` commands.
        let commands = unsafe { load_commands(Count, Commands) };
        default_hand::command(|hand| -> Result<(), Refusal> {
            let (commands, count) = commands?;
            Ok(hand.send_group(&commands[..count])?)
        })
    })
}

/// WaitFingers - wait until fingers have arrived or settled
///
///     int WaitFingers(int Count, const int *Fingers, int Until, double Limit);
///
///   Count     number of fingers, 0 to 3
///   Fingers   Fingers[Count]: the fingers, 1 to 3
///   Until     WAIT_ARRIVED or WAIT_SETTLED
///   Limit     longest time to wait, s
///
/// Waits until the condition holds for every finger. Returns at once if it holds already. A finger
/// that an object blocks settles without arriving. With a set point of SendTip or a group, the joint
/// angles are those that the call has computed. Other calls work meanwhile. CloseHand works too, and
/// this call is then refused.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   EFAULT   Fingers is null
///   ENODEV   no hand is open, or it was closed meanwhile
///   EINVAL   Count is not 0 to 3; no such finger; no such Until; Limit is negative or NaN
///   EIO      a finger is faulted
///   EBUSY    a finger is limp, calibrated or closed
///   ETIMEDOUT  Limit is over; HandError names a finger that has not arrived or settled
///
/// Threads: any.
///
/// Example:
///
///     int Fingers[2] = {1, 2};
///     if (WaitFingers(2, Fingers, WAIT_SETTLED, 5.0) != 0)
///         fprintf(stderr, "%s\n", HandError());
#[unsafe(no_mangle)]
pub unsafe extern "C" fn WaitFingers(Count: c_int, Fingers: *const c_int, Until: c_int, Limit: f64) -> c_int {
    delegated("WaitFingers", MEMORY_OF_THREAD, || {
        non_null(Fingers, "Fingers", Wanted::Array(FINGERS))?;
        let number = usize::try_from(Count).ok().filter(|&number| number <= FINGERS);
        let mut fingers = [0; FINGERS];
        for (place, finger) in fingers[..number.unwrap_or(0)].iter_mut().enumerate() {
            // SAFETY: by the contract in the manual, `Fingers` has `Count` entries.
            *finger = unsafe { Fingers.add(place).read_unaligned() };
        }
        Ok(move || {
            default_hand::with(|_| Ok::<_, Refusal>(()))?;
            let number = number.ok_or(hand::HandError::from(SetPointError::GroupSize(Count)))?;
            fingers[..number]
                .iter()
                .try_for_each(|&finger| default_hand::with(|hand| hand.report(finger).map(drop)))?;
            let until = match Until {
                WAIT_ARRIVED => hand::Until::Arrived,
                WAIT_SETTLED => hand::Until::Settled,
                _ => return Err(hand::HandError::from(SetPointError::NoSuchCondition(Until)).into()),
            };
            // A limit that is too long for a Duration is no limit.
            let limit = match Limit {
                limit if limit >= 0.0 => Duration::try_from_secs_f64(limit).unwrap_or(Duration::MAX),
                _ => return Err(hand::HandError::from(SetPointError::NoSuchLimit(Limit)).into()),
            };
            default_hand::wait(&fingers[..number], until, limit)
        })
    })
}

/// Copies the commands of a group, and returns them with their number.
///
/// # Safety
/// `commands` points to `count` commands, and at least to a Size. Every command has as many bytes as the Size of the
/// first one, and its pointers are null or point to their arrays.
unsafe fn load_commands(
    count: c_int,
    commands: *const FingerCommand,
) -> Result<([hand::FingerCommand; FINGERS], usize), Refusal> {
    let mut loaded = [hand::FingerCommand::default(); FINGERS];
    let number = usize::try_from(count).ok().filter(|&number| number <= FINGERS);
    let number = number.ok_or(hand::HandError::from(SetPointError::GroupSize(count)))?;
    if number == 0 {
        return Ok((loaded, 0));
    }
    // SAFETY: there is a command, so its first member exists.
    let size = unsafe { commands.cast::<c_uint>().read_unaligned() } as usize;
    let least = size_up_to!(FingerCommand, Damping: f64);
    if size < least {
        return Err(Refusal::SmallStruct { name: "Commands", size, least });
    }
    for (place, loaded) in loaded[..number].iter_mut().enumerate() {
        // SAFETY: by the contract of this function there are `number` commands of `size` bytes, and `size` is not
        // smaller than a `FingerCommand`.
        let command = unsafe { commands.byte_add(place * size).read_unaligned() };
        // SAFETY: by the contract of this function the pointers are null or point to their arrays.
        *loaded = unsafe { from_c(&command) }?;
    }
    Ok((loaded, number))
}

/// Converts a command.
///
/// # Safety
/// Every pointer is null or points to its array.
unsafe fn from_c(command: &FingerCommand) -> Result<hand::FingerCommand, Refusal> {
    let FingerCommand { Finger, Pos, Tip, Kx, Damping, .. } = *command;
    let mut converted = hand::FingerCommand::new(Finger);
    if !Pos.is_null() && !Tip.is_null() {
        return Err(hand::HandError::from(SetPointError::TwoPoses(Finger)).into());
    }
    // SAFETY: here and below, the pointer is not null, and points to its array by the contract of this function.
    if !Pos.is_null() {
        converted = converted.joints(unsafe { load::<f64, 3>(Pos, "Pos") }?);
    }
    if !Tip.is_null() {
        converted = converted.tip(unsafe { load::<f64, 3>(Tip, "Tip") }?);
    }
    if !Kx.is_null() {
        converted = converted.stiffness(unsafe { load_rows(Kx, "Kx") }?);
    }
    if Damping != 0.0 {
        converted = converted.damping(Damping);
    }
    Ok(converted)
}

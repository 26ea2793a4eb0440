//! The exported functions for reflexes. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_snake_case)]

use crate::capi::boundary::guarded;
use crate::capi::default_hand;
use crate::capi::memory::{non_null, size_up_to};
use crate::capi::refusal::{Refusal, Wanted};
use crate::finger::events::EventKind;
use crate::finger::{Condition, Reaction};
use crate::hand::{HandError, ReflexError};
use crate::model::FingerNumber;
use nalgebra::{Matrix3, Vector3};
use std::ffi::{c_double, c_int, c_uint};

/// An event of the finger: Event.
pub const WHEN_EVENT: c_int = 1;

/// An event of another finger: Event and Finger.
pub const WHEN_OTHER_FINGER: c_int = 2;

/// The force of the surroundings on the tip is above Bound, N.
pub const WHEN_FORCE_ABOVE: c_int = 3;

/// The tension of any tendon is above Bound, N.
pub const WHEN_TENSION_ABOVE: c_int = 4;

/// The tension of any tendon is below Bound, N.
pub const WHEN_TENSION_BELOW: c_int = 5;

/// The angle of Joint is above Bound, rad.
pub const WHEN_JOINT_ABOVE: c_int = 6;

/// The angle of Joint is below Bound, rad.
pub const WHEN_JOINT_BELOW: c_int = 7;

/// The board has not replied for Bound s.
pub const WHEN_LINK_LOST: c_int = 8;

/// The planner has sent no set point for Bound s.
pub const WHEN_PLANNER_SILENT: c_int = 9;

/// The finger stops with a fault.
pub const THEN_STOP: c_int = 1;

/// The finger stays where it is.
pub const THEN_HOLD: c_int = 2;

/// The tip gets the stiffness Kx.
pub const THEN_SOFTEN: c_int = 3;

/// The finger goes to Pos.
pub const THEN_RETRACT: c_int = 4;

/// The tip presses harder by Value, N, but not harder than Most, N. It needs a Kx without an eigenvalue of 0.
pub const THEN_GRIP: c_int = 5;

/// The tip gets the damping ratio Value.
pub const THEN_DAMP: c_int = 6;

/// A rule for InstallReflex. Members that its condition and its reaction do not use are ignored.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Reflex {
    /// sizeof (struct Reflex).
    pub Size: c_uint,
    /// WHEN_EVENT to WHEN_PLANNER_SILENT.
    pub Condition: c_int,
    /// EVENT_ constant for WHEN_EVENT and WHEN_OTHER_FINGER.
    pub Event: c_int,
    /// The other finger for WHEN_OTHER_FINGER.
    pub Finger: c_int,
    /// Joint, 0 to 2, for WHEN_JOINT_ABOVE and WHEN_JOINT_BELOW.
    pub Joint: c_int,
    /// THEN_STOP to THEN_DAMP.
    pub Reaction: c_int,
    /// If several rules fire in one cycle, the one with the highest priority is first; 0 to 255.
    pub Priority: c_int,
    /// Set it to 0.
    pub Reserved: c_int,
    /// N, rad or s, as the condition says.
    pub Bound: c_double,
    /// THEN_GRIP: increase of the force, N. THEN_DAMP: ratio.
    pub Value: c_double,
    /// THEN_GRIP: largest force, N.
    pub Most: c_double,
    /// Time after a reaction in which the rule does not fire again, s, 0 to 3600. 0: the rule fires again only
    /// after its condition was false.
    pub Refractory: c_double,
    /// Time after a reaction in which the finger ignores set points of the planner, s, 0 to 3600.
    pub Inhibition: c_double,
    /// THEN_RETRACT: joint angles, rad. THEN_GRIP: direction in the finger's frame in which the tip presses harder;
    /// 0, 0, 0 for the direction in which its spring presses.
    pub Pos: [c_double; 3],
    /// THEN_SOFTEN: stiffness, N/cm, row by row.
    pub Kx: [[c_double; 3]; 3],
}

/// InstallReflex - let a finger react by itself
///
///     int InstallReflex(int i, const struct Reflex *Reflex);
///
///   i        finger, 1 to 3
///   Reflex   the rule; set Reflex->Size before the call
///
/// The servo evaluates the rules of a finger in every cycle while the finger is a spring. If the
/// condition becomes true, the command changes within two cycles, or within three cycles for
/// WHEN_OTHER_FINGER. At most one rule reacts in a cycle; the others wait. Each reaction is an event
/// EVENT_REFLEX_FIRED with the number of the rule.
///
/// A reaction replaces the set point. A path ends. Set points that were sent before are discarded, and
/// later calls that change a part of a set point start from the new one. The next SendPos moves the
/// finger again; Inhibition delays that. A rule stays until RemoveReflex or CloseHand.
///
/// Returns the number of the rule, above 0, or -1 with
///   EPERM    forked child
///   EFAULT   Reflex is null
///   ENODEV   no hand is open
///   EINVAL   Size is too small; no such finger, joint, condition, reaction or event; Pos or Kx is NaN
///   ERANGE   another value is NaN or outside its range; Pos as in SendPos; Kx as in SendKx
///   EDOM     Kx as in SendKx
///   ENOSPC   the finger has 16 rules
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, a guarded move:
///
///     static struct Reflex Guard;
///
///     Guard.Size = sizeof Guard;
///     Guard.Condition = WHEN_EVENT;
///     Guard.Event = EVENT_CONTACT;
///     Guard.Reaction = THEN_HOLD;
///     if (InstallReflex(1, &Guard) < 0)
///         puts(HandError());
#[unsafe(no_mangle)]
pub unsafe extern "C" fn InstallReflex(i: c_int, Reflex: *const Reflex) -> c_int {
    let mut number = -1;
    let status = guarded("InstallReflex", || {
        non_null(Reflex, "Reflex", Wanted::Struct("Reflex"))?;
        // SAFETY: by the contract in the manual, `Reflex` points to as many bytes as its first member gives.
        let rule = unsafe { load_rule(Reflex) };
        default_hand::with(|hand| -> Result<(), Refusal> {
            number = hand.install_reflex(i, from_c(&rule?)?)? as c_int;
            Ok(())
        })
    });
    if status == 0 { number } else { status }
}

/// RemoveReflex - remove a rule
///
///     int RemoveReflex(int i, int Number);
///
///   i        finger, 1 to 3
///   Number   number of the rule, from InstallReflex; 0 for all rules of the finger
///
/// Returns 0, or -1 with
///   EPERM    forked child
///   ENODEV   no hand is open
///   EINVAL   no such finger
///   ENOENT   the finger has no rule with this number
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     RemoveReflex(1, 0);
#[unsafe(no_mangle)]
pub extern "C" fn RemoveReflex(i: c_int, Number: c_int) -> c_int {
    guarded("RemoveReflex", || {
        default_hand::with(|hand| match u32::try_from(Number) {
            Ok(0) => hand.clear_reflexes(i),
            Ok(rule) => hand.remove_reflex(i, rule),
            Err(_) => hand.remove_reflex(i, u32::MAX),
        })
    })
}

/// Copies a rule.
///
/// # Safety
/// `rule` points to as many bytes as its Size gives, and at least to a Size.
unsafe fn load_rule(rule: *const Reflex) -> Result<Reflex, Refusal> {
    // SAFETY: by the contract of this function the first member exists.
    let size = unsafe { rule.cast::<c_uint>().read_unaligned() } as usize;
    let least = size_up_to!(Reflex, Kx: [[c_double; 3]; 3]);
    if size < least {
        return Err(Refusal::SmallStruct { name: "Reflex", size, least });
    }
    // SAFETY: by the contract of this function, `rule` points to at least as many bytes as a `Reflex` has.
    Ok(unsafe { rule.read_unaligned() })
}

/// Converts a rule.
fn from_c(rule: &Reflex) -> Result<crate::finger::Reflex, HandError> {
    Ok(crate::finger::Reflex {
        condition: condition(rule)?,
        reaction: reaction(rule)?,
        priority: rule.Priority.clamp(0, 255) as u8,
        refractory: rule.Refractory,
        inhibition: rule.Inhibition,
    })
}

fn condition(rule: &Reflex) -> Result<Condition, HandError> {
    let bound = rule.Bound;
    // A negative number is no joint either.
    let joint = usize::try_from(rule.Joint).unwrap_or(usize::MAX);
    Ok(match rule.Condition {
        WHEN_EVENT => Condition::Event(event(rule.Event)?),
        WHEN_OTHER_FINGER => {
            Condition::OtherFinger { finger: FingerNumber::try_from(rule.Finger)?, event: event(rule.Event)? }
        }
        WHEN_FORCE_ABOVE => Condition::ForceAbove(bound),
        WHEN_TENSION_ABOVE => Condition::TensionAbove(bound),
        WHEN_TENSION_BELOW => Condition::TensionBelow(bound),
        WHEN_JOINT_ABOVE => Condition::JointAbove { joint, angle: bound },
        WHEN_JOINT_BELOW => Condition::JointBelow { joint, angle: bound },
        WHEN_LINK_LOST => Condition::LinkLost(bound),
        WHEN_PLANNER_SILENT => Condition::PlannerSilent(bound),
        number => return Err(ReflexError::NoSuchKind { what: "condition", number, prefix: "WHEN_" }.into()),
    })
}

fn reaction(rule: &Reflex) -> Result<Reaction, HandError> {
    Ok(match rule.Reaction {
        THEN_STOP => Reaction::Stop,
        THEN_HOLD => Reaction::Hold,
        THEN_SOFTEN => Reaction::Soften(Matrix3::from_fn(|row, column| rule.Kx[row][column])),
        THEN_RETRACT => Reaction::Retract(Vector3::from(rule.Pos)),
        THEN_GRIP => Reaction::Grip { direction: Vector3::from(rule.Pos), by: rule.Value, most: rule.Most },
        THEN_DAMP => Reaction::Damp(rule.Value),
        number => return Err(ReflexError::NoSuchKind { what: "reaction", number, prefix: "THEN_" }.into()),
    })
}

fn event(number: c_int) -> Result<EventKind, HandError> {
    let kind = u8::try_from(number).ok().and_then(EventKind::from_number);
    Ok(kind.ok_or(ReflexError::NoSuchKind { what: "event", number, prefix: "EVENT_" })?)
}

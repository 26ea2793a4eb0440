//! The exported functions for reflexes. Their doc comments are the C manual, as in `calls.rs`.

// The exported names are those of the header.
#![allow(non_camel_case_types)]

use crate::capi::boundary::guarded;
use crate::capi::hand_table;
use crate::capi::handle::{Handle, sun2xp_hand};
use crate::capi::refusal::Refusal;
use crate::capi::sized_struct::SizedStruct;
use crate::finger::events::EventKind;
use crate::finger::{Condition, Reaction};
use crate::hand::{HandError, ReflexError};
use crate::model::FingerNumber;
use nalgebra::{Matrix3, Vector3};
use std::ffi::{c_double, c_int};

/// An event of the finger occurs. The member named event gives its kind.
pub const SUN2XP_WHEN_EVENT: c_int = 1;

/// An event of another finger occurs. The member named event gives its kind, and the member named finger gives
/// the number of that finger.
pub const SUN2XP_WHEN_OTHER_FINGER: c_int = 2;

/// The force of the surroundings on the tip (the magnitude of contact_force of sun2xp_tip) is above the value in the
/// member bound, N.
pub const SUN2XP_WHEN_FORCE_ABOVE: c_int = 3;

/// The tension of any tendon is above the value in the member bound, N.
pub const SUN2XP_WHEN_TENSION_ABOVE: c_int = 4;

/// The tension of any tendon is below the value in the member bound, N.
pub const SUN2XP_WHEN_TENSION_BELOW: c_int = 5;

/// The angle of the joint with the number in the member joint is above the value in the member bound, rad.
pub const SUN2XP_WHEN_JOINT_ABOVE: c_int = 6;

/// The angle of the joint with the number in the member joint is below the value in the member bound, rad.
pub const SUN2XP_WHEN_JOINT_BELOW: c_int = 7;

/// The board has not replied for the time in the member bound, s.
pub const SUN2XP_WHEN_LINK_LOST: c_int = 8;

/// The planner has sent no set point for the time in the member bound, s.
pub const SUN2XP_WHEN_PLANNER_SILENT: c_int = 9;

/// The finger stops with a fault.
pub const SUN2XP_THEN_STOP: c_int = 1;

/// The finger stays where it is.
pub const SUN2XP_THEN_HOLD: c_int = 2;

/// The tip gets the Kx in the member stiffness, and the damping ratio 1.
pub const SUN2XP_THEN_SOFTEN: c_int = 3;

/// The finger goes to the joint angles in the member position.
pub const SUN2XP_THEN_RETRACT: c_int = 4;

/// The tip presses harder in one direction. The force of its spring in this direction rises by the amount in the
/// member value, but to at most the amount in the member largest, both in N. This needs a Kx without an
/// eigenvalue of 0.
pub const SUN2XP_THEN_GRIP: c_int = 5;

/// The tip gets the damping ratio in the member value, or the nearest admitted ratio.
pub const SUN2XP_THEN_DAMP: c_int = 6;

/// A rule for sun2xp_install_reflex. Members that its condition and its reaction do not use are ignored.
///
/// If the member refractory is 0, the rule fires again only after its condition has been false. If the
/// member refractory is above 0, the rule also fires again after this time while its condition stays true.
/// After a reaction, the finger ignores set points of the planner for the time in the member inhibition. For
/// SUN2XP_THEN_GRIP, the member position is the direction in the finger's frame in which the tip presses
/// harder; 0, 0, 0 stands for the direction in which its spring presses. If the component of the spring's
/// force in this direction is below 0.05 N, the reaction changes no set point, but a path still ends.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sun2xp_reflex {
    /// sizeof (struct sun2xp_reflex), set before the call.
    pub size: usize,
    /// SUN2XP_WHEN_EVENT to SUN2XP_WHEN_PLANNER_SILENT.
    pub condition: c_int,
    /// SUN2XP_EVENT_... for SUN2XP_WHEN_EVENT and SUN2XP_WHEN_OTHER_FINGER.
    pub event: c_int,
    /// The other finger for SUN2XP_WHEN_OTHER_FINGER.
    pub finger: c_int,
    /// Joint, 0 to 2, for SUN2XP_WHEN_JOINT_ABOVE and SUN2XP_WHEN_JOINT_BELOW.
    pub joint: c_int,
    /// SUN2XP_THEN_STOP to SUN2XP_THEN_DAMP.
    pub reaction: c_int,
    /// 0 to 255. If several rules have fired, the one with the highest priority reacts first.
    pub priority: c_int,
    /// Bound of the condition: 0 to 1000 N, -pi to pi rad, or 0 to 3600 s.
    pub bound: c_double,
    /// SUN2XP_THEN_GRIP: increase of the force, N, 0 to 1000. SUN2XP_THEN_DAMP: ratio, 0 to 10.
    pub value: c_double,
    /// SUN2XP_THEN_GRIP: largest force, N, 0 to 1000.
    pub largest: c_double,
    /// Time after a reaction in which the rule does not fire, s, 0 to 3600.
    pub refractory: c_double,
    /// Time after a reaction in which set points are ignored, s, 0 to 3600.
    pub inhibition: c_double,
    /// SUN2XP_THEN_RETRACT: joint angles, rad. SUN2XP_THEN_GRIP: direction of the force.
    pub position: [c_double; 3],
    /// SUN2XP_THEN_SOFTEN: stiffness, N/cm, row by row.
    pub stiffness: [[c_double; 3]; 3],
}

/// sun2xp_install_reflex - let a finger react by itself
///
///   finger   1 to 3
///   reflex   the rule; set reflex->size before the call
///
/// The servo evaluates the rules of a finger in every cycle while the finger is a spring. If the condition
/// becomes true, the command changes within two cycles, or within three cycles for
/// SUN2XP_WHEN_OTHER_FINGER. At most one rule reacts in a cycle; the others wait. Each reaction is an event
/// SUN2XP_EVENT_REFLEX_FIRED with the number of the rule. The servo of a built-in simulated finger, or of
/// other hardware whose member in_step of struct sun2xp_io is set, waits for every reply, so
/// SUN2XP_WHEN_LINK_LOST never becomes true for it.
///
/// A reaction replaces the set point and ends a path. Set points that were sent before are discarded, and
/// later calls that change a part of a set point start from the set point of the reaction. The next
/// sun2xp_send_position moves the finger again. The set point of the reaction expires when the one that was
/// sent last would have expired. The finger ignores a set point that is sent within the time in the member
/// inhibition. The call that sends it is not refused, and the ignored set point still restarts the time
/// after which set points expire. A rule stays until sun2xp_remove_reflex or sun2xp_close.
///
/// Returns the number of the rule, above 0, or a negative number with
///   EPERM    forked child
///   EFAULT   reflex is null
///   ENODEV   no such hand
///   EINVAL   size is too small; no such finger, joint, condition, reaction or event; with
///            SUN2XP_WHEN_OTHER_FINGER, the member finger equals the argument finger; the member position or
///            stiffness is NaN or infinite
///   ERANGE   another value is NaN or outside its range; sun2xp_send_position would refuse the member
///            position, or sun2xp_send_stiffness the member stiffness, with ERANGE
///   EDOM     sun2xp_send_stiffness would refuse the member stiffness with EDOM
///   ENOSPC   the finger has 16 rules
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example, a guarded move:
///
///     static struct sun2xp_reflex guard;
///
///     guard.size = sizeof guard;
///     guard.condition = SUN2XP_WHEN_EVENT;
///     guard.event = SUN2XP_EVENT_CONTACT;
///     guard.reaction = SUN2XP_THEN_HOLD;
///     if (sun2xp_install_reflex(hand, 1, &guard) < 0)
///         puts(sun2xp_error_text(hand));
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sun2xp_install_reflex(
    hand: *mut sun2xp_hand,
    finger: c_int,
    reflex: *const sun2xp_reflex,
) -> c_int {
    let hand = Handle::of(hand);
    let mut number = -1;
    let status = guarded("sun2xp_install_reflex", hand, || {
        // SAFETY: by the contract in the manual, `reflex` is null or points to as many bytes as its first member gives.
        let rule = unsafe { SizedStruct::new(reflex, "reflex") }?;
        hand_table::command(hand, |hand| -> Result<(), Refusal> {
            rule.check()?;
            // SAFETY: the size is right, as checked above, and there is a first struct.
            let rule = unsafe { rule.load(0) };
            number = hand.install_reflex_with(finger, from_c(finger, &rule)?, rule.priority)? as c_int;
            Ok(())
        })
    });
    if status == 0 { number } else { status }
}

/// sun2xp_remove_reflex - remove a rule
///
///   finger   1 to 3
///   number   number of the rule, from sun2xp_install_reflex; 0 for all rules of the finger
///
/// Returns 0, or a negative number with
///   EPERM    forked child
///   ENODEV   no such hand
///   EINVAL   no such finger
///   ENOENT   the finger has no rule with this number
///
/// Threads: any. Never waits for a servo. Takes a few us.
///
/// Example:
///
///     sun2xp_remove_reflex(hand, 1, 0);
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_remove_reflex(hand: *mut sun2xp_hand, finger: c_int, number: c_int) -> c_int {
    let hand = Handle::of(hand);
    guarded("sun2xp_remove_reflex", hand, || {
        hand_table::with(hand, |hand| match u32::try_from(number) {
            Ok(0) => hand.clear_reflexes(finger),
            Ok(rule) => hand.remove_reflex(finger, rule),
            Err(_) => hand.remove_reflex(finger, u32::MAX),
        })
    })
}

/// Converts a rule for a finger, except its priority.
fn from_c(finger: c_int, rule: &sun2xp_reflex) -> Result<crate::finger::Reflex, HandError> {
    Ok(crate::finger::Reflex {
        condition: condition(FingerNumber::try_from(finger)?, rule)?,
        reaction: reaction(rule)?,
        priority: 0,
        refractory: rule.refractory,
        inhibition: rule.inhibition,
    })
}

fn condition(finger: FingerNumber, rule: &sun2xp_reflex) -> Result<Condition, HandError> {
    let bound = rule.bound;
    let joint = || {
        let refused = ReflexError::NoSuchJoint { finger, joint: rule.joint.into() };
        usize::try_from(rule.joint).map_err(|_| refused)
    };
    Ok(match rule.condition {
        SUN2XP_WHEN_EVENT => Condition::Event(event(rule.event)?),
        SUN2XP_WHEN_OTHER_FINGER => {
            Condition::OtherFinger { finger: FingerNumber::try_from(rule.finger)?, event: event(rule.event)? }
        }
        SUN2XP_WHEN_FORCE_ABOVE => Condition::ForceAbove(bound),
        SUN2XP_WHEN_TENSION_ABOVE => Condition::TensionAbove(bound),
        SUN2XP_WHEN_TENSION_BELOW => Condition::TensionBelow(bound),
        SUN2XP_WHEN_JOINT_ABOVE => Condition::JointAbove { joint: joint()?, angle: bound },
        SUN2XP_WHEN_JOINT_BELOW => Condition::JointBelow { joint: joint()?, angle: bound },
        SUN2XP_WHEN_LINK_LOST => Condition::LinkLost(bound),
        SUN2XP_WHEN_PLANNER_SILENT => Condition::PlannerSilent(bound),
        number => return Err(ReflexError::NoSuchKind { what: "condition", number, prefix: "SUN2XP_WHEN_" }.into()),
    })
}

fn reaction(rule: &sun2xp_reflex) -> Result<Reaction, HandError> {
    Ok(match rule.reaction {
        SUN2XP_THEN_STOP => Reaction::Stop,
        SUN2XP_THEN_HOLD => Reaction::Hold,
        SUN2XP_THEN_SOFTEN => Reaction::Soften(Matrix3::from_fn(|row, column| rule.stiffness[row][column])),
        SUN2XP_THEN_RETRACT => Reaction::Retract(Vector3::from(rule.position)),
        SUN2XP_THEN_GRIP => {
            Reaction::Grip { direction: Vector3::from(rule.position), by: rule.value, most: rule.largest }
        }
        SUN2XP_THEN_DAMP => Reaction::Damp(rule.value),
        number => return Err(ReflexError::NoSuchKind { what: "reaction", number, prefix: "SUN2XP_THEN_" }.into()),
    })
}

fn event(number: c_int) -> Result<EventKind, HandError> {
    let kind = u8::try_from(number).ok().and_then(EventKind::from_number);
    Ok(kind.ok_or(ReflexError::NoSuchKind { what: "event", number, prefix: "SUN2XP_EVENT_" })?)
}

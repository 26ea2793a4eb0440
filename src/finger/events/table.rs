//! The table of all kinds of events. The constants of the C header and the table in `docs/events.md` are generated from
//! it.
//!
//! Numbers are permanent: a new kind gets the next free number.

use super::kind::{Description, ValueKind};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

macro_rules! kinds {
    ($($number:literal $kind:ident $constant:literal $part:expr, [$($value:ident),*],
        $name:literal, $text:literal;)*) => {
        /// The kind of an event.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u8)]
        #[non_exhaustive]
        pub enum EventKind {
            $(#[doc = concat!($name, ": ", $text, ".")] $kind = $number,)*
        }

        impl EventKind {
            /// All kinds, in the order of their numbers.
            pub const ALL: &[EventKind] = &[$(EventKind::$kind,)*];

            /// Returns the row of the table for this kind.
            #[must_use]
            pub fn description(self) -> &'static Description {
                match self {
                    $(EventKind::$kind => &Description {
                        constant: $constant,
                        name: $name,
                        text: $text,
                        part: $part,
                        values: &[$(ValueKind::$value),*],
                    },)*
                }
            }
        }
    };
}

kinds! {
    1 TouchMade "TOUCH_MADE" None, [Element, Pressure], "touch made",
        "a tactile element of the fingertip begins to be pressed";
    2 TouchLost "TOUCH_LOST" None, [Element, Pressure], "touch lost",
        "a tactile element of the fingertip is no longer pressed";
    3 TouchSlip "TOUCH_SLIP" None, [Element, Pressure], "touch slips",
        "the object that presses a tactile element slips";
    4 TouchPressure "TOUCH_PRESSURE" None, [Element, Pressure], "touch pressure",
        "the force on a tactile element has changed";
    5 Contact "CONTACT" None, [Force], "contact",
        "the fingertip touches something";
    6 ContactLost "CONTACT_LOST" None, [Force], "contact lost",
        "the fingertip no longer touches anything";
    7 Slip "SLIP" None, [Force], "slip",
        "the force at the fingertip along the surface rises above finger.events.slip_friction times the force normal \
         to it: the contact is about to slip";
    8 TensionBound "TENSION_BOUND" Some("tendon"), [Tension, Bound], "tension bound",
        "the tension of a tendon rises above finger.events.tension_above or falls below finger.events.tension_below";
    9 ForceBound "FORCE_BOUND" None, [Force, Bound], "force bound",
        "the force at the fingertip rises above finger.events.force_above";
    10 JointAtLimit "JOINT_AT_LIMIT" Some("joint"), [Angle, Limit], "joint at limit",
        "a joint comes within finger.events.limit_margin_degrees of its limit";
    11 Arrived "ARRIVED" None, [Joints], "arrived",
        "every joint is within finger.events.arrived_degrees of the set point for the first time after a change of the \
         set point";
    12 Settled "SETTLED" None, [Joints], "settled",
        "for the first time after a change of the set point, no joint has moved by more than \
         finger.events.settled_degrees during finger.events.settled_ms";
    13 Fault "FAULT" Some("part of the fault"), [FaultNumber, FaultValue], "fault",
        "a fault has stopped the finger";
    14 Warning "WARNING" Some("part of the warning"), [FaultNumber, FaultValue], "warning",
        "the finger has a warning; a warning that persists is one event";
    15 ReflexFired "REFLEX_FIRED" None, [Rule], "reflex fired",
        "the condition of a reflex was true, and the finger reacts";
    16 PathEnded "PATH_ENDED" None, [Joints], "path ended",
        "the finger has followed its path to the end";
    17 Expired "EXPIRED" None, [Age], "set point expired",
        "the planner has not replaced a set point within the time for which it was valid";
    18 TouchInvalid "TOUCH_INVALID" None, [Element], "touch invalid",
        "a tactile element of the fingertip cannot be read";
}

impl EventKind {
    /// Returns the number of the kind, counted from 1. It is the same in every version of this library.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8
    }

    /// Returns the kind with this number.
    #[must_use]
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.number() == number)
    }
}

impl Serialize for EventKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.number())
    }
}

impl<'de> Deserialize<'de> for EventKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = u8::deserialize(deserializer)?;
        Self::from_number(number).ok_or_else(|| D::Error::custom(format!("no kind of event has the number {number}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_consecutive_and_every_kind_has_one_to_four_values() {
        for (index, &kind) in EventKind::ALL.iter().enumerate() {
            assert_eq!(usize::from(kind.number()), index + 1);
            assert_eq!(EventKind::from_number(kind.number()), Some(kind));
            let places: usize = kind.description().values.iter().map(|value| value.places()).sum();
            assert!((1..=4).contains(&places), "{kind:?}");
        }
        assert_eq!((EventKind::from_number(0), EventKind::from_number(200)), (None, None));
    }
}

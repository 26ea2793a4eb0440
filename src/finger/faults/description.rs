//! The fields of the fault table.

use super::action::Action;
use std::fmt::{self, Display, Formatter};

/// The effect of a fault on the finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Severity {
    /// The finger continues, and the planner can read the warning.
    Warning,
    /// The motors go to the configured end state, and calls for the finger are refused.
    Fault,
    /// The hand does not open, or a call is refused. No running finger stops.
    Refusal,
}

/// The meaning of a fault's part number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PartKind {
    /// The whole finger. The number of the part is 0.
    Finger,
    /// Joints 0 to 2.
    Joint,
    /// Tendons 1 to 4.
    Tendon,
    /// Motors 1 to 4.
    Motor,
    /// Strain gauges 1 to 4.
    Gauge,
    /// Motor encoders 1 to 4.
    Encoder,
}

/// The meaning of a fault's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// The fault has no value. Its field `value` is 0.
    Nothing,
    /// Tension, N.
    Tension,
    /// Time, ms.
    Time,
    /// Angle, degrees.
    Angle,
    /// Counts of a sensor.
    Counts,
    /// Share, per cent.
    Share,
    /// The errno of the system.
    Errno,
    /// The status bits of a reply.
    Status,
    /// Reason of a Refused frame, as its number on the wire.
    Reason,
}

/// The row of the fault table for one kind of fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Description {
    /// The part of the name in the C header that follows `FAULT_`.
    pub constant: &'static str,
    /// The effect on the finger.
    pub severity: Severity,
    /// The meaning of the part number.
    pub part: PartKind,
    /// The meaning of the value.
    pub quantity: Quantity,
    /// A short name.
    pub name: &'static str,
    /// What has happened.
    pub text: &'static str,
    /// The most frequent cause.
    pub cause: &'static str,
    /// What the user should do.
    pub remedy: &'static str,
    /// The operations of the library that the remedy names, in the order of their use.
    pub actions: &'static [Action],
}

impl Description {
    /// Returns sentences that state what has happened, the likely cause and the remedy. The last sentence has no full
    /// stop.
    pub fn explanation(&self) -> impl Display {
        Explanation(*self)
    }
}

/// Formats the sentences without an allocation.
struct Explanation(Description);

impl Display for Explanation {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Description { text, cause, remedy, .. } = self.0;
        write!(formatter, "{text}. Likely cause: {cause}. {remedy}")
    }
}

impl PartKind {
    /// Returns the noun for one part of this kind, for use in a sentence; none for the whole finger.
    pub fn word(self) -> Option<&'static str> {
        match self {
            PartKind::Finger => None,
            PartKind::Joint => Some("joint"),
            PartKind::Tendon => Some("tendon"),
            PartKind::Motor => Some("motor"),
            PartKind::Gauge => Some("gauge"),
            PartKind::Encoder => Some("encoder"),
        }
    }
}

impl Quantity {
    /// Returns the unit or the kind of the value for use in a table; none if there is no value.
    #[must_use]
    pub fn words(self) -> Option<&'static str> {
        match self {
            Quantity::Nothing => None,
            Quantity::Tension => Some("N"),
            Quantity::Time => Some("ms"),
            Quantity::Angle => Some("degrees"),
            Quantity::Counts => Some("counts"),
            Quantity::Share => Some("%"),
            Quantity::Errno => Some("errno"),
            Quantity::Status => Some("status bits"),
            Quantity::Reason => Some("reason of the Refused frame"),
        }
    }
}

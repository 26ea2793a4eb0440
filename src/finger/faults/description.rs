//! What the table of faults says about each kind of fault.

use std::fmt::{self, Display, Formatter};

/// What becomes of the finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The finger is told so and goes on.
    Warning,
    /// The motors go to the configured end state, and the finger's calls are refused.
    Fault,
    /// The hand does not open, or a call is refused; no finger runs that could stop.
    Refusal,
}

/// What the number of a part counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// The whole finger; the number is 0.
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

/// What the value of a fault measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Nothing; the value is 0.
    Nothing,
    /// N.
    Tension,
    /// ms.
    Time,
    /// Degrees.
    Angle,
    /// Counts of a sensor.
    Counts,
    /// Per cent.
    Share,
    /// errno of the system.
    Errno,
    /// Status bits of a reply.
    Status,
    /// The reason of a Refused frame, its number on the wire.
    Reason,
}

/// What stands about a fault in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// As in the C header, without `FAULT_`.
    pub constant: &'static str,
    /// What becomes of the finger.
    pub severity: Severity,
    /// What the number of the part counts.
    pub part: PartKind,
    /// What the value measures.
    pub quantity: Quantity,
    /// A name of few words.
    pub name: &'static str,
    /// What is the case.
    pub text: &'static str,
    /// What is most often the reason.
    pub cause: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

impl Description {
    /// What is the case, its likely cause and the remedy, in sentences of which the last has no full stop.
    pub fn explanation(&self) -> impl Display {
        Explanation(*self)
    }
}

/// Written where it is needed, without a copy.
struct Explanation(Description);

impl Display for Explanation {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Description { text, cause, remedy, .. } = self.0;
        write!(formatter, "{text}. Likely cause: {cause}. {remedy}")
    }
}

impl PartKind {
    /// The singular, as in a sentence; none for the whole finger.
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
    /// The quantity with its unit, as in a table; none where there is no value.
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

//! The fields of the table of events.

/// A row of the table of events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Description {
    /// Name of the constant in the C header, after `EVENT_`.
    pub constant: &'static str,
    /// Name for users.
    pub name: &'static str,
    /// What happens.
    pub text: &'static str,
    /// Part that the event concerns, as a word for a table; none if it concerns the whole finger.
    pub part: Option<&'static str>,
    /// The meanings of the event's values, in their order. Unused values have no entry.
    pub values: &'static [ValueKind],
}

/// The meaning of a value of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ValueKind {
    /// The three components of the force of the tip on its surroundings, in the finger's frame, N: three values.
    Force,
    /// The angles of joints 0, 1 and 2, rad: three values.
    Joints,
    /// The angle of the joint, rad.
    Angle,
    /// The limit of the joint, rad.
    Limit,
    /// The tension of the tendon, N.
    Tension,
    /// The bound that was crossed, N.
    Bound,
    /// The number of a fault or a warning, as in docs/faults.md.
    FaultNumber,
    /// The value of a fault or a warning, as in docs/faults.md.
    FaultValue,
    /// The number of the tactile element.
    Element,
    /// The pressure force on the tactile element, N.
    Pressure,
    /// The number of the rule.
    Rule,
    /// The time since the planner last sent a command or renewed the validity of its set point, ms.
    Age,
}

impl ValueKind {
    /// Returns the meaning with its unit, for a table.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            ValueKind::Force => "force x, y, z of the tip on its surroundings in the finger's frame, N",
            ValueKind::Joints => "angles of joints 0, 1, 2, rad",
            ValueKind::Angle => "angle, rad",
            ValueKind::Limit => "limit, rad",
            ValueKind::Tension => "tension, N",
            ValueKind::Bound => "bound, N",
            ValueKind::FaultNumber => "number of the fault (faults.md)",
            ValueKind::FaultValue => "value of the fault (faults.md)",
            ValueKind::Element => "number of the element",
            ValueKind::Pressure => "force on the element, N",
            ValueKind::Rule => "number of the rule",
            ValueKind::Age => "time since the planner last sent a command or renewed the validity of its set point, ms",
        }
    }

    /// Returns how many of the event's values have this meaning.
    #[must_use]
    pub fn places(self) -> usize {
        match self {
            ValueKind::Force | ValueKind::Joints => 3,
            _ => 1,
        }
    }
}

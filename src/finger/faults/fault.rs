//! A fault that occurred: its kind, its place and its value.

use super::{FaultKind, Quantity};
use crate::model::Part;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::fmt;

/// The reason why a finger stopped, or a warning.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Fault {
    /// Kind of the fault.
    pub kind: FaultKind,
    /// Place of the fault.
    pub part: Part,
    /// Value in the unit of the kind's quantity; 0 if there is none.
    pub value: f64,
}

impl Fault {
    /// Returns a fault of the whole finger, without a value.
    #[must_use]
    pub fn new(kind: FaultKind) -> Self {
        Self { kind, part: Part::Finger, value: 0.0 }
    }

    /// Returns a fault of the whole finger, with a value.
    #[must_use]
    pub fn of(kind: FaultKind, value: f64) -> Self {
        Self { kind, part: Part::Finger, value }
    }
}

/// Writes name, place and value, then what has happened, cause and remedy.
impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let description = self.kind.description();
        write!(f, "{}", description.name)?;
        if self.part != Part::Finger {
            write!(f, ", {}", self.part)?;
        }
        match description.quantity {
            Quantity::Nothing => {}
            Quantity::Errno => write!(f, " (errno {})", self.value)?,
            Quantity::Status => write!(f, " (status bits {:#06x})", self.value as u16)?,
            Quantity::Reason => write!(f, " (reason {})", self.value)?,
            Quantity::Tension | Quantity::Angle => write!(f, " ({:.1} {})", self.value, unit(description.quantity))?,
            Quantity::Time | Quantity::Counts | Quantity::Share => {
                write!(f, " ({:.0} {})", self.value, unit(description.quantity))?
            }
        }
        write!(f, ": {}", description.explanation())
    }
}

impl Error for Fault {}

fn unit(quantity: Quantity) -> &'static str {
    quantity.words().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_has_name_part_value_cause_and_remedy() {
        let text = Fault { kind: FaultKind::BrokenTendon, part: Part::Tendon(3), value: 0.04 }.to_string();
        assert!(text.starts_with("broken tendon, tendon 3 (0.0 N): "), "{text}");
        assert!(text.contains(". Likely cause: "), "{text}");
        let text = Fault { kind: FaultKind::ImpossiblePose, part: Part::Joint(0), value: -170.26 }.to_string();
        assert!(text.starts_with("impossible pose, joint 0 (-170.3 degrees): "), "{text}");
        let text = Fault::of(FaultKind::BoardStopped, 72.0).to_string();
        assert!(text.starts_with("board stopped (status bits 0x0048): "), "{text}");
        assert!(Fault::new(FaultKind::ServoPanic).to_string().starts_with("servo failed: "));
    }
}

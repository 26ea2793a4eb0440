use super::fields::{FieldReader, FieldWriter};
use super::status::Status;
use crate::model::Counted;
use std::fmt;

/// Board to host: the board received a valid frame and did not act on it.
///
/// | byte | field |
/// |---|---|
/// | 2 | type of the refused frame |
/// | 3 | reason |
/// | 4..6 | detail, see [`Reason`] |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused {
    /// Type of the refused frame, 0 to 7.
    pub request: u8,
    /// Why the board refused.
    pub reason: Reason,
    /// The detail, whose meaning depends on the reason.
    pub detail: u16,
}

/// Why a board refuses a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// 1: there is no common protocol version. Detail: the board's lowest version in the low byte, its highest in the
    /// high byte.
    Version,
    /// 2: the board cannot carry out the value of a field. Detail: offset of the first such field; the header byte has
    /// the offset 0.
    Value,
    /// 3: a Command arrived before any Configure. The board was just switched on, or lost its power.
    NotConfigured,
    /// 4: a Configure arrived while the motors follow Commands. Send a Stop first, or wait for the watchdog.
    Running,
    /// 5: a Configure arrived while a fault is present. Detail: the status bits of the faults.
    Fault,
    /// 6: the board does not know the frame type or the length. Detail: the length of the body.
    UnknownFrame,
    /// A reason of a later version.
    Other(u8),
}

impl Refused {
    pub(super) const LENGTH: usize = 4;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self { request: fields.u8(), reason: Reason::from_number(fields.u8()), detail: fields.u16() }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.request);
        fields.u8(self.reason.number());
        fields.u16(self.detail);
    }
}

impl Reason {
    fn from_number(number: u8) -> Self {
        match number {
            1 => Reason::Version,
            2 => Reason::Value,
            3 => Reason::NotConfigured,
            4 => Reason::Running,
            5 => Reason::Fault,
            6 => Reason::UnknownFrame,
            other => Reason::Other(other),
        }
    }

    /// Returns the number on the wire.
    pub fn number(self) -> u8 {
        match self {
            Reason::Version => 1,
            Reason::Value => 2,
            Reason::NotConfigured => 3,
            Reason::Running => 4,
            Reason::Fault => 5,
            Reason::UnknownFrame => 6,
            Reason::Other(number) => number,
        }
    }
}

/// The faults with which a board refuses a Configure, each with its cause and remedy.
const REMEDIES: [(Status, &str); 6] = [
    (Status::EMERGENCY_STOP, "the emergency stop is active, so release it"),
    (Status::SUPPLY_FAULT, "the motor supply is missing or out of range, so check it"),
    (Status::DRIVER_FAULT, "a motor driver reports a fault, so check the motors and their wires"),
    (Status::SENSOR_FAULT, "an encoder or a gauge cannot be read, so check its cable"),
    // Only hardware that the program provides refuses with these two bits.
    (
        Status::WATCHDOG_TRIPPED,
        "its watchdog has tripped, so correct the program's function \"start\", which must reset it",
    ),
    (Status::ENDED, "it is still in its end state, so correct the program's function \"start\", which must leave it"),
];

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (request, detail) = (self.request, self.detail);
        match self.reason {
            Reason::Version => write!(
                f,
                "it supports protocol versions {} to {}. Update the older of board and library",
                detail & 0xFF,
                detail >> 8
            ),
            Reason::Value => write!(
                f,
                "it does not accept the value at byte {detail} of frame type {request} (docs/board-protocol.md). \
                 Change the key that this value comes from, or update its firmware"
            ),
            Reason::NotConfigured => write!(f, "it is not configured, because it has restarted. Check its power"),
            Reason::Running => write!(f, "its motors follow the commands of another program. End that program"),
            Reason::Fault => {
                let present = Status(detail);
                let known = REMEDIES.iter().filter(|(fault, _)| present.has(*fault)).map(|(_, remedy)| *remedy);
                let remedies = known.collect::<Vec<_>>().join("; ");
                let unknown = "this library does not know the fault, so see the manual of the board";
                let advice = if remedies.is_empty() { unknown } else { &remedies };
                write!(f, "it reports a fault (status bits {detail:#06x}): {advice}")
            }
            Reason::UnknownFrame => {
                let bytes = Counted(detail.into(), "byte", "bytes");
                write!(f, "it does not support frame type {request} with {bytes}. Update its firmware")
            }
            Reason::Other(number) => {
                write!(f, "it gives the reason number {number}, which is unknown to this library. Update the library")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_faults_that_prevent_a_configuration_are_named_with_their_remedies() {
        let text = |detail| Refused { request: 0x2, reason: Reason::Fault, detail }.to_string();
        assert_eq!(
            text(0x00C0),
            "it reports a fault (status bits 0x00c0): the emergency stop is active, so release it; the motor supply \
             is missing or out of range, so check it"
        );
        for (fault, remedy) in REMEDIES {
            assert!(text(fault.0).ends_with(remedy), "{}", text(fault.0));
        }
        assert!(text(0x1000).ends_with("so see the manual of the board"), "{}", text(0x1000));
    }
}

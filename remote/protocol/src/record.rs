//! One cycle of one finger in a State.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, finite};
use crate::{Finger, Stage};

/// One cycle of one finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// The finger.
    pub finger: Finger,
    /// Its stage, with the fault.
    pub stage: Stage,
    /// The command number that the server applied last; 0 if none in this epoch.
    pub command: u32,
    /// The number of the cycle, counted since the server opened the hand.
    pub cycle: u64,
    /// The beginning of the cycle, ns, server's clock.
    pub begin: u64,
    /// Whether the finger touches something.
    pub touching: bool,
    /// Whether the finger is caught: the validity of the newest Target has ended, so the finger holds its pose.
    pub caught: bool,
    /// Whether the finger has arrived where the owner wants it. Only an arrival after the server applied `command`
    /// counts.
    pub arrived: bool,
    /// Whether the joints have come to rest since the server applied `command`.
    pub settled: bool,
    /// Measured joint angles, rad.
    pub joints: [f64; 3],
    /// Joint angles of the set point, rad; none if the finger does not follow set points.
    pub set_point: Option<[f64; 3]>,
    /// Position of the tip in the finger's frame, cm.
    pub tip: [f64; 3],
    /// Force of the tip on what it touches, in the finger's frame, N. It includes the effects of friction, weight and
    /// inertia of the finger.
    pub force: [f64; 3],
    /// Tendon tensions, N.
    pub tensions: [f64; 4],
}

const TOUCHING: u8 = 1;
const CAUGHT: u8 = 2;
const ARRIVED: u8 = 4;
const SETTLED: u8 = 8;

impl Record {
    /// Bytes of a record.
    pub(crate) const LENGTH: usize = 160;

    pub(crate) fn decode(bytes: Bytes<'_>) -> Result<Self, FieldError> {
        let bits = bytes.u8(24);
        if bits & !(TOUCHING | CAUGHT | ARRIVED | SETTLED) != 0 {
            return Err(FieldError::new("bits", Reason::Bits(bits)));
        }
        let set_point = bytes.f64s::<3>(56);
        let record = Self {
            finger: Finger::decode(bytes.u8(0))?,
            stage: Stage::decode(bytes.u8(1), bytes.u16(2))?,
            command: bytes.u32(4),
            cycle: bytes.u64(8),
            begin: bytes.u64(16),
            touching: bits & TOUCHING != 0,
            caught: bits & CAUGHT != 0,
            arrived: bits & ARRIVED != 0,
            settled: bits & SETTLED != 0,
            joints: bytes.f64s(32),
            set_point: (!set_point.iter().all(|angle| angle.is_nan())).then_some(set_point),
            tip: bytes.f64s(80),
            force: bytes.f64s(104),
            tensions: bytes.f64s(128),
        };
        record.check()?;
        Ok(record)
    }

    pub(crate) fn check(&self) -> Result<(), FieldError> {
        self.stage.check()?;
        finite("joint angles", &self.joints)?;
        finite("joint angles of the set point", self.set_point.as_ref().map_or(&[][..], |angles| angles))?;
        finite("position of the tip", &self.tip)?;
        finite("force of the tip", &self.force)?;
        finite("tendon tensions", &self.tensions)
    }

    pub(crate) fn encode(&self, to: &mut Written) {
        let (stage, fault) = self.stage.numbers();
        let bits = [(self.touching, TOUCHING), (self.caught, CAUGHT), (self.arrived, ARRIVED), (self.settled, SETTLED)];
        let bits = bits.iter().filter(|(set, _)| *set).fold(0, |bits, (_, bit)| bits | bit);
        to.u8(self.finger.number()).u8(stage).u16(fault).u32(self.command);
        to.u64(self.cycle).u64(self.begin).u8(bits).zeros(7);
        to.f64s(&self.joints).f64s(&self.set_point.unwrap_or([f64::NAN; 3]));
        to.f64s(&self.tip).f64s(&self.force).f64s(&self.tensions);
    }
}

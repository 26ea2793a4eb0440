use super::fields::{FieldReader, FieldWriter};
use super::{Kind, Malformed, Status};
use crate::model::configuration::EndState;

/// Host to board: the terms under which the motors may move.
///
/// | byte | field |
/// |---|---|
/// | 2 | protocol version, from the Identity |
/// | 3..5 | watchdog, ms |
/// | 5 | end state: 0 release, 1 hold |
/// | 6..8 | hold time, ms |
/// | 8..10 | hold torque limit, torque units |
/// | 10..18 | torque limits of motors 1 to 4, u16 each, torque units |
/// | 18..34 | torque constants of motors 1 to 4, u32 each, uN m/A |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configure {
    /// Protocol version, as in the Identity.
    pub version: u8,
    /// Silence after which the board enters its end state, ms.
    pub watchdog_ms: u16,
    /// What the board does when commands stop.
    pub end_state: EndState,
    /// Duration of *hold*, ms.
    pub hold_time_ms: u16,
    /// The largest torque that *hold* keeps, torque units.
    pub hold_torque_limit: u16,
    /// The largest torque of each motor, torque units.
    pub torque_limits: [u16; 4],
    /// Torque constant of each motor, uN m/A; 0: the board uses its own.
    pub torque_constants: [u32; 4],
}

/// Board to host: confirms the terms, and gives the full encoder counts.
///
/// | byte | field |
/// |---|---|
/// | 2..34 | the Configure's body |
/// | 34..50 | full counts of encoders 1 to 4, i32 each |
/// | 50..58 | counts of gauges 1 to 4, u16 each |
/// | 58..60 | status |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configured {
    /// The terms as received.
    pub terms: Configure,
    /// Full 32-bit encoder counts. A Reply carries their low 16 bits.
    pub encoders: [i32; 4],
    /// Gauge counts.
    pub gauges: [u16; 4],
    /// Status of the finger.
    pub status: Status,
}

/// Offset of the end state in a Configure and in a Configured, bytes from the beginning of the header.
const END_STATE_OFFSET: u8 = 5;

impl Configure {
    pub(super) const LENGTH: usize = 32;

    pub(super) fn read(fields: &mut FieldReader, kind: Kind) -> Result<Self, Malformed> {
        Ok(Self {
            version: fields.u8(),
            watchdog_ms: fields.u16(),
            end_state: match fields.u8() {
                0 => EndState::Release,
                1 => EndState::Hold,
                _ => return Err(Malformed::Value { kind, offset: END_STATE_OFFSET }),
            },
            hold_time_ms: fields.u16(),
            hold_torque_limit: fields.u16(),
            torque_limits: fields.four(FieldReader::u16),
            torque_constants: fields.four(FieldReader::u32),
        })
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.version);
        fields.u16(self.watchdog_ms);
        fields.u8(match self.end_state {
            EndState::Release => 0,
            EndState::Hold => 1,
        });
        fields.u16(self.hold_time_ms);
        fields.u16(self.hold_torque_limit);
        self.torque_limits.into_iter().for_each(|limit| fields.u16(limit));
        self.torque_constants.into_iter().for_each(|constant| fields.u32(constant));
    }
}

impl Configured {
    pub(super) const LENGTH: usize = Configure::LENGTH + 26;

    pub(super) fn read(fields: &mut FieldReader) -> Result<Self, Malformed> {
        Ok(Self {
            terms: Configure::read(fields, Kind::Configured)?,
            encoders: fields.four(FieldReader::i32),
            gauges: fields.four(FieldReader::u16),
            status: Status(fields.u16()),
        })
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        self.terms.write(fields);
        self.encoders.into_iter().for_each(|count| fields.i32(count));
        self.gauges.into_iter().for_each(|count| fields.u16(count));
        fields.u16(self.status.0);
    }
}

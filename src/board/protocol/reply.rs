use super::Status;
use super::fields::{FieldReader, FieldWriter};

/// Board to host, one for each Command: what the sensors measured when the last byte of the Command arrived.
///
/// | byte | field |
/// |---|---|
/// | 2..4 | status |
/// | 4..12 | low 16 bits of the counts of encoders 1 to 4 |
/// | 12..20 | counts of gauges 1 to 4, u16 each |
/// | 20..22 | time of sampling, us modulo 65536 |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// Status of the finger after the Command.
    pub status: Status,
    /// Encoder counts modulo 65536. [`Configured`](super::Configured) gives the full counts.
    pub encoders: [u16; 4],
    /// Gauge counts.
    pub gauges: [u16; 4],
    /// The board's clock at the instant of sampling, us modulo 65536.
    pub sampled_at: u16,
}

impl Reply {
    pub(super) const LENGTH: usize = 20;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self {
            status: Status(fields.u16()),
            encoders: fields.four(FieldReader::u16),
            gauges: fields.four(FieldReader::u16),
            sampled_at: fields.u16(),
        }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u16(self.status.0);
        self.encoders.into_iter().for_each(|count| fields.u16(count));
        self.gauges.into_iter().for_each(|count| fields.u16(count));
        fields.u16(self.sampled_at);
    }

    /// Computes the full encoder counts from those of the previous reply. The result is correct if no encoder moved by
    /// 32768 counts or more in between.
    pub fn counts_after(&self, before: [i32; 4]) -> [i32; 4] {
        std::array::from_fn(|motor| {
            let moved = self.encoders[motor].wrapping_sub(before[motor] as u16) as i16;
            before[motor].wrapping_add(i32::from(moved))
        })
    }
}

use super::Status;
use super::fields::{FieldReader, FieldWriter};

/// Host to board: enter the end state now. A Stop has no body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stop;

/// Board to host: the answer to a Stop.
///
/// | byte | field |
/// |---|---|
/// | 2..4 | status |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stopped {
    /// Status after the Stop.
    pub status: Status,
}

impl Stop {
    pub(super) const LENGTH: usize = 0;
}

impl Stopped {
    pub(super) const LENGTH: usize = 2;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self { status: Status(fields.u16()) }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u16(self.status.0);
    }
}

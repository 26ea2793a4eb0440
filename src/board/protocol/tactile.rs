use super::fields::{FieldReader, FieldWriter};

/// Host to board: asks for the next tactile event. Sent only to a board with
/// [`Capabilities::TACTILE`](super::Capabilities::TACTILE). Any other board refuses it as an unknown frame.
///
/// | byte | field |
/// |---|---|
/// | 2 | number of the last event that the host received; 0 if none |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TactileRequest {
    /// Number of the last event that the host received. The board deletes this event and those before it.
    pub received: u8,
}

/// Board to host: the oldest event that the host has not received. Sent only in answer to a [`TactileRequest`].
///
/// | byte | field |
/// |---|---|
/// | 2 | number of queued events, including this one; if 0, all fields but the last are 0 |
/// | 3 | number of this event, 1 to 255, then 1 again |
/// | 4 | what changed |
/// | 5..7 | sensor element |
/// | 7..9 | count of the element |
/// | 9..13 | time of the event, us |
/// | 13 | lost events, modulo 256 |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TactileEvent {
    /// Number of queued events, including this one.
    pub waiting: u8,
    /// Number of this event, or 0 if no event is queued.
    pub number: u8,
    /// What changed.
    pub change: TactileChange,
    /// Number of the sensor element on the finger. The board defines the order of the elements.
    pub element: u16,
    /// Raw count of the element.
    pub count: u16,
    /// The board's clock at the event, us, modulo 2^32.
    pub noticed_at: u32,
    /// Number of events since power-up that did not fit into the queue, modulo 256.
    pub lost: u8,
}

/// The kind of change that a tactile event reports.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TactileChange {
    /// 0: no event is queued.
    #[default]
    Nothing,
    /// 1: contact was made.
    Made,
    /// 2: contact was lost.
    Lost,
    /// 3: an object slips.
    Slip,
    /// 4: the count changed by the board's threshold or more.
    Pressure,
    /// 5: the element cannot be read. The count has no meaning.
    Invalid,
    /// A number that only this board or a later version defines.
    Other(u8),
}

impl TactileRequest {
    pub(super) const LENGTH: usize = 1;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self { received: fields.u8() }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.received);
    }
}

impl TactileEvent {
    pub(super) const LENGTH: usize = 12;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self {
            waiting: fields.u8(),
            number: fields.u8(),
            change: TactileChange::from_number(fields.u8()),
            element: fields.u16(),
            count: fields.u16(),
            noticed_at: fields.u32(),
            lost: fields.u8(),
        }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.waiting);
        fields.u8(self.number);
        fields.u8(self.change.number());
        fields.u16(self.element);
        fields.u16(self.count);
        fields.u32(self.noticed_at);
        fields.u8(self.lost);
    }
}

impl TactileChange {
    fn from_number(number: u8) -> Self {
        match number {
            0 => TactileChange::Nothing,
            1 => TactileChange::Made,
            2 => TactileChange::Lost,
            3 => TactileChange::Slip,
            4 => TactileChange::Pressure,
            5 => TactileChange::Invalid,
            other => TactileChange::Other(other),
        }
    }

    /// Returns the number on the wire.
    pub fn number(self) -> u8 {
        match self {
            TactileChange::Nothing => 0,
            TactileChange::Made => 1,
            TactileChange::Lost => 2,
            TactileChange::Slip => 3,
            TactileChange::Pressure => 4,
            TactileChange::Invalid => 5,
            TactileChange::Other(number) => number,
        }
    }
}

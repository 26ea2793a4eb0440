use super::fields::{FieldReader, FieldWriter};

/// Host to board: what have the tactile sensors noticed? Only to a board with
/// [`Capabilities::TACTILE`](super::Capabilities::TACTILE); any other refuses it as an unknown frame.
///
/// | byte | field |
/// |---|---|
/// | 2 | number of the last event that the host has; 0: none |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TactileRequest {
    /// The board forgets this event and those before it.
    pub received: u8,
}

/// Board to host: the oldest event that the host has not got. Sent in answer to a [`TactileRequest`] only.
///
/// | byte | field |
/// |---|---|
/// | 2 | events that wait, this one included; 0: none, and all fields but the last are 0 |
/// | 3 | number of this event, 1 to 255, and then 1 again |
/// | 4 | what changed |
/// | 5..7 | sensor element |
/// | 7..9 | its count |
/// | 9..13 | when, us |
/// | 13 | events lost, 255 at most |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TactileEvent {
    /// Events that wait, this one included.
    pub waiting: u8,
    /// Number of this event; 0 where none waits.
    pub number: u8,
    /// What happened.
    pub change: TactileChange,
    /// Which element of the finger's sensors; their order is the board's.
    pub element: u16,
    /// What the element measures now, raw.
    pub count: u16,
    /// The board's clock at the event, us; it wraps.
    pub noticed_at: u32,
    /// Events that found no room since power-up; 255: or more.
    pub lost: u8,
}

/// What a tactile event says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TactileChange {
    /// 0: no event waits.
    #[default]
    Nothing,
    /// 1: contact was made.
    Made,
    /// 2: contact was lost.
    Lost,
    /// 3: something slips.
    Slip,
    /// 4: the count changed by more than the board's threshold.
    Pressure,
    /// A number that means something to this board only, or in a later version.
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
            other => TactileChange::Other(other),
        }
    }

    /// The number on the wire.
    pub fn number(self) -> u8 {
        match self {
            TactileChange::Nothing => 0,
            TactileChange::Made => 1,
            TactileChange::Lost => 2,
            TactileChange::Slip => 3,
            TactileChange::Pressure => 4,
            TactileChange::Other(number) => number,
        }
    }
}

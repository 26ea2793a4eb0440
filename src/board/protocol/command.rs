use super::fields::{FieldReader, FieldWriter};

/// Host to board, every period: the commands for the motors.
///
/// | byte | field |
/// |---|---|
/// | 2 | flags: bit 0 toggle, bit 1 enable |
/// | 3..11 | torques of motors 1 to 4, i16 each |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Command {
    /// The handshake bit of COINS TR 90-48. The servo toggles it every cycle, and the board outputs it on a pin.
    pub toggle: bool,
    /// False: the motors are off.
    pub enable: bool,
    /// Torques of motors 1 to 4, in units of [`Identity::torque_unit`](super::Identity::torque_unit).
    pub torques: [i16; 4],
}

const TOGGLE: u8 = 1 << 0;
const ENABLE: u8 = 1 << 1;

impl Command {
    pub(super) const LENGTH: usize = 9;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        let flags = fields.u8();
        Self { toggle: flags & TOGGLE != 0, enable: flags & ENABLE != 0, torques: fields.four(FieldReader::i16) }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        let bit = |set, mask| if set { mask } else { 0 };
        fields.u8(bit(self.toggle, TOGGLE) | bit(self.enable, ENABLE));
        self.torques.into_iter().for_each(|torque| fields.i16(torque));
    }
}

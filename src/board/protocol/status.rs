use std::ops::{BitOr, BitOrAssign};

/// Status of one finger of the board. Bits 12 to 15 are reserved and sent as 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Status(pub u16);

impl Status {
    /// A Configure has been accepted since power-up or the last reset.
    pub const CONFIGURED: Status = Status(1 << 0);
    /// The motors follow the Commands.
    pub const ENABLED: Status = Status(1 << 1);
    /// The watchdog has tripped since the last Configure.
    pub const WATCHDOG_TRIPPED: Status = Status(1 << 2);
    /// The end state has been entered, for any reason, since the last Configure.
    pub const ENDED: Status = Status(1 << 3);
    /// The end state *hold* is in progress.
    pub const HOLDING: Status = Status(1 << 4);
    /// The board knows that its encoder counts are continuous with those that the host last received, even across a
    /// loss of power. The host's zero is then valid. Only a board with
    /// [`Capabilities::KEEPS_ZERO`](super::Capabilities::KEEPS_ZERO) sets this bit.
    pub const ZERO_VALID: Status = Status(1 << 5);
    /// The emergency stop input for this finger is active, or was active at some time since the last Configure.
    pub const EMERGENCY_STOP: Status = Status(1 << 6);
    /// The motor supply is missing or out of range, or was so at some time since the last Configure.
    pub const SUPPLY_FAULT: Status = Status(1 << 7);
    /// A motor driver reports a fault (over-current, over-temperature, short circuit), or has reported one since the
    /// last Configure.
    pub const DRIVER_FAULT: Status = Status(1 << 8);
    /// An encoder or gauge cannot be read, or could not be read at some time since the last Configure.
    pub const SENSOR_FAULT: Status = Status(1 << 9);
    /// At least one torque of the answered Command exceeded a limit and was clipped to it. Set only in a Reply.
    pub const TORQUE_CLIPPED: Status = Status(1 << 10);
    /// At least one damaged frame has arrived since the last Reply of this finger.
    pub const DAMAGED_INPUT: Status = Status(1 << 11);

    /// The fault bits. When one of them is set, the board takes the torque off the motors at once, whatever the end
    /// state.
    pub const FAULTS: Status =
        Status(Self::EMERGENCY_STOP.0 | Self::SUPPLY_FAULT.0 | Self::DRIVER_FAULT.0 | Self::SENSOR_FAULT.0);

    /// Returns whether any of these bits is set.
    pub fn has(self, bits: Status) -> bool {
        self.0 & bits.0 != 0
    }
}

impl BitOr for Status {
    type Output = Status;

    fn bitor(self, other: Status) -> Status {
        Status(self.0 | other.0)
    }
}

impl BitOrAssign for Status {
    fn bitor_assign(&mut self, other: Status) {
        self.0 |= other.0;
    }
}

use super::fields::{FieldReader, FieldWriter};

/// Host to board: who are you? Changes nothing on the board.
///
/// | byte | field |
/// |---|---|
/// | 2 | lowest protocol version the host speaks |
/// | 3 | highest protocol version the host speaks |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hello {
    /// Lowest protocol version the host speaks.
    pub lowest_version: u8,
    /// Highest protocol version the host speaks.
    pub highest_version: u8,
}

/// Board to host: who answers, and in which units.
///
/// | byte | field |
/// |---|---|
/// | 2 | protocol version: the highest that both speak |
/// | 3..5 | addresses on this port, bit n for address n |
/// | 5..7 | kind of board |
/// | 7..19 | unique number |
/// | 19..22 | firmware version |
/// | 22..26 | encoder counts a revolution |
/// | 26 | gauge bits |
/// | 27..31 | torque unit, nN m |
/// | 31..33 | torque limit, torque units |
/// | 33..35 | shortest watchdog, ms |
/// | 35..39 | capabilities |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The version to be spoken from now on.
    pub version: u8,
    /// Which addresses the board answers to: bit n for address n.
    pub addresses: u16,
    /// 0 unspecified, 1 the simulated board, 2 the reference firmware, from 0x8000 up free for anyone.
    pub board_kind: u16,
    /// Different for every board ever built.
    pub unique_number: [u8; 12],
    /// Version of the board's firmware.
    pub firmware: FirmwareVersion,
    /// Counts a revolution of the motors, after quadrature; 0: the board does not know.
    pub counts_per_revolution: u32,
    /// A gauge count is below 2 to the power of this; 1 to 16.
    pub gauge_bits: u8,
    /// Torque of one unit, nN m; not 0.
    pub torque_unit: u32,
    /// The largest torque that the board ever commands, torque units; at most 32767.
    pub torque_limit: u16,
    /// The shortest watchdog that it can keep, ms.
    pub shortest_watchdog_ms: u16,
    /// What it can do beyond the minimum.
    pub capabilities: Capabilities,
}

/// Major, minor, patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FirmwareVersion(pub [u8; 3]);

/// What a board can do beyond the minimum. Bits that this version does not name are sent as 0 and ignored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capabilities(pub u32);

impl Capabilities {
    /// The end state *hold*.
    pub const HOLD: Capabilities = Capabilities(1 << 0);
    /// Encoder counts survive the loss of power, or come from absolute encoders.
    pub const KEEPS_ZERO: Capabilities = Capabilities(1 << 1);
    /// It has an emergency stop input.
    pub const EMERGENCY_STOP: Capabilities = Capabilities(1 << 2);
    /// It puts the toggle bit on a pin.
    pub const TOGGLE_PIN: Capabilities = Capabilities(1 << 3);
    /// It answers tactile requests.
    pub const TACTILE: Capabilities = Capabilities(1 << 4);

    /// Whether all of these are there.
    pub fn has(self, other: Capabilities) -> bool {
        self.0 & other.0 == other.0
    }
}

impl Hello {
    pub(super) const LENGTH: usize = 2;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self { lowest_version: fields.u8(), highest_version: fields.u8() }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.lowest_version);
        fields.u8(self.highest_version);
    }
}

impl Identity {
    pub(super) const LENGTH: usize = 37;

    pub(super) fn read(fields: &mut FieldReader) -> Self {
        Self {
            version: fields.u8(),
            addresses: fields.u16(),
            board_kind: fields.u16(),
            unique_number: fields.bytes(),
            firmware: FirmwareVersion(fields.bytes()),
            counts_per_revolution: fields.u32(),
            gauge_bits: fields.u8(),
            torque_unit: fields.u32(),
            torque_limit: fields.u16(),
            shortest_watchdog_ms: fields.u16(),
            capabilities: Capabilities(fields.u32()),
        }
    }

    pub(super) fn write(&self, fields: &mut FieldWriter) {
        fields.u8(self.version);
        fields.u16(self.addresses);
        fields.u16(self.board_kind);
        fields.bytes(&self.unique_number);
        fields.bytes(&self.firmware.0);
        fields.u32(self.counts_per_revolution);
        fields.u8(self.gauge_bits);
        fields.u32(self.torque_unit);
        fields.u16(self.torque_limit);
        fields.u16(self.shortest_watchdog_ms);
        fields.u32(self.capabilities.0);
    }

    /// A torque in N cm as the board counts it, rounded toward zero: what is within a limit stays within it. The
    /// nearest count that exists for one out of range. NaN becomes 0.
    pub fn torque_count(&self, newton_centimetres: f64) -> i16 {
        let exact = newton_centimetres * NANO_PER_CENTI / f64::from(self.torque_unit);
        // `as` turns NaN into 0. -32 768 is no torque that a board has, and has no positive counterpart.
        let nearest = exact.round().clamp(-f64::from(i16::MAX), f64::from(i16::MAX)) as i16;
        match self.torque(nearest).abs() > newton_centimetres.abs() {
            true => nearest - nearest.signum(),
            false => nearest,
        }
    }

    /// A torque count in N cm.
    pub fn torque(&self, count: i16) -> f64 {
        // The product is exact; so the quotient is the number that a configuration with as many decimals means.
        f64::from(count) * f64::from(self.torque_unit) / NANO_PER_CENTI
    }
}

/// nN m in one N cm.
const NANO_PER_CENTI: f64 = 1e7;

use super::fields::{FieldReader, FieldWriter};

/// Host to board: asks for the board's identity. A Hello changes nothing on the board.
///
/// | byte | field |
/// |---|---|
/// | 2 | lowest protocol version that the host supports |
/// | 3 | highest protocol version that the host supports |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hello {
    /// Lowest protocol version that the host supports.
    pub lowest_version: u8,
    /// Highest protocol version that the host supports.
    pub highest_version: u8,
}

/// Board to host: the identity, the units and the limits of the board.
///
/// | byte | field |
/// |---|---|
/// | 2 | protocol version: the highest that both support |
/// | 3..5 | addresses on this board, bit n for address n |
/// | 5..7 | kind of board |
/// | 7..19 | unique number |
/// | 19..22 | firmware version |
/// | 22..26 | encoder counts per motor revolution |
/// | 26 | gauge bits |
/// | 27..31 | torque unit, nN m |
/// | 31..33 | torque limit, torque units |
/// | 33..35 | shortest watchdog, ms |
/// | 35..39 | capabilities |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// The protocol version that Configure must state.
    pub version: u8,
    /// The addresses of the board's fingers, bit n for address n.
    pub addresses: u16,
    /// Kind of board: 0 unspecified, 1 simulated, 2 reference firmware, 0x8000 and up free for anyone.
    pub board_kind: u16,
    /// Different for every finger of every board ever built.
    pub unique_number: [u8; 12],
    /// Version of the board's firmware.
    pub firmware: FirmwareVersion,
    /// Counts per motor revolution, after quadrature; 0 if unknown to the board.
    pub counts_per_revolution: u32,
    /// Every gauge count is below 2 to the power of this number, which is 1 to 16.
    pub gauge_bits: u8,
    /// Torque of one unit, nN m. Not 0.
    pub torque_unit: u32,
    /// The largest torque that the board ever commands, torque units. At most 32767.
    pub torque_limit: u16,
    /// The shortest watchdog time that the board supports, ms.
    pub shortest_watchdog_ms: u16,
    /// Functions of the board beyond the minimum.
    pub capabilities: Capabilities,
}

impl Identity {
    /// Returns whether two identities are those of the same board with the same properties. Kind and firmware version
    /// are only information for people.
    #[must_use]
    pub fn agrees_with(&self, other: &Self) -> bool {
        Self { board_kind: other.board_kind, firmware: other.firmware, ..*self } == *other
    }
}

/// Major, minor, patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FirmwareVersion(pub [u8; 3]);

/// Functions of a board beyond the minimum. Bits without a name in this version are sent as 0 and ignored on reception.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capabilities(pub u32);

impl Capabilities {
    /// The board supports the end state *hold*.
    pub const HOLD: Capabilities = Capabilities(1 << 0);
    /// Encoder counts survive the loss of power, or the encoders are absolute.
    pub const KEEPS_ZERO: Capabilities = Capabilities(1 << 1);
    /// The board has an emergency stop input.
    pub const EMERGENCY_STOP: Capabilities = Capabilities(1 << 2);
    /// The board outputs the toggle bit on a pin.
    pub const TOGGLE_PIN: Capabilities = Capabilities(1 << 3);
    /// The board answers tactile requests.
    pub const TACTILE: Capabilities = Capabilities(1 << 4);

    /// Returns whether the board has all capabilities of `other`.
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

    /// Converts a torque in N cm to a torque count, rounded toward zero, so that a torque within a limit stays within
    /// it. A torque out of range becomes the closest valid count, and NaN becomes 0.
    pub fn torque_count(&self, newton_centimetres: f64) -> i16 {
        let exact = newton_centimetres * NANO_PER_CENTI / f64::from(self.torque_unit);
        // `as` converts NaN to 0. The count -32768 is not a valid torque, and has no positive counterpart.
        let nearest = exact.round().clamp(-f64::from(i16::MAX), f64::from(i16::MAX)) as i16;
        match self.torque(nearest).abs() > newton_centimetres.abs() {
            true => nearest - nearest.signum(),
            false => nearest,
        }
    }

    /// Converts a torque count to N cm.
    pub fn torque(&self, count: i16) -> f64 {
        // The product is exact, so only the division rounds. The result is therefore the double that is closest to the
        // exact torque. A configuration with the exact torque as a decimal number gives the same double.
        f64::from(count) * f64::from(self.torque_unit) / NANO_PER_CENTI
    }
}

/// nN m in one N cm.
const NANO_PER_CENTI: f64 = 1e7;

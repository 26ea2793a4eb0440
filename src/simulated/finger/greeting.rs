//! The Identity of a simulated finger.

use super::SimulatedFinger;
use super::identity::{BOARD_NUMBER, SHORTEST_WATCHDOG_MS};
use crate::board::protocol::{Capabilities, FirmwareVersion, Frame, Hello, Identity, Reason, Refused, VERSION};

/// The value of [`Identity::board_kind`].
const SIMULATED_BOARD: u16 = 1;

/// The resolution of the converter in [`Sensors`](crate::plant::Sensors), bits.
const GAUGE_BITS: u8 = 12;

impl SimulatedFinger {
    fn capabilities(&self) -> Capabilities {
        let tactile = if self.pads.exist() { Capabilities::TACTILE.0 } else { 0 };
        Capabilities(Capabilities::HOLD.0 | Capabilities::KEEPS_ZERO.0 | Capabilities::EMERGENCY_STOP.0 | tactile)
    }

    /// Writes the board's number into the unique number, which then differs from the unique number of the same finger
    /// on other simulated boards.
    pub(in crate::simulated) fn set_board_number(&mut self, number: u32) {
        self.unique_number[BOARD_NUMBER].copy_from_slice(&number.to_be_bytes());
    }

    pub(in crate::simulated) fn greet(&self, hello: &Hello, addresses: u16) -> Frame {
        if !(hello.lowest_version..=hello.highest_version).contains(&VERSION) {
            let detail = u16::from_le_bytes([VERSION, VERSION]);
            return Frame::Refused(Refused { request: 0x1, reason: Reason::Version, detail });
        }
        let part = |text: &str| text.parse().unwrap_or(0);
        Frame::Identity(Identity {
            version: VERSION,
            addresses,
            board_kind: SIMULATED_BOARD,
            unique_number: self.unique_number,
            firmware: FirmwareVersion([
                part(env!("CARGO_PKG_VERSION_MAJOR")),
                part(env!("CARGO_PKG_VERSION_MINOR")),
                part(env!("CARGO_PKG_VERSION_PATCH")),
            ]),
            counts_per_revolution: self.counts_per_revolution,
            gauge_bits: GAUGE_BITS,
            torque_unit: self.torque_unit,
            torque_limit: self.torque_limit,
            shortest_watchdog_ms: SHORTEST_WATCHDOG_MS,
            capabilities: self.capabilities(),
        })
    }
}

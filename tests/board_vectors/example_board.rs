//! The example board of docs/board-protocol.md and of protocol/vectors.json.

use sun2xp::board::protocol::{Capabilities, FirmwareVersion, Identity};

/// A simulated board with three fingers.
pub const IDENTITY: Identity = Identity {
    version: 1,
    addresses: 0b1110,
    board_kind: 0x8000,
    unique_number: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12],
    firmware: FirmwareVersion([1, 2, 3]),
    counts_per_revolution: 2000,
    gauge_bits: 12,
    torque_unit: 2000,
    torque_limit: 23750,
    shortest_watchdog_ms: 2,
    capabilities: Capabilities(0b1111),
};

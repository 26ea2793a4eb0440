//! The identity of hardware that the program provides. It replaces the identity of a board.

use super::finger_io::IoProperties;
use crate::board::protocol::{Capabilities, FirmwareVersion, Identity, VERSION};
use crate::model::FingerNumber;
use crate::model::configuration::Configuration;

/// Largest torque limit, torque units. It is below 32767, the largest signed 16-bit count, to leave room for rounding.
const LARGEST_LIMIT: f64 = 30_000.0;

/// nN m in one N cm.
const NANO_PER_CENTI: f64 = 1e7;

/// Returns the identity of the hardware of a finger. The torque limit in the identity covers every configured limit,
/// because the program that provides the hardware also provides the configuration.
pub(super) fn identity(configuration: &Configuration, finger: FingerNumber, properties: &IoProperties) -> Identity {
    let limits = configuration.fingers[finger.index()].motor.torque_limit;
    let strongest = limits.into_iter().fold(0.0, f64::max) * NANO_PER_CENTI;
    let torque_unit = (strongest / LARGEST_LIMIT).ceil().max(1.0);
    let mut unique_number = *b"sun2xp_io  0";
    unique_number[11] += finger.get() as u8;
    Identity {
        version: VERSION,
        addresses: 1 << configuration.address(finger),
        board_kind: 0,
        unique_number,
        firmware: FirmwareVersion::default(),
        counts_per_revolution: 0,
        gauge_bits: 16,
        torque_unit: torque_unit as u32,
        torque_limit: (strongest / torque_unit).ceil() as u16,
        shortest_watchdog_ms: properties.shortest_watchdog_ms,
        capabilities: if properties.holds { Capabilities::HOLD } else { Capabilities::default() },
    }
}

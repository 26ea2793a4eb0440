//! `[finger.encoder]`: scale, sign and zero of the motor encoders.

use serde::{Deserialize, Serialize};

/// `[finger.encoder]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredEncoder {
    /// Counts per revolution of the motor.
    pub counts_per_revolution: [u32; 4],
    /// +1 if the count rises as the tendon is pulled in, otherwise -1.
    pub sign: [i8; 4],
    /// m_0 of eq. 28: the count at theta = 0 with the homing pretension.
    pub zero: [i32; 4],
}

impl Default for ConfiguredEncoder {
    fn default() -> Self {
        Self { counts_per_revolution: [2000; 4], sign: [1; 4], zero: [0; 4] }
    }
}

//! `[finger.monitors]`: the thresholds of the monitors, and the errors of the configuration that they must tolerate.

use serde::{Deserialize, Serialize};

/// `[finger.monitors]`. The defaults suit a finger that has not been identified.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredMonitors {
    /// Torque that may be out of balance at a motor that does not turn, N cm. The motor is stalled if, for 12 ms, the
    /// imbalance exceeds what this value and `stall_fraction` together permit. The value must exceed the static
    /// friction of the motor.
    pub stall_torque: [f64; 4],
    /// Fraction of the pull or of the tension, whichever is larger, that may be out of balance in addition to
    /// `stall_torque`. It covers the error of the torque constant, and friction that is proportional to the tension.
    pub stall_fraction: f64,
    /// Disagreement of gauges and encoders that is always tolerated, as an error of the mean tension, N. The mean
    /// weights each tendon in proportion to its pretension and its compliance.
    pub disagreement: f64,
    /// Friction along a tendon, as a fraction of its tension. The monitors expect this value, or the sum of
    /// `friction.conduit` and `friction.pulley` if that sum is larger.
    pub friction_tolerance: f64,
    /// Relative uncertainty of the moment arms in `geometry.r`.
    pub moment_arm_tolerance: f64,
    /// Relative uncertainty of `gauge.newton_per_count`.
    pub gauge_tolerance: f64,
}

impl Default for ConfiguredMonitors {
    fn default() -> Self {
        Self {
            stall_torque: [0.25; 4],
            stall_fraction: 0.45,
            disagreement: 0.5,
            friction_tolerance: 0.2,
            moment_arm_tolerance: 0.05,
            gauge_tolerance: 0.05,
        }
    }
}

//! `[finger.gauge]`: scale and zero of the strain gauges.

use serde::{Deserialize, Serialize};

/// `[finger.gauge]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGauge {
    /// Tension of one count, N.
    pub newton_per_count: [f64; 4],
    /// Count at zero tension.
    pub zero: [f64; 4],
    /// The reference from which identification takes the common scale of the four gauges.
    pub reference: GaugeReference,
}

/// The reference for the common scale of all tensions, which no experiment on a free finger can determine.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum GaugeReference {
    /// The gauges: identification keeps the mean of their configured gains.
    #[default]
    Gauges,
    /// The motors: identification assumes that each pulls with its commanded torque minus its friction. It is
    /// sufficient that this is true for the average of the four motors.
    Motors,
}

impl Default for ConfiguredGauge {
    fn default() -> Self {
        Self { newton_per_count: [100.0 / 4095.0; 4], zero: [0.0; 4], reference: GaugeReference::default() }
    }
}

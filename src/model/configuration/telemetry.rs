//! `[telemetry]`: what other processes of the same user may read while the hand is open.

use serde::{Deserialize, Serialize};

/// `[telemetry]`. docs/telemetry.md describes what is published, and how.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredTelemetry {
    /// Whether processes of the same user may attach to the open hand and read its cycles, events and status.
    pub enabled: bool,
    /// Name of the hand, by which readers find it. If another open hand of the same user has this name, the hand gets
    /// the name with "-2", "-3" and so on appended.
    pub name: String,
}

impl Default for ConfiguredTelemetry {
    fn default() -> Self {
        Self { enabled: true, name: "hand".into() }
    }
}

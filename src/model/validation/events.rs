//! Checks of `[finger.events]`.

use super::ranges::within;
use crate::model::configuration::{ConfiguredEvents, Unusable};

impl ConfiguredEvents {
    pub(super) fn check(&self) -> Result<(), Unusable> {
        within("events.arrived_degrees", self.arrived_degrees, 0.01, 180.0, "degrees")?;
        within("events.settled_degrees", self.settled_degrees, 0.01, 180.0, "degrees")?;
        within("events.settled_ms", self.settled_ms, 1.0, 60_000.0, "ms")?;
        within("events.limit_margin_degrees", self.limit_margin_degrees, 0.0, 90.0, "degrees")?;
        within("events.tension_above", self.tension_above.unwrap_or(0.0), 0.0, 1000.0, "N")?;
        within("events.tension_below", self.tension_below.unwrap_or(0.0), 0.0, 1000.0, "N")?;
        within("events.force_above", self.force_above.unwrap_or(0.0), 0.0, 1000.0, "N")?;
        within("events.slip_friction", self.slip_friction.unwrap_or(0.01), 0.01, 100.0, "")
    }
}

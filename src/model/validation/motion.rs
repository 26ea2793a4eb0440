//! Checks of `[finger.motion]`.

use super::ranges::within;
use crate::model::configuration::{ConfiguredMotion, Unusable};

impl ConfiguredMotion {
    pub(super) fn check(&self) -> Result<(), Unusable> {
        within("motion.speed", self.speed, 1e-3, 1e3, "rad/s")?;
        within("motion.acceleration", self.acceleration, 1e-3, 1e6, "rad/s^2")?;
        within("motion.jerk", self.jerk, 1e-3, 1e9, "rad/s^3")?;
        within("motion.interpolate_ms", self.interpolate_ms.unwrap_or(1.0), 1.0, 10_000.0, "ms")?;
        within("motion.valid_ms", self.valid_ms.unwrap_or(1.0), 1.0, 3.6e6, "ms")?;
        within("motion.end_state_ms", self.end_state_ms.unwrap_or(1.0), 1.0, 3.6e6, "ms")?;
        within("motion.expired_stiffness", self.expired_stiffness, 0.0, 1000.0, "N/cm")
    }
}

//! Checks of `[finger.monitors]`.

use super::ranges::{each, within};
use crate::model::configuration::{ConfiguredMonitors, Unusable};

impl ConfiguredMonitors {
    pub(super) fn check(&self) -> Result<(), Unusable> {
        each("monitors.stall_torque", &self.stall_torque, 1e-3, 6000.0, "N cm")?;
        within("monitors.stall_fraction", self.stall_fraction, 0.0, 1.0, "")?;
        within("monitors.disagreement", self.disagreement, 0.1, 1000.0, "N")?;
        within("monitors.friction_tolerance", self.friction_tolerance, 0.0, 1.0, "")?;
        within("monitors.moment_arm_tolerance", self.moment_arm_tolerance, 0.0, 0.5, "")?;
        within("monitors.gauge_tolerance", self.gauge_tolerance, 0.0, 0.5, "")
    }
}

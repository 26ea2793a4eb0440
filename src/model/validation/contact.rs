//! Checks of `[finger.contact]`.

use super::ranges::{each, within};
use crate::model::configuration::{ConfiguredContact, Unusable};

impl ConfiguredContact {
    pub(super) fn check(&self) -> Result<(), Unusable> {
        within("contact.bandwidth", self.bandwidth, 1.0, 1000.0, "1/s")?;
        within("contact.force", self.force, 1e-3, 1000.0, "N")?;
        within("contact.force_per_rate", self.force_per_rate, 0.0, 1000.0, "N s/rad")?;
        each("contact.torque", &self.torque, 1e-3, 1000.0, "N cm")?;
        within("contact.mass_tolerance", self.mass_tolerance, 0.0, 2.0, "")?;
        within("contact.lost", self.lost, 0.05, 1.0, "")?;
        within("contact.learning_time_s", self.learning_time_s, 0.05, 3600.0, "s")
    }
}

//! Checks of the object in the simulated hand.

use super::ranges::{each, within};
use crate::model::configuration::{ConfiguredHand, ObjectShape, Unusable};

impl ConfiguredHand {
    /// Checks every value of `[hand.simulated_object]`. The physics is stable within these ranges: no contact
    /// oscillates faster than the steps of the physics can follow.
    pub(super) fn check_simulated_object(&self) -> Result<(), Unusable> {
        let Some(object) = &self.simulated_object else { return Ok(()) };
        match object.shape {
            ObjectShape::Ball { radius } => within("simulated_object.shape.ball.radius", radius, 0.5, 20.0, "cm")?,
            ObjectShape::Box { size } => each("simulated_object.shape.box.size", &size, 1.0, 40.0, "cm")?,
        }
        within("simulated_object.mass", object.mass, 0.01, 10.0, "kg")?;
        within("simulated_object.friction", object.friction, 0.0, 5.0, "")?;
        within("simulated_object.stiffness", object.stiffness, 1.0, 100.0, "N/cm")?;
        each("simulated_object.position", &object.position, -100.0, 100.0, "cm")?;
        within("simulated_object.table", object.table.unwrap_or_default(), -100.0, 100.0, "cm")
    }
}

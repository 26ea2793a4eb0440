//! Checks of `[finger.touch]`.

use super::ranges::{each, unusable, within};
use crate::model::configuration::{ConfiguredTouch, MOST_ELEMENTS, Unusable};
use crate::model::direction;
use nalgebra::Vector3;

impl ConfiguredTouch {
    pub(super) fn check(&self) -> Result<(), Unusable> {
        let count = self.elements.len();
        if count > MOST_ELEMENTS {
            return unusable(
                "touch.elements",
                format!("has {count} elements, but a finger has at most {MOST_ELEMENTS}: remove the rest"),
            );
        }
        for element in &self.elements {
            each("touch.elements", &element.position, -100.0, 100.0, "cm")?;
            each("touch.elements", &element.normal, -1000.0, 1000.0, "")?;
            within("touch.elements", element.newton_per_count, 1e-6, 10.0, "N per count")?;
            if direction(&Vector3::from(element.normal)).is_none() {
                return unusable("touch.elements", "has a normal of length 0: give each element its direction".into());
            }
        }
        Ok(())
    }
}

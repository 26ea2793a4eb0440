//! `[finger.touch]`: the tactile elements of a fingertip.

use serde::{Deserialize, Serialize};

/// The largest number of tactile elements of a finger.
pub const MOST_ELEMENTS: usize = 64;

/// `[finger.touch]`. Without elements, the board is not asked for tactile events.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredTouch {
    /// The elements, at most [`MOST_ELEMENTS`], in the order in which the board counts them.
    pub elements: Vec<TouchElement>,
}

/// A tactile element.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TouchElement {
    /// Position relative to the fingertip in the axes of the last link, cm. The z axis of the link points from joint 2
    /// to the tip, and its x axis has the direction of the parallel axes of joints 1 and 2.
    pub position: [f64; 3],
    /// Outward normal of the element in the same axes. Its length does not matter.
    pub normal: [f64; 3],
    /// Force per count of the element, N.
    #[serde(default = "usual_scale")]
    pub newton_per_count: f64,
    /// Count of the element when nothing presses it.
    #[serde(default)]
    pub zero: u16,
}

fn usual_scale() -> f64 {
    0.001
}

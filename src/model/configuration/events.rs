//! `[finger.events]`: the bounds at which the servo reports an event.

use serde::{Deserialize, Serialize};

/// `[finger.events]`. A bound that is `None` causes no events.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredEvents {
    /// The finger counts as arrived if no joint differs from the set point by more than this, degrees.
    pub arrived_degrees: f64,
    /// The finger counts as settled if no joint moves by more than this during `settled_ms`, degrees.
    pub settled_degrees: f64,
    /// Time for which no joint may move more than `settled_degrees`, ms.
    pub settled_ms: f64,
    /// Distance from its limit at which a joint counts as being at the limit, degrees.
    pub limit_margin_degrees: f64,
    /// Upper bound of the tension of each tendon, N.
    pub tension_above: Option<f64>,
    /// Lower bound of the tension of each tendon, N.
    pub tension_below: Option<f64>,
    /// Upper bound of the force at the fingertip, N.
    pub force_above: Option<f64>,
    /// Upper bound of the tangential contact force divided by the normal contact force. A bound below the coefficient
    /// of friction is exceeded before the fingertip slips.
    pub slip_friction: Option<f64>,
}

impl Default for ConfiguredEvents {
    fn default() -> Self {
        Self {
            arrived_degrees: 2.0,
            settled_degrees: 0.3,
            settled_ms: 100.0,
            limit_margin_degrees: 1.0,
            tension_above: None,
            tension_below: None,
            force_above: None,
            slip_friction: None,
        }
    }
}

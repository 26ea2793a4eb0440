//! Conversion of a fingertip's state to the result of sun2xp_tip.

use crate::capi::fingertip_struct::sun2xp_tip;
use crate::hand;
use std::ffi::c_int;

impl From<hand::FingerTip> for sun2xp_tip {
    /// Converts everything except `size`, which belongs to the caller.
    fn from(tip: hand::FingerTip) -> Self {
        Self {
            size: 0,
            force_directions: tip.felt as c_int, // 0 to 3
            position: tip.tip,
            force: tip.force,
            tensions: tip.tensions,
            stiffness: tip.stiffness,
            contact_force: tip.contact,
            slide_speed: tip.slide,
            touching: c_int::from(tip.touching),
        }
    }
}

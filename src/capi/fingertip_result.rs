//! Conversion of a fingertip's state to the result of GetTip.

use crate::capi::fingertip_calls::FingerTip;
use crate::hand;
use std::ffi::c_int;

impl From<hand::FingerTip> for FingerTip {
    /// Converts everything except `Size`. [`fill`](crate::capi::memory::fill) sets `Size`, because it depends on the
    /// room of the caller.
    fn from(tip: hand::FingerTip) -> Self {
        Self {
            Size: 0,
            Felt: tip.felt as c_int, // 0 to 3
            Tip: tip.tip,
            Force: tip.force,
            Tensions: tip.tensions,
            Stiffness: tip.stiffness,
            Contact: tip.contact,
            Slide: tip.slide,
            Touching: c_int::from(tip.touching),
            Unused: 0,
        }
    }
}

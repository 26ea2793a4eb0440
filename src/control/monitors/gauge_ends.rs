//! The ends of the ranges of the gauges.

use crate::model::configuration::ConfiguredFinger;

/// The direction of the counts of each gauge. The counts of a falling gauge fall when the tension rises, so its largest
/// count is the end at which its tendon is slack.
#[derive(Clone, Copy, Debug)]
pub(super) struct GaugeEnds {
    falling: [bool; 4],
}

impl GaugeEnds {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self { falling: finger.gauge.newton_per_count.map(|scale| scale < 0.0) }
    }

    /// Returns whether a gauge is at the high-tension end of its range. `full_scale` is the largest count of the
    /// gauges.
    #[inline]
    pub fn at_highest(&self, gauge: usize, count: u16, full_scale: u16) -> bool {
        // The count of a falling gauge at this end is 0. The subtraction turns it into 65535, which no full scale
        // exceeds.
        count.wrapping_sub(u16::from(self.falling[gauge])) >= full_scale
    }

    /// Returns whether a gauge is at the end of its range at which its tendon is slack.
    #[inline]
    pub fn at_lowest(&self, gauge: usize, count: u16, full_scale: u16) -> bool {
        if self.falling[gauge] { count >= full_scale } else { count == 0 }
    }
}

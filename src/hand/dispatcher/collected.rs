//! Timings, losses and black box of one finger, as collected from its servo.

use crate::finger::{BlackBox, Losses};
use crate::realtime::{Consumer, CycleTiming, Histograms};

/// The collected data of one finger.
pub(super) struct Collected {
    pub arriving: Consumer<CycleTiming>,
    pub histograms: Histograms,
    /// Losses at the last reset.
    pub losses_before: Losses,
    pub black_box: BlackBox,
}

impl Collected {
    /// Collects new data from the servo.
    pub fn collect(&mut self) {
        while let Some(timing) = self.arriving.pop() {
            self.histograms.record(&timing);
        }
        self.black_box.collect();
    }
}

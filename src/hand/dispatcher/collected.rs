//! What the servo of one finger has left behind, as far as it was collected.

use crate::finger::{BlackBox, Losses};
use crate::realtime::{Consumer, CycleTiming, Histograms};

/// What the servo of one finger leaves behind.
pub(super) struct Collected {
    pub arriving: Consumer<CycleTiming>,
    pub histograms: Histograms,
    /// Up to the last reset.
    pub losses_before: Losses,
    pub black_box: BlackBox,
}

impl Collected {
    /// Takes in what the servo has left.
    pub fn collect(&mut self) {
        while let Some(timing) = self.arriving.pop() {
            self.histograms.record(&timing);
        }
        self.black_box.collect();
    }
}

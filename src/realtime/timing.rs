//! Timing of the cycles. The servo writes one small record per finger and cycle. The thread that collects the reports
//! adds the records to histograms.

use hdrhistogram::Histogram;
use serde::{Deserialize, Serialize};

/// A stage of a finger's cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleStage {
    /// From the scheduled beginning of the cycle to the thread's first instruction.
    WakeUp,
    /// Passing the commands of the port's fingers to the operating system.
    Write,
    /// From the end of the write until reply bytes can be read: the line in both directions, and the board.
    Wire,
    /// Reading the reply bytes.
    Read,
    /// Decoding the bytes into the finger's reply, including the checks.
    Decode,
    /// Computing the command, and the state that planners read.
    Compute,
    /// From the scheduled beginning to the end of the computation.
    Whole,
    /// Age of the newest measurement when the command computed from it takes effect, by the board's clock. It is one
    /// period if nothing is late.
    Age,
}

impl CycleStage {
    /// Every stage: first the parts of a cycle in order of time, then the whole cycle and the age.
    pub const ALL: [CycleStage; 8] = [
        CycleStage::WakeUp,
        CycleStage::Write,
        CycleStage::Wire,
        CycleStage::Read,
        CycleStage::Decode,
        CycleStage::Compute,
        CycleStage::Whole,
        CycleStage::Age,
    ];
}

/// The times of one finger's cycle, ns, in the order of [`CycleStage::ALL`]. A stage that did not take place, for
/// example because there was no reply, has no time.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct CycleTiming {
    stages: [Option<u32>; CycleStage::ALL.len()],
}

impl CycleTiming {
    /// Notes the duration of a stage from its beginning and end, ns.
    pub fn note(&mut self, stage: CycleStage, from: u64, to: u64) {
        self.stages[stage as usize] = Some(u32::try_from(to.saturating_sub(from)).unwrap_or(u32::MAX));
    }

    /// Returns the duration of a stage, ns; none if the stage did not take place.
    pub fn duration(&self, stage: CycleStage) -> Option<u32> {
        self.stages[stage as usize]
    }
}

/// The distribution of a stage's duration, microseconds.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Distribution {
    /// Number of cycles.
    pub count: u64,
    /// Shortest duration.
    pub minimum: f64,
    /// Median.
    pub median: f64,
    /// 99 % of the durations are not longer.
    pub p99: f64,
    /// 99.9 % of the durations are not longer.
    pub p999: f64,
    /// Longest duration.
    pub maximum: f64,
}

/// Distributions of every stage since the last reset.
#[derive(Clone, Debug)]
pub struct Histograms {
    stages: [Histogram<u32>; CycleStage::ALL.len()],
}

impl Histograms {
    /// Creates empty histograms of a fixed size: 1 ns to 4.3 s in steps of 1 %.
    pub fn new() -> Self {
        let empty = |_| {
            Histogram::new_with_bounds(1, u64::from(u32::MAX), 2)
                .unwrap_or_else(|_| unreachable!("the bounds and digits are constants that the histogram accepts"))
        };
        Self { stages: CycleStage::ALL.map(empty) }
    }

    /// Counts one cycle.
    pub fn record(&mut self, timing: &CycleTiming) {
        for (histogram, time) in self.stages.iter_mut().zip(timing.stages) {
            if let Some(time) = time {
                histogram.saturating_record(time.into());
            }
        }
    }

    /// Clears all counts.
    pub fn reset(&mut self) {
        self.stages.iter_mut().for_each(Histogram::reset);
    }

    /// The distribution of a stage. All its numbers are 0 if nothing was counted.
    pub fn distribution(&self, stage: CycleStage) -> Distribution {
        let histogram = &self.stages[stage as usize];
        let microseconds = |ns: u64| ns as f64 * 1e-3;
        if histogram.is_empty() {
            return Distribution::default();
        }
        Distribution {
            count: histogram.len(),
            minimum: microseconds(histogram.min()),
            median: microseconds(histogram.value_at_quantile(0.5)),
            p99: microseconds(histogram.value_at_quantile(0.99)),
            p999: microseconds(histogram.value_at_quantile(0.999)),
            maximum: microseconds(histogram.max()),
        }
    }
}

impl Default for Histograms {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_counted_apart_and_missing_ones_not_at_all() {
        let mut histograms = Histograms::new();
        for cycle in 1..=1000u64 {
            let mut timing = CycleTiming::default();
            timing.note(CycleStage::WakeUp, 5_000, 5_000 + 1000 * cycle);
            if cycle % 2 == 0 {
                timing.note(CycleStage::Wire, 0, 70_000);
            }
            histograms.record(&timing);
        }
        let wake_up = histograms.distribution(CycleStage::WakeUp);
        assert_eq!(wake_up.count, 1000);
        for (is, exact) in
            [(wake_up.minimum, 1.0), (wake_up.median, 500.0), (wake_up.p99, 990.0), (wake_up.p999, 999.0)]
        {
            assert!((is / exact - 1.0).abs() < 0.011, "{wake_up:?}");
        }
        assert_eq!(histograms.distribution(CycleStage::Wire).count, 500);
        assert_eq!(histograms.distribution(CycleStage::Read), Distribution::default());
        histograms.reset();
        assert_eq!(histograms.distribution(CycleStage::WakeUp).count, 0);
    }

    #[test]
    fn a_clock_that_seems_to_run_backward_counts_as_no_time() {
        let mut timing = CycleTiming::default();
        timing.note(CycleStage::Whole, 10, 5);
        let mut histograms = Histograms::new();
        histograms.record(&timing);
        assert!(histograms.distribution(CycleStage::Whole).maximum < 0.002);
    }
}

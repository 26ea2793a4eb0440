//! The wake-up delays of a finger's cycles in the last seconds, as a histogram.

use serde::Serialize;
use std::collections::VecDeque;

/// Upper edges of the classes, us. The last class has no upper edge.
pub const EDGES: [f64; 12] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0];

/// Number of classes.
pub const CLASSES: usize = EDGES.len() + 1;

/// Time that the histogram covers, s.
pub const SECONDS: usize = 10;

/// Counts of the last [`SECONDS`] seconds.
#[derive(Clone, Debug, Default)]
pub struct WakeUps {
    /// Counts of each second, the newest last, with the number of the second.
    seconds: VecDeque<(u64, [u64; CLASSES])>,
}

/// A histogram.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Histogram {
    /// Number of cycles in each class of [`EDGES`].
    pub counts: [u64; CLASSES],
}

impl WakeUps {
    /// Counts the cycle that began at `time`, ns. `nanoseconds` is its wake-up delay.
    pub fn note(&mut self, time: u64, nanoseconds: u32) {
        let microseconds = f64::from(nanoseconds) * 1e-3;
        let class = EDGES.partition_point(|&edge| edge < microseconds);
        let second = time / 1_000_000_000;
        match self.seconds.back_mut() {
            Some((newest, counts)) if *newest == second => counts[class] += 1,
            _ => {
                let mut counts = [0; CLASSES];
                counts[class] = 1;
                self.seconds.push_back((second, counts));
            }
        }
        while self.seconds.front().is_some_and(|(oldest, _)| oldest + SECONDS as u64 <= second) {
            self.seconds.pop_front();
        }
    }

    /// Returns the sum of all seconds.
    pub fn histogram(&self) -> Histogram {
        let mut sum = Histogram::default();
        for (_, counts) in &self.seconds {
            sum.counts.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        sum
    }
}

impl Histogram {
    /// Adds the counts of another histogram.
    pub fn add(&mut self, other: &Self) {
        self.counts.iter_mut().zip(other.counts).for_each(|(sum, count)| *sum += count);
    }

    /// Returns the number of cycles.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_last_ten_seconds_count() {
        let mut wake_ups = WakeUps::default();
        for second in 0..20 {
            for _ in 0..100 {
                wake_ups.note(second * 1_000_000_000, 15_000);
            }
        }
        wake_ups.note(19_000_000_000, 2_000);
        wake_ups.note(19_000_000_000, 50_000_000);
        let histogram = wake_ups.histogram();
        assert_eq!(histogram.total(), 1002);
        assert_eq!((histogram.counts[3], histogram.counts[0], histogram.counts[CLASSES - 1]), (1000, 1, 1));
    }
}

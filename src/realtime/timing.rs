//! Where the time of a cycle goes, as data: the servo writes one small record a cycle, whoever collects the reports counts
//! them.

use hdrhistogram::Histogram;

/// The times of one cycle, ns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CycleTiming {
    /// From the scheduled beginning to the first instruction.
    pub wake_up: u32,
    /// From the first instruction to the reply, or to giving up on it.
    pub exchange: u32,
    /// The pure core.
    pub compute: u32,
}

/// The distribution of one stage, microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Latency {
    /// Half of all cycles took no longer.
    pub median: f64,
    /// 99 of 100 cycles took no longer.
    pub p99: f64,
    /// The longest of all.
    pub maximum: f64,
}

/// Distributions of every stage since they were last reset.
#[derive(Clone, Debug)]
pub struct Histograms {
    wake_up: Histogram<u32>,
    exchange: Histogram<u32>,
    compute: Histogram<u32>,
}

impl Histograms {
    /// Empty ones. Fixed in size: 1 ns to 4.3 s in steps of 1 %.
    pub fn new() -> Self {
        let empty = || {
            Histogram::new_with_bounds(1, u64::from(u32::MAX), 2)
                .unwrap_or_else(|_| unreachable!("the bounds and digits are constants that the histogram takes"))
        };
        Self { wake_up: empty(), exchange: empty(), compute: empty() }
    }

    /// Counts one cycle.
    pub fn record(&mut self, timing: &CycleTiming) {
        self.wake_up.saturating_record(timing.wake_up.into());
        self.exchange.saturating_record(timing.exchange.into());
        self.compute.saturating_record(timing.compute.into());
    }

    /// Wake-up latency.
    pub fn wake_up(&self) -> Latency {
        latency(&self.wake_up)
    }

    /// Command out to reply in.
    pub fn exchange(&self) -> Latency {
        latency(&self.exchange)
    }

    /// The pure core.
    pub fn compute(&self) -> Latency {
        latency(&self.compute)
    }
}

impl Default for Histograms {
    fn default() -> Self {
        Self::new()
    }
}

fn latency(histogram: &Histogram<u32>) -> Latency {
    let microseconds = |ns: u64| ns as f64 * 1e-3;
    Latency {
        median: microseconds(histogram.value_at_quantile(0.5)),
        p99: microseconds(histogram.value_at_quantile(0.99)),
        maximum: microseconds(histogram.max()),
    }
}

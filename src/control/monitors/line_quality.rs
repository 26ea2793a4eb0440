//! Fraction of the recent cycles with one kind of failure: a lost reply, a damaged reply, or skipped periods.

/// The weighted fraction of failed cycles. Old cycles fade: after one window, the weight of a cycle has fallen to 1/e.
#[derive(Clone, Copy, Debug)]
pub struct LineQuality {
    gain: f64,
    share: f64,
}

impl LineQuality {
    /// Constructs a mean with a window of `window` cycles, or of one cycle if `window` is smaller.
    pub fn new(window: f64) -> Self {
        Self { gain: 1.0 / window.max(1.0), share: 0.0 }
    }

    /// Records one cycle: 1 if it failed, 0 if not. Returns the weighted fraction of failed cycles.
    pub fn note(&mut self, wrong: f64) -> f64 {
        self.share += (wrong - self.share) * self.gain;
        self.share
    }

    /// Forgets all cycles.
    pub fn forget(&mut self) {
        self.share = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fraction_follows_failures_and_fades() {
        let mut quality = LineQuality::new(100.0);
        let every_fifth = (0..2000).map(|period| quality.note(f64::from(u8::from(period % 5 == 0)))).last();
        assert!((every_fifth.unwrap_or_default() - 0.2).abs() < 0.01, "{every_fifth:?}");
        let forgotten = (0..100).map(|_| quality.note(0.0)).last().unwrap_or_default();
        assert!((forgotten - 0.2 / std::f64::consts::E).abs() < 0.01, "{forgotten}");
    }
}

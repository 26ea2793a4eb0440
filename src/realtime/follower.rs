//! Follows another clock: a phase-locked loop.

/// What the clock that is followed counts, ns a count. It wraps at 65 536.
const NS_A_COUNT: i64 = 1000;

/// Natural frequency of the loop, rad/s: it settles in some seconds. A command that arrives 1 ms late on a busy machine
/// moves the next period by a microsecond.
const NATURAL: f64 = 1.0;

/// Damping ratio of the loop.
const DAMPING: f64 = 1.0;

/// Most that a period is lengthened or shortened, as a part of it: crystals differ by 100 ppm, ceramic resonators by
/// 3000 ppm and more. What differs by more than this is no clock.
const MOST: f64 = 5e-3;

/// Makes periods last as long as they should by somebody else's clock, which counts microseconds modulo 65 536 and is
/// read once a period at best.
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    /// ns.
    period: f64,
    /// How far the other clock is ahead of where it should be, ns; none before it was first read.
    ahead: Option<i64>,
    last: u16,
    /// From the last reading to the cycle that comes next.
    periods: u64,
    /// What a period has to be shortened by because of the other clock's rate, ns.
    rate: f64,
    /// What was not yet applied, ns: corrections are whole.
    rest: f64,
}

impl Follower {
    /// `period` as the other clock shall see it, ns.
    pub fn new(period: u64) -> Self {
        Self { period: period as f64, ahead: None, last: 0, periods: 0, rate: 0.0, rest: 0.0 }
    }

    /// By how much the next beginning has to be later than it would be, ns. To be called once a cycle, with what the
    /// other clock said in it, and with how many `periods` the next cycle comes later: 1, and more where some are
    /// skipped.
    ///
    /// Readings more than 32 ms from what is expected are taken to be nearer: the clock wraps.
    pub fn correction(&mut self, reading: Option<u16>, periods: u64) -> i64 {
        let bound = MOST * self.period;
        let mut wanted = 0.0;
        if let Some(reading) = reading {
            let expected = (self.periods as f64 * self.period / NS_A_COUNT as f64).round() as i64;
            let counts = reading.wrapping_sub(self.last).wrapping_sub(expected as u16) as i16;
            let ahead =
                (expected + i64::from(counts)) * NS_A_COUNT - (self.periods as f64 * self.period).round() as i64;
            let elapsed = self.periods as f64 * self.period * 1e-9;
            (self.last, self.periods) = (reading, 0);
            let phase = self.ahead.map_or(0, |before| before + ahead);
            self.ahead = Some(phase);
            let phase = phase as f64;
            self.rate = (self.rate + NATURAL * NATURAL * elapsed * phase * self.period * 1e-9).clamp(-bound, bound);
            wanted = 2.0 * DAMPING * NATURAL * elapsed * phase;
        }
        self.periods += periods;
        self.rest -= (wanted + self.rate * periods as f64).clamp(-bound, bound);
        let whole = self.rest.round();
        self.rest -= whole;
        whole as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PERIOD: u64 = 1_000_000;

    /// Runs a loop against a clock that is faster by `drift`, and returns the mean period and the spread of the
    /// beginnings about it, ns of that clock, in the last of `seconds`. `late` says how late each cycle's command
    /// arrives, ns, none: no reply.
    fn run(drift: f64, seconds: u64, start: f64, mut late: impl FnMut(u64) -> Option<u64>) -> (f64, f64) {
        let mut follower = Follower::new(PERIOD);
        let other = |host: f64| start + host * (1.0 + drift);
        let mut beginning = 0.0;
        let mut beginnings = Vec::new();
        for cycle in 0..seconds * 1000 {
            let reading = late(cycle).map(|late| ((other(beginning + late as f64) / 1000.0) as u64) as u16);
            beginnings.push(other(beginning));
            beginning += PERIOD as f64 + follower.correction(reading, 1) as f64;
        }
        let last = &beginnings[beginnings.len() - 1000..];
        let mean = (last[999] - last[0]) / 999.0;
        let off = last.iter().enumerate().map(|(cycle, at)| (at - last[0] - mean * cycle as f64).abs());
        (mean, off.fold(0.0, f64::max))
    }

    #[test]
    fn without_a_reading_nothing_is_corrected() {
        let mut follower = Follower::new(PERIOD);
        assert!((0..1000).all(|_| follower.correction(None, 1) == 0));
    }

    #[test]
    fn a_late_command_hardly_moves_a_period() {
        let (mean, off) = run(0.0, 20, 0.0, |cycle| Some(if cycle % 1000 == 500 { 1_000_000 } else { 20_000 }));
        // Settled, and 1 ms late once a second: that is as it would be, 1 us a second, were the mean followed.
        assert!((mean - 1e6).abs() < 10.0 && off < 2000.0, "{mean} {off}");
    }

    #[test]
    fn what_was_learnt_holds_while_replies_stay_away() {
        let (mean, _) = run(200e-6, 31, 0.0, |cycle| (cycle < 30_000).then_some(20_000));
        assert!((mean - 1e6).abs() < 2.0, "{mean}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases / 8))]
        #[test]
        fn the_period_is_what_it_should_be_by_the_other_clock(
            drift in -200e-6..200e-6f64, start in 0.0..1e9f64, seed in 1u64..1000,
        ) {
            // Wake-ups 0 to 50 us late, and one reply in eight lost.
            let (mean, off) = run(drift, 30, start, |cycle| {
                let random = (cycle + seed).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
                (random % 8 != 0).then_some(random % 50_000)
            });
            // 1 ppm of a period is 1 ns; uncorrected it would be off by up to 200 ns.
            prop_assert!((mean - 1e6).abs() < 3.0, "{} ppm: mean period {mean} ns", drift * 1e6);
            prop_assert!(off < 1500.0, "{} ppm: beginnings off by {off} ns", drift * 1e6);
        }
    }
}

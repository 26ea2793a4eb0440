//! A phase-locked loop that makes the servo's period follow the clock of a board. The board's clock is called the other
//! clock here.

/// Resolution of the other clock, ns per count. Its counter wraps at 65 536.
const NS_A_COUNT: i64 = 1000;

/// Natural frequency of the loop, rad/s. With this value the loop settles in a few seconds. If a busy machine sends a
/// command 1 ms late, the next period changes by only 2 us at 1000 Hz.
const NATURAL: f64 = 1.0;

/// Damping ratio of the loop.
const DAMPING: f64 = 1.0;

/// Largest relative change of a period. Crystals differ by 100 ppm, ceramic resonators by 3000 ppm and more. A
/// difference above this limit is not caused by the clocks.
const MOST: f64 = 5e-3;

/// If the other clock has gained or lost more than the largest drift plus this number of periods, it has jumped.
const JUMP: f64 = 2.0;

/// Longest time between two readings, s, from which the loop computes how much the other clock has gained. It is
/// shorter than half a turn of the counter. After a longer time the board may have restarted, and the count does not
/// show the restart.
const LONGEST_GAP: f64 = 0.03;

/// Adjusts the period so that its length, measured with the other clock, is the nominal length. The other clock counts
/// microseconds modulo 65 536 and is read at most once per period.
#[derive(Clone, Copy, Debug)]
pub struct Follower {
    /// Nominal length of a period, ns.
    period: f64,
    /// Lead of the other clock relative to the nominal phase, ns; none before the first reading.
    phase: Option<i64>,
    /// The previous reading, counts.
    last: u16,
    /// Periods from the previous reading to the next cycle.
    periods: u64,
    /// Correction of each period for the other clock's rate, ns. A positive correction shortens the period.
    rate: f64,
    /// The fraction of a nanosecond that has not been applied yet. Corrections are whole nanoseconds.
    remainder: f64,
}

impl Follower {
    /// `period` is the nominal length of a period, measured with the other clock, ns.
    pub fn new(period: u64) -> Self {
        Self { period: period as f64, phase: None, last: 0, periods: 0, rate: 0.0, remainder: 0.0 }
    }

    /// Returns the delay that the beginning of the next cycle needs, ns. The delay may be negative. This function must
    /// be called once per cycle. `reading` is the count of the other clock in this cycle, or none if no reply contained
    /// a count. `periods` is the number of periods until the next cycle: 1, or more if some are skipped.
    ///
    /// The counter wraps. A reading is therefore assumed to be within 32 ms of the expected count. If the other clock
    /// jumps, for example because the board has restarted, the phase of the loop stays as it is. If there was no
    /// reading for more than 30 ms, phase and rate stay, because the count then does not show a jump.
    pub fn correction(&mut self, reading: Option<u16>, periods: u64) -> i64 {
        let bound = MOST * self.period;
        let mut wanted = 0.0;
        if let Some(reading) = reading {
            let expected = (self.periods as f64 * self.period / NS_A_COUNT as f64).round() as i64;
            let counts = reading.wrapping_sub(self.last).wrapping_sub(expected as u16) as i16;
            let gained =
                (expected + i64::from(counts)) * NS_A_COUNT - (self.periods as f64 * self.period).round() as i64;
            let since = self.periods as f64 * self.period * 1e-9;
            let (gained, elapsed) = if since > LONGEST_GAP { (0, 0.0) } else { (gained, since) };
            (self.last, self.periods) = (reading, 0);
            // A jump is a restart of the board or a very late command, and not a difference of the rates.
            let jump = gained.abs() as f64 > MOST * elapsed * 1e9 + JUMP * self.period;
            let phase = self.phase.map_or(0, |before| if jump { before } else { before + gained });
            self.phase = Some(phase);
            let phase = phase as f64;
            self.rate = (self.rate + NATURAL * NATURAL * elapsed * phase * self.period * 1e-9).clamp(-bound, bound);
            wanted = 2.0 * DAMPING * NATURAL * elapsed * phase;
        }
        self.periods += periods;
        self.remainder -= (wanted + self.rate * periods as f64).clamp(-bound, bound);
        let whole = self.remainder.round();
        self.remainder -= whole;
        whole as i64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PERIOD: u64 = 1_000_000;

    /// Runs a loop for `seconds` with another clock that is faster than the host's clock by the fraction `drift`.
    /// Returns the mean period of the last second, and the largest deviation of a cycle's beginning from equal periods
    /// of this mean length. Both are in ns of the other clock. `late` returns the lateness of the command in each
    /// cycle, ns, or none if there is no reply.
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
        // The loop has settled, and one command per second is 1 ms late. This raises the mean lateness by 1 us, so even
        // a loop that followed only the mean would move the beginnings by 1 us.
        assert!((mean - 1e6).abs() < 10.0 && off < 2000.0, "{mean} {off}");
    }

    #[test]
    fn a_clock_that_jumps_does_not_change_the_period() {
        for jump in [20_000_000, 60_000_000] {
            let late = |cycle| Some(20_000 + if cycle < 18_500 { 0 } else { jump });
            let (mean, off) = run(100e-6, 20, 0.0, late);
            assert!((mean - 1e6).abs() < 10.0 && off < 2000.0, "{jump} ns: {mean} {off}");
        }
    }

    /// The finger is faulted for 10 s. The board restarts meanwhile, so its clock continues from another count.
    #[test]
    fn a_gap_without_readings_does_not_change_the_period() {
        for jump in [0, 20_000_000] {
            let (mean, off) = run(100e-6, 34, 0.0, |cycle| match cycle {
                ..20_000 => Some(20_000),
                20_000..30_000 => None,
                30_000.. => Some(20_000 + jump),
            });
            assert!((mean - 1e6).abs() < 10.0 && off < 2000.0, "{jump} ns: {mean} {off}");
        }
    }

    #[test]
    fn the_learnt_rate_holds_while_replies_are_missing() {
        let (mean, _) = run(200e-6, 31, 0.0, |cycle| (cycle < 30_000).then_some(20_000));
        assert!((mean - 1e6).abs() < 2.0, "{mean}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases / 8))]
        #[test]
        fn the_mean_period_is_the_nominal_one_by_the_other_clock(
            drift in -200e-6..200e-6f64, start in 0.0..1e9f64, seed in 1u64..1000,
        ) {
            // Wake-ups are 0 to 50 us late, and one reply in eight is lost. After t = 9 s the rate that the loop has
            // learnt is wrong by 0.1 % of the drift: a critically damped loop of 1 rad/s leaves the fraction
            // (t - 1) e^-t of the drift.
            let (mean, off) = run(drift, 10, start, |cycle| {
                let random = (cycle + seed).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
                (random % 8 != 0).then_some(random % 50_000)
            });
            // 1 ppm of a period is 1 ns. Without correction the mean period would be wrong by up to 200 ns.
            prop_assert!((mean - 1e6).abs() < 3.0, "{} ppm: mean period {mean} ns", drift * 1e6);
            prop_assert!(off < 1500.0, "{} ppm: beginnings off by {off} ns", drift * 1e6);
        }
    }
}

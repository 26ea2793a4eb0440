//! Periods with absolute deadlines.

/// The times at which the cycles of a servo begin. Each of them is later than the first by a whole multiple of `period`
/// ns, until [`Schedule::shift`] moves them. Errors do not accumulate, because these times do not depend on when the
/// previous cycle ran.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    next: u64,
    period: u64,
    /// Beginning of period 0, which the schedules of all threads have in common, ns.
    origin: u64,
    /// [`Schedule::number`] adds this margin to a time, ns, before it rounds the sum down to the number of a period.
    /// The margin is half the stagger between two threads, so that a shift of the schedule by less than the margin does
    /// not change the number of a cycle's period.
    margin: u64,
}

impl Schedule {
    /// Creates the schedule of cycles that begin at `first`, `first + period` and so on, ns.
    pub fn new(first: u64, period: u64) -> Self {
        Self { next: first, period, origin: first, margin: period / 2 }
    }

    /// Creates the schedule of one of several threads. `of` is the number of threads, and `place` is the thread's place
    /// among them, 0 to `of` - 1. The beginnings of the threads' cycles are spread evenly over the period, because the
    /// threads share cores and other resources.
    pub fn staggered(first: u64, period: u64, place: usize, of: usize) -> Self {
        let next = first + period * place as u64 / of as u64;
        Self { next, period, origin: first, margin: period / (2 * of as u64) }
    }

    /// Delays the whole schedule by `by` ns, including the beginning of period 0.
    pub fn delay(&mut self, by: u64) {
        self.next += by;
        self.origin += by;
    }

    /// Returns the number of the period that contains `time`, ns. A time that is at most `margin` before the beginning
    /// of a period already counts as part of this period. The threads of a hand count the same periods, from the start
    /// that their schedules have in common. [`Schedule::shift`] moves the cycles but not the periods that are counted.
    /// If a schedule follows another clock, its cycles therefore skip or repeat a number now and then.
    pub fn number(&self, time: u64) -> u64 {
        (time + self.margin).saturating_sub(self.origin) / self.period
    }

    /// Returns the time at which the next cycle begins, ns.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// Returns the length of a period, ns.
    pub fn period(&self) -> u64 {
        self.period
    }

    /// Moves to the next cycle, after a cycle that ended at `now`, ns. Skips whole periods that have already passed, so
    /// that no burst of cycles follows. Returns the number of skipped periods.
    pub fn advance(&mut self, now: u64) -> u64 {
        self.next += self.period;
        let skipped = now.saturating_sub(self.next) / self.period;
        self.next += skipped * self.period;
        skipped
    }

    /// Delays the next beginning, and all that follow, by `by` ns. A negative `by` makes them earlier.
    pub fn shift(&mut self, by: i64) {
        self.next = self.next.saturating_add_signed(by);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_cycle_in_time_moves_one_period() {
        let mut schedule = Schedule::new(1000, 100);
        assert_eq!((schedule.advance(1050), schedule.next()), (0, 1100));
        // The cycle ended after the next beginning. The next cycle starts late, but it is not lost.
        assert_eq!((schedule.advance(1250), schedule.next()), (0, 1200));
        // The cycle ended more than a whole period late, so periods are skipped.
        assert_eq!((schedule.advance(1617), schedule.next()), (3, 1600));
    }

    #[test]
    fn threads_begin_as_far_from_each_other_as_they_can() {
        let beginnings = |of| (0..of).map(|place| Schedule::staggered(5000, 900, place, of).next()).collect::<Vec<_>>();
        assert_eq!(beginnings(1), [5000]);
        assert_eq!(beginnings(2), [5000, 5450]);
        assert_eq!(beginnings(3), [5000, 5300, 5600]);
    }

    #[test]
    fn all_threads_count_the_same_periods() {
        for place in 0..3 {
            let mut schedule = Schedule::staggered(0, 900, place, 3);
            schedule.delay(10_000);
            for period in 0..5 {
                assert_eq!(schedule.number(schedule.next()), period, "place {place}");
                // A shift by less than half the stagger does not change the number.
                assert_eq!(schedule.number(schedule.next() - 149), period);
                assert_eq!(schedule.number(schedule.next() + 149), period);
                schedule.advance(schedule.next() + 100);
            }
            // A late cycle skips numbers.
            schedule.advance(schedule.next() + 2000);
            assert_eq!(schedule.number(schedule.next()), 7);
        }
    }

    proptest! {
        #[test]
        fn beginnings_stay_on_the_grid_and_periods_are_accounted_for(
            ends in proptest::collection::vec(0u64..5_000, 1..50), period in 1u64..1000,
        ) {
            let mut schedule = Schedule::new(0, period);
            let (mut now, mut periods) = (0, 0);
            for (cycle, lasted) in ends.iter().enumerate() {
                now = now.max(schedule.next()) + lasted;
                periods += 1 + schedule.advance(now);
                prop_assert_eq!(schedule.next(), periods * period);
                prop_assert!(schedule.next() + period > now, "a passed period is not skipped after cycle {}", cycle);
            }
        }
    }
}

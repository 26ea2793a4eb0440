//! The age of what the server has measured, without a clock that both ends share.

/// Length of the window over which the smallest delay is determined, ns. Two clocks whose rates differ by 100 ppm
/// diverge by 1 ms in one window.
const WINDOW: u64 = 10_000_000_000;

/// Estimates the difference of the server's clock and the clock of this process: the smallest difference between the
/// reception of a State and its publication, over the last one to two windows. The age of a message therefore includes
/// its delay on the way, less the smallest delay of the line.
#[derive(Clone, Debug, Default)]
pub struct ServerClock {
    /// The smallest difference in the previous window, and the smallest difference in this window, ns.
    smallest: [Option<i64>; 2],
    /// The beginning of this window, ns of the clock of this process.
    begin: u64,
}

impl ServerClock {
    /// Notes that a message with this time of publication, ns of the server's clock, was received now.
    pub fn received(&mut self, published: u64, now: u64) {
        if self.smallest[1].is_none() || now.saturating_sub(self.begin) > WINDOW {
            self.smallest = [self.smallest[1], None];
            self.begin = now;
        }
        let difference = now.wrapping_sub(published) as i64;
        self.smallest[1] = Some(self.smallest[1].map_or(difference, |smallest| smallest.min(difference)));
    }

    /// Returns the age of something that happened at this time, ns of the server's clock. Returns none if nothing was
    /// received yet.
    pub fn age(&self, happened: u64, now: u64) -> Option<u64> {
        let smallest = self.smallest.iter().flatten().min()?;
        let difference = now.wrapping_sub(happened) as i64;
        Some(u64::try_from(difference.wrapping_sub(*smallest)).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn the_age_does_not_depend_on_the_difference_of_the_clocks() {
        for server in [0, 5_000_000 * MS, u64::MAX - 1_000_000 * MS] {
            let mut clock = ServerClock::default();
            assert_eq!(clock.age(server, 7 * MS), None);
            clock.received(server, 7 * MS);
            assert_eq!(clock.age(server, 7 * MS), Some(0));
            assert_eq!(clock.age(server, 50 * MS), Some(43 * MS));
        }
    }

    #[test]
    fn a_message_that_was_delayed_is_old() {
        let mut clock = ServerClock::default();
        clock.received(1000 * MS, 2000 * MS);
        clock.received(1010 * MS, 2310 * MS);
        assert_eq!(clock.age(1010 * MS, 2310 * MS), Some(300 * MS));
    }

    #[test]
    fn clocks_that_diverge_do_not_age_new_messages() {
        let mut clock = ServerClock::default();
        for step in 0..360_000u64 {
            // In an hour of States every 10 ms, the server's clock falls 360 ms behind.
            clock.received(step * 9_999_000, step * 10 * MS);
            let age = clock.age(step * 9_999_000, step * 10 * MS).expect("an age");
            assert!(age <= 2_100_000, "step {step}: {age} ns");
        }
    }

    #[test]
    fn a_time_in_the_future_has_the_age_0() {
        let mut clock = ServerClock::default();
        clock.received(1000 * MS, 2000 * MS);
        assert_eq!(clock.age(1100 * MS, 2000 * MS), Some(0));
    }
}

//! The measured rate of a finger's servo.

use sun2xp_remote_client::Record;

/// The two records from which the measured rate of a finger is computed: the first and the newest record that this
/// client has noted since the server started.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MeasuredRate(Option<(Record, Record)>);

impl MeasuredRate {
    /// Notes the newest record of the finger.
    pub fn note(&mut self, newest: &Record) {
        // If the server was started again, its cycles begin at 1. If the machine of the server was started again, its
        // clock begins anew too.
        let continues = |before: &Record| newest.cycle >= before.cycle && newest.begin >= before.begin;
        let first = self.0.filter(|(_, before)| continues(before)).map_or(*newest, |(first, _)| first);
        self.0 = Some((first, *newest));
    }

    /// Cycles per second, Hz; NaN until records of two cycles were noted.
    pub fn rate(&self) -> f64 {
        let Some((first, newest)) = &self.0 else { return f64::NAN };
        let seconds = (newest.begin - first.begin) as f64 * 1e-9;
        if seconds > 0.0 { (newest.cycle - first.cycle) as f64 / seconds } else { f64::NAN }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use sun2xp_remote_client::{Finger, Stage};

    pub(crate) fn record(cycle: u64, seconds: u64) -> Record {
        Record {
            finger: Finger::ALL[0],
            stage: Stage::Running,
            command: 0,
            cycle,
            begin: seconds * 1_000_000_000,
            touching: false,
            caught: false,
            arrived: false,
            settled: false,
            joints: [0.0; 3],
            set_point: None,
            tip: [0.0; 3],
            force: [0.0; 3],
            tensions: [0.0; 4],
        }
    }

    fn measured(records: &[(u64, u64)]) -> f64 {
        let mut rate = MeasuredRate::default();
        records.iter().for_each(|&(cycle, seconds)| rate.note(&record(cycle, seconds)));
        rate.rate()
    }

    #[test]
    fn the_rate_follows_from_the_first_and_the_newest_record() {
        assert!(measured(&[]).is_nan() && measured(&[(1, 9)]).is_nan());
        assert_eq!(measured(&[(1, 9), (501, 10), (1001, 11)]), 500.0);
    }

    #[test]
    fn a_server_that_was_started_again_is_measured_anew() {
        assert_eq!(measured(&[(9000, 9), (1, 20), (1001, 21)]), 1000.0);
        // After the restart, the cycle number is higher than that of the first record, but lower than that of the
        // previous record.
        assert_eq!(measured(&[(5, 1), (9005, 10), (3000, 20), (4000, 21)]), 1000.0);
        // The machine of the server was started again.
        assert_eq!(measured(&[(9000, 90), (9500, 3), (10_500, 4)]), 1000.0);
    }
}

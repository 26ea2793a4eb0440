//! Repeats real-time tests that a pause of the machine can spoil.

use crate::pauses::PauseWatch;
use std::io::Write;
use std::time::Duration;

/// Largest number of failures that are excused.
const EXCUSED_AT_MOST: u32 = 3;

/// The results of the attempts so far.
#[derive(Default)]
pub struct Tally {
    pub passed: u32,
    pub excused: u32,
}

/// What follows from an attempt.
#[derive(Debug, PartialEq, Eq)]
pub enum Verdict {
    /// More attempts passed than failed.
    Passed,
    Again,
    /// No pause explains the failure.
    Failed,
    /// Pauses explain the failures, but too many attempts have failed.
    Hopeless,
}

impl Tally {
    /// Judges an attempt. `paused` is the longest pause of the machine, and a pause of `tolerated` or longer excuses a
    /// failure. For every excused failure another attempt has to pass, so that an intermittent defect cannot hide
    /// behind a machine that always pauses.
    pub fn judge(&mut self, passed: bool, paused: Duration, tolerated: Duration) -> Verdict {
        match passed {
            true => self.passed += 1,
            false if paused < tolerated => return Verdict::Failed,
            false => self.excused += 1,
        }
        if self.passed > self.excused {
            Verdict::Passed
        } else if self.excused > EXCUSED_AT_MOST {
            Verdict::Hopeless
        } else {
            Verdict::Again
        }
    }
}

/// Makes attempts until more have passed than failed, and returns the results of those that passed. An attempt may fail
/// only if the machine was measured to pause the hand or its boards for at least `tolerated`. The attempt gets the
/// watch, so that it can name the processes of its boards.
///
/// # Panics
/// Panics if an attempt fails without such a pause, or if more than three fail.
pub fn attempts<T>(
    what: &str,
    tolerated: Duration,
    mut attempt: impl FnMut(&PauseWatch) -> Result<T, String>,
) -> Vec<T> {
    let (mut tally, mut found) = (Tally::default(), Vec::new());
    loop {
        let watch = PauseWatch::start();
        let result = attempt(&watch);
        let waits = watch.end();
        let measured = waits.description(tolerated);
        let verdict = tally.judge(result.is_ok(), waits.most_within(tolerated), tolerated);
        let count = format!("{what}: {} passed, {} excused", tally.passed, tally.excused);
        match (result, verdict) {
            (Err(failure), Verdict::Failed) => {
                panic!("{count}; {failure}. No pause of the machine explains it: {measured}")
            }
            (Err(failure), Verdict::Hopeless) => panic!("{count}; {failure}. The machine pauses too often: {measured}"),
            // This line is written to the stream itself, which is not captured. So the test report shows the excused
            // failures.
            (Err(failure), _) => drop(writeln!(std::io::stderr(), "{count}: {measured}; {failure}")),
            (Ok(value), verdict) => {
                println!("{count}: {measured}");
                found.push(value);
                if verdict == Verdict::Passed {
                    return found;
                }
            }
        }
    }
}

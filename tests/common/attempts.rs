//! Attempts at something in real time that a pause of the machine can spoil.

use crate::pauses::PauseWatch;
use std::io::Write;
use std::time::Duration;

/// More failures than this are not excused, whatever the machine did.
const EXCUSED_AT_MOST: u32 = 3;

/// How attempts have ended so far.
#[derive(Default)]
pub struct Tally {
    pub passed: u32,
    pub excused: u32,
}

/// What follows from an attempt.
#[derive(Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Passed attempts outnumber those that failed.
    Passed,
    Again,
    /// No pause explains the failure.
    Failed,
    /// The pauses do, but there were too many.
    Hopeless,
}

impl Tally {
    /// Judges an attempt during which the machine paused for so long, and which fails by itself only if nothing is
    /// paused for as long as it `bears`. Every excused failure has to be made up for by a passed attempt, so that a
    /// defect that shows in some attempts only does not hide behind a machine that always pauses.
    pub fn judge(&mut self, passed: bool, paused: Duration, bears: Duration) -> Verdict {
        match passed {
            true => self.passed += 1,
            false if paused < bears => return Verdict::Failed,
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

/// Makes attempts until more have passed than failed, and returns what the passed ones found. An attempt may fail only
/// if the machine was measured to pause the hand and its boards for as long as the attempt `bears`, or longer. The
/// attempt gets the watch so that it can name the processes of its boards.
///
/// # Panics
/// If an attempt fails without such a pause, or if more than three fail.
pub fn attempts<T>(what: &str, bears: Duration, mut attempt: impl FnMut(&PauseWatch) -> Result<T, String>) -> Vec<T> {
    let (mut tally, mut found) = (Tally::default(), Vec::new());
    loop {
        let watch = PauseWatch::start();
        let result = attempt(&watch);
        let waits = watch.end();
        let told = waits.told(bears);
        let verdict = tally.judge(result.is_ok(), waits.most_within(bears), bears);
        let count = format!("{what}: {} passed, {} excused", tally.passed, tally.excused);
        match (result, verdict) {
            (Err(failure), Verdict::Failed) => {
                panic!("{count}; {failure}. No pause of the machine explains it: {told}")
            }
            (Err(failure), Verdict::Hopeless) => panic!("{count}; {failure}. The machine pauses too often: {told}"),
            // Not captured: who reads the result of the tests is to see what was excused.
            (Err(failure), _) => drop(writeln!(std::io::stderr(), "{count}: {told}; {failure}")),
            (Ok(value), verdict) => {
                println!("{count}: {told}");
                found.push(value);
                if verdict == Verdict::Passed {
                    return found;
                }
            }
        }
    }
}

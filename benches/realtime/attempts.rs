//! Measurements that other work on the machine can disturb. A disturbed measurement is repeated, but not for ever.

use std::fmt::{self, Display};

/// A measurement that fails is repeated, until this number of measurements has failed in total. Later ones are skipped.
pub const MOST_FAILED: usize = 10;

/// What has become of the measurements.
#[derive(Default)]
pub struct Attempts {
    /// Number of measurements that have failed.
    pub failed: usize,
    /// Number of measurements that were not made, or not repeated, because too many had failed.
    pub skipped: usize,
}

impl Attempts {
    /// Measures until a measurement succeeds. Returns none if too many have failed. `name` names what is measured.
    pub fn measure<T, E: Display>(&mut self, name: &str, mut measure: impl FnMut() -> Result<T, E>) -> Option<T> {
        while self.failed < MOST_FAILED {
            match measure() {
                Ok(measured) => return Some(measured),
                Err(reason) => {
                    self.failed += 1;
                    eprintln!("{name}: {reason}. Other work on the machine can cause this.");
                }
            }
        }
        self.skipped += 1;
        None
    }

    /// Checks that every entry has at least one measurement that has succeeded. An entry is a name and the number of
    /// measurements that have succeeded.
    ///
    /// # Errors
    /// Returns the names of the entries without a measurement that has succeeded.
    pub fn check<'a>(&self, measured: impl IntoIterator<Item = (&'a str, usize)>) -> Result<(), String> {
        let missing = measured.into_iter().filter(|&(_, number)| number == 0).map(|(name, _)| name);
        let missing = missing.collect::<Vec<_>>().join(", ");
        if missing.is_empty() {
            return Ok(());
        }
        let Self { failed, skipped } = self;
        Err(format!(
            "there is no result for {missing}: {failed} measurements failed, and {skipped} were skipped. Measure \
             again when the machine has no other work"
        ))
    }
}

impl Display for Attempts {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { failed, skipped } = self;
        write!(f, "{failed} measurements failed, and {skipped} were skipped because too many had failed")
    }
}

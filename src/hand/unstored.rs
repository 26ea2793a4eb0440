//! The calibration results of an open hand that are not in its configuration file yet.

use crate::hand::Found;
use crate::model::FingerNumber;
use crate::realtime::Mutex;
use std::sync::Arc;

/// Results that are not stored yet, at most one entry for each finger. Clones share the results.
#[derive(Clone, Debug, Default)]
pub(super) struct Unstored(Arc<Mutex<Vec<Found>>>);

impl Unstored {
    /// Adds the results of a calibration, if there are any.
    pub fn add(&self, found: Found) {
        if found.values().is_empty() {
            return;
        }
        let mut all = self.0.lock();
        match all.iter_mut().find(|before| before.finger() == found.finger()) {
            Some(before) => before.add(found),
            None => all.push(found),
        }
    }

    pub fn of(&self, finger: FingerNumber) -> Option<Found> {
        self.0.lock().iter().find(|found| found.finger() == finger).cloned()
    }

    /// Removes the results of a finger that have been stored. If results of the same finger have been added since, all
    /// its results stay, the stored ones too.
    pub fn remove(&self, stored: &Found) {
        self.0.lock().retain(|found| found != stored);
    }
}

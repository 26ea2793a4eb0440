//! Writes the calibration results of an open hand into its configuration file.

use crate::hand::calibration_file::store_findings;
use crate::hand::unstored::Unstored;
use crate::hand::{Found, Hand, HandError};
use crate::model::FingerNumber;
use std::path::PathBuf;

impl Hand {
    /// Uses `store_findings` to write calibration results of finger 1, 2 or 3 into the configuration file with which
    /// the hand was opened. It writes the results that no earlier call has written. Returns false if the hand was
    /// opened without a configuration file, or if there is nothing to write.
    ///
    /// # Errors
    /// Returns an error if there is no such finger. Returns [`HandError::NotStored`] with the reason if the file cannot
    /// be written. Then the results stay in force until the hand is closed, and a later call stores them.
    pub fn store_calibration(&self, finger: i32) -> Result<bool, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?;
        self.to_store(finger).map_or(Ok(false), |calibration| calibration.store().map(|()| true))
    }

    /// Returns the results that [`Hand::store_calibration`] would write, with the file. The caller writes them. It need
    /// not keep the hand locked for this.
    pub(crate) fn to_store(&self, finger: FingerNumber) -> Option<ToStore> {
        let file = self.file.clone()?;
        Some(ToStore { file, found: self.unstored.of(finger)?, unstored: self.unstored.clone() })
    }
}

/// Results, and the file to store them in.
pub(crate) struct ToStore {
    file: PathBuf,
    found: Found,
    unstored: Unstored,
}

impl ToStore {
    pub(crate) fn store(&self) -> Result<(), HandError> {
        let finger = self.found.finger();
        let not_stored = |source| HandError::NotStored { finger, source };
        store_findings(&self.file, std::slice::from_ref(&self.found)).map_err(not_stored)?;
        self.unstored.remove(&self.found);
        Ok(())
    }
}

//! The self-test: checks the wiring of fingers, at open and when a program asks for it.

use crate::calibration::{Progress, Task};
use crate::hand::{Calibrating, CalibrationState, Hand, HandError};
use std::thread::sleep;
use std::time::Duration;

/// Interval at which the tests are polled.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

impl Hand {
    /// Checks the wiring of finger 1, 2 or 3, and the scales of its gauges relative to each other, within two seconds.
    /// Every motor pulls its tendon with a few times `tendon.minimum`. The finger must be calibrated and free, and no
    /// object may be in its way. The finger is limp afterwards.
    ///
    /// `progress` is called 200 times per second.
    ///
    /// # Errors
    /// Returns [`HandError::WrongWiring`] if something is wrong, with the part and the remedy. Returns the errors of
    /// [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn self_test(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<(), HandError> {
        self.calibrate(finger, Task::SelfTest, progress).map(drop).map_err(HandError::of_self_test)
    }

    /// Checks every opened finger at the same time. The fingers are limp before, and springs afterwards.
    pub(super) fn test_every_finger(&self) -> Result<(), HandError> {
        let fingers = self.fingers().numbers();
        let tests = fingers.map(|finger| Calibrating::begin_at_open(self, finger)).collect::<Result<Vec<_>, _>>();
        let mut tests = tests.map_err(HandError::of_self_test)?;
        while !tests.is_empty() {
            let mut left = Vec::new();
            for mut test in tests {
                if let CalibrationState::InProgress(_) = test.poll(self).map_err(HandError::of_self_test)? {
                    left.push(test);
                }
            }
            tests = left;
            sleep(POLL_INTERVAL);
        }
        Ok(())
    }
}

impl HandError {
    /// Converts the error of a calibration to the error of a self-test.
    fn of_self_test(self) -> Self {
        match self {
            Self::Calibration { finger, obstacle, .. } => Self::WrongWiring { finger, obstacle },
            other => other,
        }
    }
}

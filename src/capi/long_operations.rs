//! Operations on a hand that take long. They unlock the hand between two polls, so that it can be closed and other
//! calls work meanwhile.

use crate::calibration::Task;
use crate::capi::hand_table::{command, remote_to_command, with};
use crate::capi::handle::Handle;
use crate::capi::refusal::Refusal;
use crate::hand::{self, Calibrating, CalibrationState, Recovering, Until, Waiting};
use std::thread::sleep;
use std::time::Duration;

/// Polling period of a calibration or recovery.
const POLLING_PERIOD: Duration = Duration::from_millis(5);

/// Polling period of a wait for fingers.
const WAITING_PERIOD: Duration = Duration::from_millis(1);

/// Makes a faulted finger a spring again.
pub(super) fn recover(handle: Handle, finger: i32) -> Result<(), Refusal> {
    let recovering = command(handle, |hand| Recovering::begin(hand, finger))?;
    // The hand is not locked during this step, because ports are slow.
    let result = recovering.reconnect();
    // If the hand was closed meanwhile, `command` refuses because the hand is not open, and `result` is ignored.
    command(handle, |_| result)?;
    while !command(handle, |hand| recovering.poll(hand))? {
        sleep(POLLING_PERIOD);
    }
    Ok(())
}

/// Waits until the condition holds for these fingers.
pub(super) fn wait(handle: Handle, fingers: &[i32], until: Until, limit: Duration) -> Result<(), Refusal> {
    let waiting = with(handle, |hand| Waiting::begin(hand, fingers, until, limit))?;
    while !with(handle, |hand| waiting.poll(hand))? {
        sleep(WAITING_PERIOD);
    }
    Ok(())
}

/// Calibrates a finger and stores the results.
pub(super) fn calibrate(handle: Handle, finger: i32, task: Task) -> Result<(), Refusal> {
    if let Some(remote) = remote_to_command(handle)? {
        return Ok(remote.calibrate(finger, task)?);
    }
    let mut calibrating = command(handle, |hand| Calibrating::begin(hand, finger, task))?;
    while let CalibrationState::InProgress(_) = command(handle, |hand| calibrating.poll(hand))? {
        sleep(POLLING_PERIOD);
    }
    // The hand is not locked here, so that closing it waits neither for a slow disk nor for other processes that store
    // a calibration.
    match with(handle, |hand| Ok::<_, hand::HandError>(hand.to_store(finger.try_into()?)))? {
        Some(calibration) => Ok(calibration.store()?),
        None => Ok(()),
    }
}

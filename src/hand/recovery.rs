//! Recovery after a fault: ports are opened again, handshakes are repeated, and the finger takes up slack as after
//! opening.
//!
//! The servo releases its link when every finger on it is at rest, because opening a port and shaking hands take too
//! long for a servo. A recovery call does both on the planner's thread. If `finger.reconnect` is set, a separate thread
//! tries both before that.

use crate::finger::{Stage, stop_calls};
use crate::hand::reconnection::RepairablePort;
use crate::hand::{Hand, HandError, RecoveryError};
use crate::model::FingerNumber;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// If another finger of the port was not faulted at the beginning, a recovery waits this long for the link before it
/// returns an error. That finger may be about to fault too. The servo then releases the link within this time.
const RELEASE_LIMIT: Duration = Duration::from_millis(500);

/// Interval at which a recovery is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// A servo releases or takes back a link within some cycles. After this time the servo is considered stalled.
const STALL_LIMIT: Duration = Duration::from_secs(5);

/// A recovery in progress. It has three steps: begin, reconnect and poll. Only `reconnect` takes long, and it does not
/// need the hand.
#[must_use = "a recovery does nothing before `reconnect` is called"]
pub struct Recovering {
    /// `None` if the finger is not faulted. Then there is nothing to do.
    task: Option<Task>,
    begun: Instant,
}

struct Task {
    finger: FingerNumber,
    port: Arc<RepairablePort>,
    /// Number of recoveries of the finger at the beginning.
    recoveries: u32,
    /// Every finger of the port, with its number of recoveries at the beginning.
    fingers: Vec<(FingerNumber, u32)>,
    /// A finger of `fingers` that was not faulted at the beginning.
    running: Option<FingerNumber>,
    stop_calls: u32,
}

impl Recovering {
    /// Notes the state of finger 1, 2 or 3 and of every other finger on its port. If the finger is not faulted, the
    /// other steps do nothing.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn begin(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let begun = Instant::now();
        // An emergency stop call after this point stops the recovered finger.
        let stop_calls = stop_calls();
        let port = hand.recovery.ports.iter().find(|port| port.fingers.contains(&finger));
        let report = hand.dispatcher.last_report(finger)?;
        let port = port.ok_or(HandError::NotOpened(finger))?.clone();
        if !matches!(report.stage, Stage::Faulted(_)) {
            return Ok(Self { task: None, begun });
        }
        let (mut fingers, mut running) = (Vec::new(), None);
        for &finger in &port.fingers {
            let report = hand.dispatcher.last_report(finger)?;
            fingers.push((finger, report.recoveries));
            running = running.or((!matches!(report.stage, Stage::Faulted(_))).then_some(finger));
        }
        let recoveries = report.recoveries;
        Ok(Self { task: Some(Task { finger, port, recoveries, fingers, running, stop_calls }), begun })
    }

    /// Repairs the connection of the finger, and makes every faulted finger of the port take up slack. This opens ports
    /// and shakes hands, which may take a second. Only calls that repair the same port or close the hand wait for it.
    ///
    /// # Errors
    /// Returns an error if another finger runs on the same port, if the port or a board does not work, if a board is
    /// not the same as at open, if the servo has failed or does not run, or if the hand was closed.
    pub fn reconnect(&self) -> Result<(), HandError> {
        let Some(Task { finger, ref port, recoveries, running, stop_calls, .. }) = self.task else { return Ok(()) };
        let waiting = Instant::now();
        loop {
            if let Some(repair) = &mut *port.repair.lock() {
                if port.repairs.load(Ordering::Acquire) != recoveries {
                    // Another caller has recovered a finger of the same port. Perhaps the servo has not taken the link
                    // back yet.
                    return Ok(());
                }
                if repair.servo_ended() {
                    return Err(RecoveryError::ServoEnded(finger).into());
                }
                if repair.take_link() {
                    let configured = repair.restore()?;
                    // The repair is counted before the servo gets the link, so that no finger has more recoveries than
                    // its port has repairs.
                    port.repairs.fetch_add(1, Ordering::Release);
                    repair.give_back(configured, stop_calls);
                    return Ok(());
                }
            } else {
                return Err(HandError::NoAnswer(finger));
            }
            if let Some(refusal) = not_released(finger, running, waiting.elapsed()) {
                return Err(refusal.into());
            }
            sleep(POLL_INTERVAL);
        }
    }

    /// Returns whether every finger of the port holds its pose.
    ///
    /// # Errors
    /// Returns an error if a finger of the port faults again, or if its servo does not take the link back.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let mut done = true;
        for &(finger, before) in self.task.iter().flat_map(|task| &task.fingers) {
            let report = hand.dispatcher.last_report(finger)?;
            match report.stage {
                Stage::Faulted(_) if report.recoveries == before => {
                    if self.begun.elapsed() > STALL_LIMIT {
                        return Err(HandError::NoAnswer(finger));
                    }
                    done = false;
                }
                Stage::Faulted(fault) => return Err(HandError::Faulted { finger, fault }),
                stage => done &= stage != Stage::Opening,
            }
        }
        Ok(done)
    }
}

/// The error for a servo that has not released the link of a finger within the permitted time; `None` before that.
/// `running` is another finger of the port that was not faulted at the beginning.
fn not_released(finger: FingerNumber, running: Option<FingerNumber>, waited: Duration) -> Option<RecoveryError> {
    match running {
        Some(other) if waited > RELEASE_LIMIT => Some(RecoveryError::PortInUse { finger, other }),
        None if waited > STALL_LIMIT => Some(RecoveryError::ServoStalled(finger)),
        _ => None,
    }
}

impl Hand {
    /// Makes a faulted finger 1, 2 or 3 a spring again, which holds its present pose at its initial stiffness. The
    /// other faulted fingers on its port recover too. The cause of the fault must be removed first. Does nothing if
    /// the finger is not faulted.
    ///
    /// # Errors
    /// Returns the errors of [`Recovering::begin`], [`Recovering::reconnect`] and [`Recovering::poll`].
    pub fn recover(&self, finger: i32) -> Result<(), HandError> {
        let recovering = Recovering::begin(self, finger)?;
        recovering.reconnect()?;
        while !recovering.poll(self)? {
            sleep(POLL_INTERVAL);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_finger_that_runs_is_said_to_use_the_port() {
        for waited in [0, 100, 400].map(Duration::from_millis) {
            assert!(
                not_released(FingerNumber::ONE, None, waited).is_none()
                    && not_released(FingerNumber::ONE, Some(FingerNumber::TWO), waited).is_none()
            );
        }
        assert!(matches!(
            not_released(FingerNumber::ONE, Some(FingerNumber::TWO), 2 * RELEASE_LIMIT),
            Some(RecoveryError::PortInUse { finger: FingerNumber::ONE, other: FingerNumber::TWO })
        ));
        // This is the only finger of its port, and its servo does not run for a while.
        assert!(not_released(FingerNumber::ONE, None, 2 * RELEASE_LIMIT).is_none());
        let text = not_released(FingerNumber::ONE, None, 2 * STALL_LIMIT).expect("too long").to_string();
        assert!(text.contains("no processor time") && text.contains("reduce the load"), "{text}");
    }
}

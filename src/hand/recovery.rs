//! Going on after a fault: ports are opened again, boards shake hands anew, and the finger comes under tension as after
//! OpenHand.
//!
//! The servo lends its link for that when every finger on it is at rest, because opening a port and shaking hands take
//! long. They happen on the planner's thread, in a recover call, and before that on a thread of their own where
//! `finger.reconnect` asks for it.

use crate::finger::{Stage, stop_calls};
use crate::hand::reconnection::Place;
use crate::hand::{Hand, HandError, RecoveryError};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A servo lends its link so long after the last of its fingers faulted, at most. It may be about to fault too.
const LENDING: Duration = Duration::from_millis(500);

/// How often a recovery is looked at.
const LOOKING: Duration = Duration::from_millis(2);

/// A servo lends or takes back a link within some cycles. One that has not after so long does not run.
const TAKING_BACK: Duration = Duration::from_secs(5);

/// A recovery under way, in three steps, of which only the second takes long, and needs no hand.
pub struct Recovering {
    /// Nothing is to be done without one.
    task: Option<Task>,
    begun: Instant,
}

struct Task {
    finger: i32,
    place: Arc<Place>,
    /// How often the finger had recovered.
    recoveries: u32,
    /// Every finger of the port, with how often it had recovered before.
    fingers: Vec<(i32, u32)>,
    /// One of them that was not faulted.
    running: Option<i32>,
    stop_calls: u32,
}

impl Recovering {
    /// Notes how finger 1, 2 or 3 stands, with every other finger of its port. Nothing is to be done for a finger that
    /// is not faulted.
    ///
    /// # Errors
    /// No such finger.
    pub fn begin(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        let begun = Instant::now();
        // An emergency stop from here on counts.
        let stop_calls = stop_calls();
        let place = hand.recovery.places.iter().find(|place| place.fingers.contains(&finger));
        let report = hand.report(finger)?;
        let place = place.ok_or(HandError::NotOpened(finger))?.clone();
        if !matches!(report.stage, Stage::Faulted(_)) {
            return Ok(Self { task: None, begun });
        }
        let (mut fingers, mut running) = (Vec::new(), None);
        for &finger in &place.fingers {
            let report = hand.report(finger)?;
            fingers.push((finger, report.recoveries));
            running = running.or((!matches!(report.stage, Stage::Faulted(_))).then_some(finger));
        }
        let recoveries = report.recoveries;
        Ok(Self { task: Some(Task { finger, place, recoveries, fingers, running, stop_calls }), begun })
    }

    /// Mends what the finger is connected by and lets it take up slack, with every other finger of the port. Ports are
    /// opened and hands shaken here: it may take a second. Only those wait for it who mend the same port or close the
    /// hand.
    ///
    /// # Errors
    /// A finger that runs on the same port; a port or board that does not serve, or is another than at open; a servo
    /// that has failed or does not run; a hand that was closed.
    pub fn mend(&self) -> Result<(), HandError> {
        let Some(Task { finger, ref place, recoveries, running, stop_calls, .. }) = self.task else { return Ok(()) };
        let waiting = Instant::now();
        loop {
            if let Some(workshop) = &mut *place.workshop.lock() {
                if place.mended.load(Ordering::Acquire) != recoveries {
                    // Somebody who recovers a finger of the same port was faster. Perhaps the servo has not taken it
                    // back yet.
                    return Ok(());
                }
                if workshop.servo_ended() {
                    return Err(RecoveryError::ServoEnded(finger).into());
                }
                if workshop.fetch() {
                    let configured = workshop.mend()?;
                    // First, so that no finger has recovered more often than its port was mended.
                    place.mended.fetch_add(1, Ordering::Release);
                    workshop.give_back(configured, stop_calls);
                    return Ok(());
                }
            } else {
                return Err(HandError::NoAnswer(finger));
            }
            if let Some(refusal) = not_lent(finger, running, waiting.elapsed()) {
                return Err(refusal.into());
            }
            sleep(LOOKING);
        }
    }

    /// Whether every finger of the port holds the pose that it was found in.
    ///
    /// # Errors
    /// A finger that faults again.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let mut done = true;
        for &(finger, before) in self.task.iter().flat_map(|task| &task.fingers) {
            let report = hand.report(finger)?;
            match report.stage {
                Stage::Faulted(_) if report.recoveries == before => {
                    if self.begun.elapsed() > TAKING_BACK {
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

/// What is wrong where a servo has not lent the link of a finger for so long, if that is too long. `running`: another
/// finger of the port, which was not faulted in the beginning.
fn not_lent(finger: i32, running: Option<i32>, waited: Duration) -> Option<RecoveryError> {
    match running {
        Some(other) if waited > LENDING => Some(RecoveryError::PortInUse { finger, other }),
        None if waited > TAKING_BACK => Some(RecoveryError::ServoStalled(finger)),
        _ => None,
    }
}

impl Hand {
    /// Makes a faulted finger 1, 2 or 3 a spring again, that holds the pose it is in at its initial stiffness; and with
    /// it the other faulted fingers on its port. What made it fault must be mended. Does nothing for a finger that is
    /// not faulted.
    ///
    /// # Errors
    /// As [`Recovering::begin`], [`Recovering::mend`] and [`Recovering::poll`].
    pub fn recover(&self, finger: i32) -> Result<(), HandError> {
        let recovering = Recovering::begin(self, finger)?;
        recovering.mend()?;
        while !recovering.poll(self)? {
            sleep(LOOKING);
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
            assert!(not_lent(1, None, waited).is_none() && not_lent(1, Some(2), waited).is_none());
        }
        assert!(matches!(not_lent(1, Some(2), 2 * LENDING), Some(RecoveryError::PortInUse { finger: 1, other: 2 })));
        // A finger alone, whose servo is kept from running for a while.
        assert!(not_lent(1, None, 2 * LENDING).is_none());
        let text = not_lent(1, None, 2 * TAKING_BACK).expect("too long").to_string();
        assert!(text.contains("no processor time") && text.contains("reduce the load"), "{text}");
    }
}

//! Recovery after a fault: ports are opened again, handshakes are repeated, and the finger takes up slack as it does
//! when the hand is opened.
//!
//! The servo releases its link when every finger on it has faulted and all Stop frames are sent, because opening a port
//! and shaking hands take too long for a servo. A recovery call opens the port and shakes hands on an ordinary thread.
//! If `finger.reconnect` is set, a separate thread already tries to open a failed port before the call. Only a recovery
//! call configures boards, because a Configure ends the end state "hold" of a board. If another finger of the port
//! runs, the servo keeps the link and relays the handshake of the recovering finger.

use crate::finger::{FingerReport, Mailbox, Stage, StopCounts, stop_calls};
use crate::hand::reconnection::RepairablePort;
use crate::hand::{Hand, HandError, RecoveryError};
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;
use std::sync::atomic::Ordering;
use std::sync::{Arc, OnceLock};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Interval at which a recovery is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// Time after which a servo that does not respond is considered stalled. A servo that runs needs only some cycles to
/// release a link, or to take back a link or a repaired finger.
const STALL_LIMIT: Duration = Duration::from_secs(5);

/// A recovery in progress. It has three steps: begin, reconnect and poll. Only `reconnect` takes long, and it does not
/// need the hand.
#[must_use = "a recovery does nothing before `reconnect` is called"]
pub struct Recovering {
    finger: FingerNumber,
    /// `None` if the finger is not faulted. Then there is nothing to repair.
    task: Option<Task>,
    /// Time of the first poll. The time limit within which the servo must take back the finger counts from here,
    /// because `reconnect` may have taken long.
    polled: OnceLock<Instant>,
}

struct Task {
    /// Place of the finger among those of the port.
    place: usize,
    port: Arc<RepairablePort>,
    /// For every finger of the port, the number of its recoveries when this recovery began.
    recoveries: [u32; FINGERS],
    /// For every finger of the port, the numbers of requests to stop and of faults before this recovery began.
    stops: [StopCounts; FINGERS],
    /// Whether another finger of the port was not faulted when this recovery began.
    beside_others: bool,
}

impl Recovering {
    /// Notes the state of finger 1, 2 or 3 and of every other finger on its port. If the finger is not faulted, the
    /// other steps only wait for a recovery of another caller. If a finger was stopped before this call and its servo
    /// has not carried out the stop yet, this call waits until the servo has done so. That takes a cycle.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if a servo does not carry out a request to stop within 5 s.
    pub fn begin(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let begun = Instant::now();
        // Requests to stop that are made after this point stop the recovered finger.
        let calls = stop_calls();
        let with_finger = |port: &&Arc<RepairablePort>| port.fingers.contains(&finger);
        hand.dispatcher.member(finger)?;
        let port = hand.recovery.ports.iter().find(with_finger).ok_or(HandError::NotOpened(finger))?.clone();
        let mut task = Task {
            place: 0,
            port: port.clone(),
            recoveries: [0; FINGERS],
            stops: [StopCounts { calls, ..StopCounts::default() }; FINGERS],
            beside_others: false,
        };
        for (place, &member) in port.fingers.iter().enumerate() {
            let mailbox = &hand.dispatcher.member(member)?.mailbox;
            task.stops[place].of_finger = mailbox.stops();
            let report = report_after_stops(mailbox, begun).ok_or(HandError::NoAnswer(member))?;
            let faulted = matches!(report.stage, Stage::Faulted(_));
            if member == finger {
                if !faulted {
                    return Ok(Self { finger, task: None, polled: OnceLock::new() });
                }
                task.place = place;
            }
            task.recoveries[place] = report.recoveries;
            task.beside_others |= !faulted;
        }
        // This count includes the faults of the faulted fingers of the port. If the fingers stop together, a later
        // fault of any finger stops the recovered finger again.
        let faults = hand.recovery.alarm.faults();
        task.stops.iter_mut().for_each(|stops| stops.faults = faults);
        Ok(Self { finger, task: Some(task), polled: OnceLock::new() })
    }

    /// Repairs the connection of the finger, and makes the finger take up slack. If no finger of the port runs, this
    /// call opens the port and shakes hands with all of its boards. That may take a second. Every faulted finger of the
    /// port then takes up slack. Only calls that repair the same port or close the hand wait for this call.
    ///
    /// # Errors
    /// Returns an error if the port or a board does not work, if a board is not the same as at open, if the servo has
    /// failed or does not run, or if the hand was closed.
    pub fn reconnect(&self) -> Result<(), HandError> {
        let Self { finger, task: Some(Task { place, ref port, recoveries, ref stops, beside_others }), .. } = *self
        else {
            return Ok(());
        };
        let waiting = Instant::now();
        // The error of the relayed handshake. It is returned only if the servo does not release the link within one
        // more poll: the other fingers may have faulted meanwhile, and then the servo is about to release the link.
        let mut refusal = None;
        let mut sent = false;
        loop {
            if let Some(repair) = &mut *port.repair.lock() {
                let released = repair.take_link();
                if released {
                    repair.discard_given(&port.repairs);
                }
                if !sent && port.repairs[place].load(Ordering::Acquire) != recoveries[place] {
                    // Another caller has recovered the finger. Perhaps the servo has not taken the link back yet.
                    return Ok(());
                }
                if repair.servo_ended() {
                    return Err(RecoveryError::ServoEnded(finger).into());
                }
                if released {
                    let configured = repair.restore()?;
                    // The repairs are counted before the servo gets the link, so that no finger has more recoveries
                    // than repairs.
                    port.repairs[..port.fingers.len()].iter().for_each(|repairs| {
                        repairs.fetch_add(1, Ordering::Release);
                    });
                    repair.give_back(configured, stops);
                    return Ok(());
                }
                if sent && repair.is_taken() {
                    return Ok(());
                }
                if let Some(refusal) = refusal.take() {
                    return Err(refusal);
                }
                if beside_others && !sent {
                    match repair.restore_beside_others(place, stops[place], &port.repairs[place]) {
                        Ok(given) => sent = given,
                        Err(error) => refusal = Some(error),
                    }
                }
            } else {
                return Err(HandError::NoAnswer(finger));
            }
            if waiting.elapsed() > STALL_LIMIT {
                return Err(RecoveryError::ServoStalled(finger).into());
            }
            sleep(POLL_INTERVAL);
        }
    }

    /// Returns whether every finger that this recovery has repaired holds its pose. A finger of the port that faults
    /// again does not concern the caller, unless it is the finger of this recovery.
    ///
    /// # Errors
    /// Returns an error if the finger faults again, or if the servo of a finger does not take it back.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let mut done = true;
        let Some(Task { port, recoveries, place: own, .. }) = &self.task else { return self.is_spring(hand) };
        let waiting = self.polled.get_or_init(Instant::now);
        for (place, &finger) in port.fingers.iter().enumerate() {
            let before = recoveries[place];
            if place != *own && port.repairs[place].load(Ordering::Acquire) == before {
                continue; // Another finger of the port, which was not repaired.
            }
            let report = hand.dispatcher.last_report(finger)?;
            match report.stage {
                Stage::Faulted(_) if report.recoveries == before => {
                    if waiting.elapsed() > STALL_LIMIT {
                        return Err(HandError::NoAnswer(finger));
                    }
                    done = false;
                }
                Stage::Faulted(fault) if place == *own => return Err(HandError::Faulted { finger, fault }),
                stage => done &= stage != Stage::Opening,
            }
        }
        Ok(done)
    }

    /// Returns whether the finger, which was not faulted at the beginning, no longer takes up slack. Another caller may
    /// have recovered it.
    fn is_spring(&self, hand: &Hand) -> Result<bool, HandError> {
        let finger = self.finger;
        match hand.dispatcher.last_report(finger)?.stage {
            Stage::Faulted(fault) => Err(HandError::Faulted { finger, fault }),
            stage => Ok(stage != Stage::Opening),
        }
    }
}

/// Returns the last report after the servo has carried out the requests to stop. Returns none if the servo does not
/// carry them out within [`STALL_LIMIT`] after `begun`.
fn report_after_stops(mailbox: &Mailbox, begun: Instant) -> Option<FingerReport> {
    loop {
        // The report is read after the requests, so it is not older than they are.
        let stopped = mailbox.is_stopped();
        let report = mailbox.report();
        if !stopped || matches!(report.stage, Stage::Faulted(_) | Stage::Closing | Stage::Closed) {
            return Some(report);
        }
        if begun.elapsed() > STALL_LIMIT {
            return None;
        }
        sleep(POLL_INTERVAL);
    }
}

impl Hand {
    /// Makes a faulted finger 1, 2 or 3 a spring again, which holds its present pose at its initial stiffness. If no
    /// finger on its port runs, the other fingers of the port recover too. The cause of the fault must be removed
    /// first. If the finger is not faulted, the call only waits for a recovery of another caller.
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

    /// Stops finger 1, 2 or 3: it faults at the beginning of its next cycle, and its motors enter the configured end
    /// state. The other fingers continue, also those on the same board, unless `hand.on_fault` is `"hand"`. The finger
    /// stays faulted until it recovers. A finger that has faulted already stays as it is.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn stop(&self, finger: i32) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?.mailbox.stop();
        Ok(())
    }
}

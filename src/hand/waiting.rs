//! Waiting until fingers have arrived at their set points, or have come to rest.

use crate::control::events::Arrival;
use crate::finger::{FingerReport, Stage};
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Interval at which the fingers are polled.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// A condition to wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Until {
    /// Since the set point that was sent last took effect, there was a cycle in which every joint was within
    /// `finger.events.arrived_degrees` of this set point.
    Arrived,
    /// Since the set point that was sent last took effect, there was a time of `finger.events.settled_ms` in which no
    /// joint moved by more than `finger.events.settled_degrees`. A finger that an object blocks settles without
    /// arriving.
    Settled,
}

/// A wait in progress. It does not need the hand between two polls.
#[derive(Clone, Debug)]
pub struct Waiting {
    fingers: Vec<FingerNumber>,
    until: Until,
    /// End of the wait; none if it has no end.
    deadline: Option<Instant>,
}

impl Waiting {
    /// Begins to wait for these fingers, 1 to 3. A limit that is too long for the clock is no limit.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn begin(hand: &Hand, fingers: &[i32], until: Until, limit: Duration) -> Result<Self, HandError> {
        let deadline = Instant::now().checked_add(limit);
        let fingers: Vec<_> = fingers.iter().map(|&finger| finger.try_into()).collect::<Result<_, _>>()?;
        fingers.iter().try_for_each(|&finger| hand.dispatcher.member(finger).map(drop))?;
        Ok(Self { fingers, until, deadline })
    }

    /// Returns whether the condition holds for every finger.
    ///
    /// # Errors
    /// Returns an error if a finger is faulted, or if the condition does not hold when the time limit is over. Returns
    /// an error if a finger is limp or is being calibrated, or if the hand is being closed, because the finger then
    /// follows no set point.
    pub fn poll(&self, hand: &Hand) -> Result<bool, HandError> {
        let late = self.deadline.is_some_and(|deadline| Instant::now() >= deadline);
        let (mut waiting_for, mut refusal) = (None, None);
        for &finger in &self.fingers {
            let member = hand.dispatcher.member(finger)?;
            let (in_force, report) = member.mailbox.newest_in_force();
            let holds = match report.stage {
                Stage::Opening => false,
                Stage::Running => in_force && self.holds(report.arrival),
                Stage::Faulted(_) => return Err(member.refusal(report.stage)),
                // If a finger that follows in the list is faulted, its fault is reported instead of this refusal.
                stage => {
                    refusal = refusal.or(Some(member.refusal(stage)));
                    false
                }
            };
            if !holds {
                waiting_for = waiting_for.or(Some(finger));
            }
        }
        if let Some(refusal) = refusal {
            return Err(refusal);
        }
        match waiting_for {
            Some(finger) if late => Err(HandError::NotThereInTime(finger)),
            waiting_for => Ok(waiting_for.is_none()),
        }
    }

    fn holds(&self, arrival: Arrival) -> bool {
        match self.until {
            Until::Arrived => arrival.arrived,
            Until::Settled => arrival.settled,
        }
    }
}

impl Hand {
    /// The newest report of finger 1, 2 or 3, and whether the set point that was sent last is in force in it.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn newest_in_force(&self, finger: i32) -> Result<(bool, FingerReport), HandError> {
        Ok(self.dispatcher.member(finger.try_into()?)?.mailbox.newest_in_force())
    }

    /// Waits until each of these fingers meets the condition for the set point that was sent to it last. Returns at
    /// once if the condition holds already. After a reflex, the condition must hold for the set point of the reflex in
    /// two cases: the reflex has replaced the set point of the planner, or the planner sent its set point during the
    /// `inhibition` of the reflex, the time after a reaction for which the finger ignores its planner. If the set point
    /// has expired, the condition must be true for the pose in which the finger has stayed since then.
    ///
    /// # Errors
    /// Returns the errors of [`Waiting::begin`] and [`Waiting::poll`].
    pub fn wait(&self, fingers: &[i32], until: Until, limit: Duration) -> Result<(), HandError> {
        let waiting = Waiting::begin(self, fingers, until, limit)?;
        while !waiting.poll(self)? {
            sleep(POLL_INTERVAL);
        }
        Ok(())
    }
}

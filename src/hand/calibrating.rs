//! Calibration of a finger of an open hand: gives the order to the servo, waits for the verdict, and puts the results
//! in force.

use crate::calibration::{Calibration, Findings, Progress, Step, Task, Verdict};
use crate::finger::{Adjustable, CalibrationRun, Fault, Order, Stage};
use crate::hand::admission::Admission;
use crate::hand::{Found, Hand, HandError};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, ConfiguredFinger};
use crate::model::{Section, UnusableConfiguration};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Interval at which the verdict is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// Time after which an order that the servo has not taken is considered lost. A servo takes an order within a cycle.
const ANSWER: Duration = Duration::from_secs(5);

/// A calibration in progress. It runs without further calls; [`Calibrating::poll`] reports its progress.
#[derive(Debug)]
#[must_use = "the results of a calibration are put in force only if it is polled"]
pub struct Calibrating {
    finger: FingerNumber,
    /// While this exists, no other call can calibrate the finger.
    _claim: Claim,
    order: u32,
    /// Number of recoveries of the finger at the beginning.
    recoveries: u32,
    /// Whether the finger stays limp after the results are in force.
    stays_limp: bool,
    /// The results; `None` until the finger is ordered to restart with them.
    found: Option<Findings>,
    asked: Instant,
}

/// The state of a calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "short-lived")]
#[non_exhaustive]
pub enum CalibrationState {
    /// The calibration is in progress.
    InProgress(Progress),
    /// The calibration is done, and its results are in force.
    Done(Findings),
}

/// The exclusive right to calibrate a finger. Between the verdict of a calibration and the use of its results a finger
/// is limp for a moment. Another calibration must not begin then.
#[derive(Debug)]
struct Claim(Arc<AtomicBool>);

impl Claim {
    /// Returns `None` if another caller has the right.
    fn take(claimed: &Arc<AtomicBool>) -> Option<Self> {
        (!claimed.swap(true, Ordering::AcqRel)).then(|| Self(claimed.clone()))
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        self.0.store(false, Ordering::Release);
    }
}

impl Calibrating {
    /// Begins a calibration. With [`Task::Identify`] the joints move between their stops, and the finger presses
    /// against its lower stops. With [`Task::Zero`] its tendons are slack for about a second. The whole range of its
    /// joints must be free. Set points are ignored until the calibration is done.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the finger is faulted or busy, or if the routine cannot work
    /// with the configuration.
    pub fn begin(hand: &Hand, finger: i32, task: Task) -> Result<Self, HandError> {
        let stays_limp = matches!(task, Task::Signs | Task::SelfTest);
        Self::begin_task(hand, finger, task, stays_limp)
    }

    /// Begins the self-test of a finger that becomes a spring afterwards.
    pub(super) fn begin_at_open(hand: &Hand, finger: i32) -> Result<Self, HandError> {
        Self::begin_task(hand, finger, Task::SelfTest, false)
    }

    fn begin_task(hand: &Hand, finger: i32, task: Task, stays_limp: bool) -> Result<Self, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let member = hand.dispatcher.member(finger)?;
        let mut configuration = hand.configuration.read().clone();
        let rate = configuration.hand.rate;
        let refused = |unusable| refusal(finger, unusable);
        let calibration = Calibration::new(task, &configuration.fingers[finger.index()], rate).map_err(refused)?;
        configuration.fingers[finger.index()] = Calibration::controlled(&configuration.fingers[finger.index()], rate);
        let adjustable = Adjustable::new(&configuration, finger).map_err(refused)?;
        let claim = Claim::take(&member.calibrated).ok_or_else(|| match member.mailbox.report().stage {
            Stage::Faulted(fault) => HandError::Faulted { finger, fault },
            _ => HandError::Busy(finger),
        })?;
        let recoveries = member.mailbox.report().recoveries;
        let order = hand.dispatcher.hand_over_calibration(finger, &configuration, adjustable, |adjustable| {
            let run = CalibrationRun { calibration, adjustable };
            Self::ordered(finger, member.mailbox.order(Order::Calibrate(run)))
        })?;
        Ok(Self { finger, _claim: claim, order, recoveries, stays_limp, found: None, asked: Instant::now() })
    }

    fn ordered(finger: FingerNumber, given: Result<Option<u32>, Fault>) -> Result<u32, HandError> {
        given.map_err(|fault| HandError::Faulted { finger, fault })?.ok_or(HandError::Busy(finger))
    }

    /// Returns the state of the calibration. When the routine is done, its results are put in force before `poll`
    /// returns `Done`: tendons are brought under tension, and the finger becomes a spring that holds its pose at its
    /// initial stiffness. After [`Task::Signs`], and after [`Task::SelfTest`] except at open, the finger stays limp.
    /// `poll` must not be called again after `Done`.
    ///
    /// # Errors
    /// Returns an error if the routine fails, if the configuration cannot be used with its results, if the finger
    /// faults, if it has faulted and recovered since the calibration began, if the hand is being closed, or if the
    /// servo does not take the order within 5 s. If the finger faults while it restarts with the results, the results
    /// are in force, and [`Hand::store_calibration`] stores them.
    pub fn poll(&mut self, hand: &Hand) -> Result<CalibrationState, HandError> {
        let finger = self.finger;
        let report = hand.dispatcher.report(finger)?;
        if report.recoveries != self.recoveries {
            // The finger has faulted and recovered between two polls, so this calibration is over. The recovery may
            // have discarded the order of this calibration before the servo took it. Then the report still has the
            // verdict of an earlier calibration. Results that an earlier call of `poll` has put in force stay in force.
            return Err(HandError::Interrupted(finger));
        }
        if report.orders != self.order {
            // The servo has not yet taken the order. If the hand was closed and opened again since the order was given,
            // no servo ever takes it: the new servo has not received this order, and counts its orders from 0.
            if self.asked.elapsed() > ANSWER {
                return Err(HandError::NoAnswer(finger));
            }
            return Ok(CalibrationState::InProgress(Progress { step: Step::TakingUpSlack, part: 0.0 }));
        }
        if let Some(findings) = &self.found {
            if report.stage == Stage::Opening {
                return Ok(CalibrationState::InProgress(Progress { step: Step::TakingUpSlack, part: 1.0 }));
            }
            return Ok(CalibrationState::Done(*findings));
        }
        let in_progress = matches!(report.calibration, None | Some(Verdict::InProgress(_)));
        if in_progress && report.stage != Stage::Calibrating {
            // The hand is being closed, which ends a calibration without a verdict.
            return Err(HandError::Interrupted(finger));
        }
        match report.calibration {
            None => Ok(CalibrationState::InProgress(Progress { step: Step::TakingUpSlack, part: 0.0 })),
            Some(Verdict::InProgress(progress)) => Ok(CalibrationState::InProgress(progress)),
            Some(Verdict::Refused(obstacle)) => {
                Err(HandError::Calibration { finger, limp: report.stage == Stage::Limp, obstacle })
            }
            Some(Verdict::Found(found)) => self.put_in_force(hand, found),
        }
    }

    /// Makes the finger restart with the results of its routine.
    fn put_in_force(&mut self, hand: &Hand, found: Findings) -> Result<CalibrationState, HandError> {
        let finger = self.finger;
        // The lock is held throughout, so that a concurrent adjustment is not lost.
        let mut configuration = hand.configuration.write();
        let mut changed = configuration.clone();
        found.apply(&mut changed.fingers[finger.index()]);
        // An earlier adjustment may have set `stiffness.bound` below the initial stiffness. This check permits that.
        changed.check()?;
        let adjustable = Adjustable::new(&changed, finger).map_err(|unusable| refusal(finger, unusable))?;
        let limp = self.stays_limp;
        let to_store = Found::by_calibration(&found, finger, &changed);
        let member = hand.dispatcher.member(finger)?;
        self.order = hand.dispatcher.hand_over(finger, &changed, adjustable, |adjustable| {
            // The results can change moment arms and tendon stiffness. The checks of set points depend on these values,
            // so they are constructed again.
            let mut checks = member.admission.write();
            let order = Self::ordered(finger, member.mailbox.restart(adjustable, limp))?;
            *checks = Admission::new(&changed, finger);
            Ok(order)
        })?;
        (self.found, self.asked) = (Some(found), Instant::now());
        *configuration = changed;
        drop(configuration);
        // The results are in force even if the finger faults before it has restarted.
        hand.unstored.add(to_store);
        Ok(CalibrationState::InProgress(Progress { step: Step::TakingUpSlack, part: 1.0 }))
    }
}

impl Hand {
    /// Finds the signs of finger 1, 2 or 3: the directions in which its motors turn, and in which its encoders and
    /// gauges count. The finger stays limp.
    ///
    /// `progress` is called 200 times per second.
    ///
    /// # Errors
    /// Returns the errors of [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn find_signs(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Signs, progress)
    }

    /// Zeroes gauges and encoders of finger 1, 2 or 3. `zeroing.method` selects the method for the encoders.
    ///
    /// # Errors
    /// Returns the errors of [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn zero(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Zero, progress)
    }

    /// Measures gauge gains, friction, moment arms, tendon stiffness and rotor inertia of finger 1, 2 or 3. The finger
    /// must have been zeroed.
    ///
    /// # Errors
    /// Returns the errors of [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn identify(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Identify, progress)
    }

    pub(super) fn calibrate(
        &self,
        finger: i32,
        task: Task,
        mut progress: impl FnMut(Progress),
    ) -> Result<Findings, HandError> {
        let mut calibrating = Calibrating::begin(self, finger, task)?;
        loop {
            match calibrating.poll(self)? {
                CalibrationState::InProgress(going) => progress(going),
                CalibrationState::Done(findings) => return Ok(findings),
            }
            sleep(POLL_INTERVAL);
        }
    }

    /// The configuration of finger 1, 2 or 3, with all results of calibrations since open.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn calibrated(&self, finger: i32) -> Result<ConfiguredFinger, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?;
        Ok(self.configuration.read().fingers[finger.index()].clone())
    }

    /// The configuration of the hand, with all results of calibrations since open.
    pub fn configuration(&self) -> Configuration {
        self.configuration.read().clone()
    }
}

fn refusal(finger: FingerNumber, unusable: crate::model::configuration::Unusable) -> HandError {
    UnusableConfiguration { section: Section::Finger(finger), unusable }.into()
}

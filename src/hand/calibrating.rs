//! Calibrating a finger of an open hand: asks its servo, waits for the verdict, puts what was found in force.

use crate::calibration::{Calibration, Findings, Progress, Step, Task, Verdict};
use crate::finger::{Adjustable, CalibrationRun, Fault, Order, Stage};
use crate::hand::calibration_file::store_findings;
use crate::hand::opening::check;
use crate::hand::{Found, Hand, HandError};
use crate::model::UnusableConfiguration;
use crate::model::configuration::ConfiguredFinger;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How often the verdict is looked for.
const LOOKING: Duration = Duration::from_millis(5);

/// A servo takes an order within a cycle; one that has not after so long never will.
const ANSWER: Duration = Duration::from_secs(5);

/// A calibration under way. It goes on by itself; [`Calibrating::poll`] follows it.
#[derive(Debug)]
pub struct Calibrating {
    finger: i32,
    /// Nobody else calibrates the finger until this is dropped.
    _claim: Claim,
    order: u32,
    /// What was found, once the finger is about to be controlled with it.
    found: Option<(Findings, Found)>,
    asked: Instant,
}

/// How a calibration stands.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "looked at and dropped")]
pub enum Standing {
    /// It goes on.
    Going(Progress),
    /// Done, and in force.
    Done(Findings),
}

/// The right to calibrate a finger. A finger is limp for a moment between the verdict of a calibration and the use of
/// what was found: another calibration must not begin then.
#[derive(Debug)]
struct Claim(Arc<AtomicBool>);

impl Claim {
    /// None where somebody else has it.
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
    /// Begins. With [`Task::Identify`] the finger moves to its lower stops and presses; with [`Task::Zero`] its tendons
    /// become slack for a second. The space that its joints can reach must be free. Set points are ignored meanwhile.
    ///
    /// # Errors
    /// No such finger, finger faulted or busy, a configuration that no routine can work with.
    pub fn begin(hand: &Hand, finger: i32, task: Task) -> Result<Self, HandError> {
        let member = hand.dispatcher.member(finger)?;
        let index = finger as usize - 1; // 1 to 3: the member is there
        let mut configuration = hand.configuration.read().clone();
        let rate = configuration.hand.rate;
        let refused = |unusable| refusal(finger, unusable);
        let calibration = Calibration::new(task, &configuration.fingers[index], rate).map_err(refused)?;
        configuration.fingers[index] = Calibration::controlled(&configuration.fingers[index], rate);
        let adjustable = Adjustable::new(&configuration, index).map_err(refused)?;
        let claim = Claim::take(&member.calibrated).ok_or_else(|| match member.mailbox.report().stage {
            Stage::Faulted(fault) => HandError::Faulted { finger, fault },
            _ => HandError::Busy(finger),
        })?;
        let order = hand.dispatcher.hand_over_calibration(finger, &configuration, adjustable, |adjustable| {
            let run = CalibrationRun { calibration, adjustable };
            Self::ordered(finger, member.mailbox.order(Order::Calibrate(run)))
        })?;
        Ok(Self { finger, _claim: claim, order, found: None, asked: Instant::now() })
    }

    fn ordered(finger: i32, given: Result<Option<u32>, Fault>) -> Result<u32, HandError> {
        given.map_err(|fault| HandError::Faulted { finger, fault })?.ok_or(HandError::Busy(finger))
    }

    /// How it stands now. What was found is put in force first: tendons are brought under tension, and the finger is a
    /// spring that holds its pose at its initial stiffness; but after [`Task::Signs`] it stays limp, because its zeros
    /// may be anywhere. Not to be called again after it is done.
    ///
    /// # Errors
    /// A routine that gave up, and left the finger limp; a finger that faults.
    pub fn poll(&mut self, hand: &Hand) -> Result<Standing, HandError> {
        let finger = self.finger;
        let report = hand.dispatcher.report(finger)?;
        if report.orders != self.order {
            // Counted from open, so a hand that was opened anew never gets there.
            if self.asked.elapsed() > ANSWER {
                return Err(HandError::NoAnswer(finger));
            }
            return Ok(Standing::Going(Progress { step: Step::TakingUpSlack, part: 0.0 }));
        }
        if let Some((findings, found)) = &self.found {
            if report.stage == Stage::Opening {
                return Ok(Standing::Going(Progress { step: Step::TakingUpSlack, part: 1.0 }));
            }
            hand.note(found.clone());
            return Ok(Standing::Done(*findings));
        }
        match report.calibration {
            None => Ok(Standing::Going(Progress { step: Step::TakingUpSlack, part: 0.0 })),
            Some(Verdict::Going(progress)) => Ok(Standing::Going(progress)),
            Some(Verdict::Refused(obstacle)) => {
                Err(HandError::Calibration { finger, limp: report.stage == Stage::Limp, obstacle })
            }
            Some(Verdict::Found(found)) => {
                let index = finger as usize - 1; // 1 to 3: it has reported
                // Held throughout: an adjustment meanwhile is not lost.
                let mut configuration = hand.configuration.write();
                let mut changed = configuration.clone();
                found.apply(&mut changed.fingers[index]);
                check(&changed)?;
                let adjustable = Adjustable::new(&changed, index).map_err(|unusable| refusal(finger, unusable))?;
                let limp = matches!(found, Findings::Signs(_));
                let to_store = Found::by_calibration(&found, finger, &changed)?;
                let member = hand.dispatcher.member(finger)?;
                self.order = hand.dispatcher.hand_over(finger, &changed, adjustable, |adjustable| {
                    Self::ordered(finger, member.mailbox.restart(adjustable, limp))
                })?;
                (self.found, self.asked) = (Some((found, to_store)), Instant::now());
                *configuration = changed;
                Ok(Standing::Going(Progress { step: Step::TakingUpSlack, part: 1.0 }))
            }
        }
    }
}

impl Hand {
    /// Finds which way motors, encoders and gauges of finger 1, 2 or 3 count. The finger stays limp.
    ///
    /// `progress` is told how far it is, 200 times a second.
    ///
    /// # Errors
    /// As [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn find_signs(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Signs, progress)
    }

    /// Zeroes gauges and encoders of finger 1, 2 or 3, the latter as `zeroing.method` says.
    ///
    /// # Errors
    /// As [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn zero(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Zero, progress)
    }

    /// Measures gauge gains, friction and tendon stiffness of finger 1, 2 or 3, which must have been zeroed.
    ///
    /// # Errors
    /// As [`Calibrating::begin`] and [`Calibrating::poll`].
    pub fn identify(&self, finger: i32, progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        self.calibrate(finger, Task::Identify, progress)
    }

    fn calibrate(&self, finger: i32, task: Task, mut progress: impl FnMut(Progress)) -> Result<Findings, HandError> {
        let mut calibrating = Calibrating::begin(self, finger, task)?;
        loop {
            match calibrating.poll(self)? {
                Standing::Going(going) => progress(going),
                Standing::Done(findings) => return Ok(findings),
            }
            sleep(LOOKING);
        }
    }

    /// The configuration of finger 1, 2 or 3 with everything that was found since open.
    ///
    /// # Errors
    /// No such finger.
    pub fn calibrated(&self, finger: i32) -> Result<ConfiguredFinger, HandError> {
        self.dispatcher.member(finger)?;
        Ok(self.configuration.read().fingers[finger as usize - 1].clone()) // the member is there: 1 to 3
    }

    /// Writes what calibrations of finger 1, 2 or 3 have found since the last such call into the configuration file
    /// that the hand was opened with, by [`store_findings`]. Whether there is such a file, and something to write.
    ///
    /// # Errors
    /// No such finger; [`HandError::NotStored`] with the reason. What was found stays in force until the hand is
    /// closed, and is not kept for another such call.
    pub fn store_calibration(&self, finger: i32) -> Result<bool, HandError> {
        self.dispatcher.member(finger)?;
        self.to_store(finger).map_or(Ok(false), |calibration| calibration.store().map(|()| true))
    }

    /// What [`Hand::store_calibration`] would write, for who writes it without the hand.
    pub(crate) fn to_store(&self, finger: i32) -> Option<ToStore> {
        let mut all = self.found.lock();
        let place = all.iter().position(|found| found.finger() == finger)?;
        let found = all.swap_remove(place);
        Some(ToStore { file: self.file.clone()?, found })
    }

    fn note(&self, found: Found) {
        let mut all = self.found.lock();
        match all.iter_mut().find(|before| before.finger() == found.finger()) {
            Some(before) => before.add(found),
            None => all.push(found),
        }
    }
}

/// What was found, and the file that it belongs into.
pub(crate) struct ToStore {
    file: PathBuf,
    found: Found,
}

impl ToStore {
    pub(crate) fn store(&self) -> Result<(), HandError> {
        let finger = self.found.finger();
        let not_stored = |source| HandError::NotStored { finger, source };
        store_findings(&self.file, std::slice::from_ref(&self.found)).map_err(not_stored)
    }
}

fn refusal(finger: i32, unusable: crate::model::configuration::Unusable) -> HandError {
    UnusableConfiguration { finger: Some(finger as usize - 1), unusable }.into() // 1 to 3: the finger was found
}

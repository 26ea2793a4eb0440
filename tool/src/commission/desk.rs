//! A finger, the person in front of it, and its configuration so far.

use super::machine::{Machine, Reading};
use super::outcome::Outcome;
use super::person::{Act, Answer, NoAnswer, Person};
use super::step::Step;
use super::vitals::Vitals;
use super::wrong::Wrong;
use super::{computer, encoders, gauges, motors, spring, tendons, zeros};
use crate::failure::Failure;
use std::io;
use sun2xp::model::configuration::ConfiguredFinger;

/// Number of failed readings in a row after which the person is asked.
const READINGS: usize = 4;

/// What every step works with.
pub struct Desk<'a> {
    pub machine: &'a mut dyn Machine,
    pub person: &'a mut dyn Person,
    /// The configuration with everything found so far.
    pub finger: ConfiguredFinger,
    /// The weights to hang on the tendons, N, in rising order.
    pub weights: Vec<f64>,
    /// What a healthy finger measures, for later comparisons.
    pub vitals: Vitals,
}

impl Desk<'_> {
    /// Does one step, once. The motors are off afterwards. Only a step that has passed changes `finger`.
    pub fn carry_out(&mut self, step: Step) -> Result<Outcome, Failure> {
        let before = (self.finger.clone(), self.vitals.clone());
        self.person.begin(step, &self.finger)?;
        let done = match step {
            Step::Board => computer::board(self),
            Step::Encoders => encoders::encoders(self),
            Step::Gauges => gauges::gauges(self),
            Step::Motors => motors::motors(self),
            Step::Zeros => zeros::zeros(self),
            Step::Tendons => tendons::tendons(self),
            Step::Bound => computer::bound(self),
            Step::Computer => computer::computer(self),
            Step::Spring => spring::spring(self),
        };
        self.machine.off();
        if !done.as_ref().is_ok_and(Outcome::passed) {
            (self.finger, self.vitals) = before;
        }
        let outcome = done?;
        self.person.conclude(&outcome);
        Ok(outcome)
    }

    /// Asks the person to prepare what follows. If the person cannot do it, adds [`Wrong::NotPrepared`] to the outcome
    /// and returns false. The step must then end, because the finger could move while a person's hand is in its way.
    pub fn prepare(&mut self, outcome: &mut Outcome, act: Act) -> Result<bool, Failure> {
        let prepared = self.person.ask(act)? == Answer::Done;
        if !prepared {
            outcome.wrong(Wrong::NotPrepared);
        }
        Ok(prepared)
    }

    /// Reads the sensors with the motors off. A reading without replies is repeated, so that a busy computer or a loose
    /// plug does not end a step whose earlier readings are good.
    pub fn read(&mut self, seconds: f64) -> Result<Reading, Failure> {
        let mut attempt = 1;
        loop {
            let failure = match self.machine.read(seconds) {
                Ok(reading) => return Ok(reading),
                Err(failure) => failure,
            };
            // A finger that has lost its replies is faulted. The next reading opens it again.
            self.machine.off();
            if attempt % READINGS == 0 {
                let remedy = "Check the cable and the power of the board, and what else this computer runs. Then \
                              press Enter to repeat the reading";
                if !self.person.again(&format!("{failure}. {remedy}."))? {
                    return Err(NoAnswer::GivenUp(failure.to_string()).into());
                }
            } else {
                self.person.show(&format!("{failure}. The tool opens the finger again and repeats the reading"));
            }
            attempt += 1;
        }
    }

    /// Does one step until it passes, or until the person gives up. `failed` is called each time that the step stops
    /// with an error or ends without passing. If the step stops because nobody answers or the person leaves, `failed`
    /// is not called.
    pub fn complete(
        &mut self,
        step: Step,
        mut failed: impl FnMut(&Outcome) -> Result<(), Failure>,
    ) -> Result<Outcome, Failure> {
        let question = format!("Remove the cause. Then press Enter to repeat the step \"{step}\".");
        loop {
            let done = self.carry_out(step);
            match &done {
                Ok(outcome) if outcome.passed() => return done,
                Ok(outcome) => failed(outcome)?,
                // Nobody is there to ask.
                Err(failure) if nobody_answers(failure) => return done,
                Err(failure) => {
                    let mut outcome = Outcome::default();
                    outcome.wrong(Wrong::Stopped(failure.to_string()));
                    failed(&outcome)?;
                    // The person has been asked already.
                    if failure.is::<NoAnswer>() {
                        return done;
                    }
                    self.person.show(&format!("the step has stopped: {failure}"));
                }
            }
            if !self.person.again(&question)? {
                return done;
            }
        }
    }
}

/// Whether a step has ended because nobody answers, or because the person leaves.
fn nobody_answers(failure: &Failure) -> bool {
    let left = matches!(failure.downcast_ref(), Some(NoAnswer::Left | NoAnswer::InputEnded));
    left || failure.is::<io::Error>()
}

//! A finger, the person in front of it, and its configuration so far.

use super::machine::Machine;
use super::outcome::Outcome;
use super::person::Person;
use super::step::Step;
use super::vitals::Vitals;
use super::{computer, encoders, gauges, motors, spring, tendons, zeros};
use crate::failure::Failure;
use sun2xp::model::configuration::ConfiguredFinger;

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

    /// Does one step until it passes, or until the person gives up.
    pub fn complete(&mut self, step: Step) -> Result<Outcome, Failure> {
        loop {
            let outcome = self.carry_out(step)?;
            if outcome.passed() || !self.person.again(step)? {
                return Ok(outcome);
            }
        }
    }
}

//! Replay of one finger's cycles as they arrive, for recordings of any length. The memory that it takes is limited.

use super::remedy::without_remedy;
use super::same;
use super::soundness::{InputLimits, check_source, within_bounds};
use crate::control::{Controller, State};
use crate::finger::recording::ALTERED;
use crate::finger::{ControlRecord, ControllerSource, CycleRecord, Stage};
use crate::model::configuration::{ConfiguredHand, Unusable};
use std::collections::BTreeMap;
use std::ops::Range;
use thiserror::Error;

/// Largest number of controllers whose sources are kept. If a servo uses a controller, it begins to do so soon after
/// the source of the controller was recorded. So the oldest sources can be dropped.
const MOST_SOURCES: usize = 4096;

/// If more controllers than this number are ready, the next cycle drops those that it does not name.
const MOST_READY: usize = 8;

/// Recomputes the cycles of one finger. Keyframes and controllers must arrive before the cycles that need them. The
/// cycles must arrive in their order. Cycles and controllers may be missing. The replay then resumes at the next cycle
/// that has a keyframe and whose controllers are known.
#[derive(Default)]
pub struct ContinuousReplay {
    hand: Option<ConfiguredHand>,
    sources: BTreeMap<u32, ControllerSource>,
    ready: BTreeMap<u32, Controller>,
    /// The state before the next cycle; none before the first keyframe, after a gap, and after a cycle with an unknown
    /// controller.
    state: Option<State>,
    keyframe: Option<(u64, State)>,
    /// Number of the next cycle; none before the first.
    next: Option<u64>,
    /// Whether the finger faulted in the last cycle that arrived. The servo records this cycle, and then none until the
    /// finger recovers.
    faulted: bool,
}

/// The replay of one cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Recomputed {
    /// Numbers of the cycles that are missing before this one. Cycles of a faulted finger are not missing.
    pub gap: Option<Range<u64>>,
    /// What was computed.
    pub step: Step,
}

/// What the replay of a cycle computed.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Nothing, because no controller ran in this cycle.
    Idle,
    /// Nothing, because no keyframe has arrived since the beginning, a gap, or a cycle with an unknown controller.
    Waiting,
    /// Nothing, because the cycle names the controller with this number, which has not arrived.
    UnknownController(u32),
    /// The recorded command and report.
    Same,
    /// Another command or report.
    Different(Box<ControlRecord>),
}

/// Data that no servo can have recorded.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum Unsound {
    /// The hand's configuration is invalid.
    #[error("hand.{key}: {reason}. {ALTERED}")]
    Hand {
        /// The key, with dots.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// No controller can be constructed from a configuration.
    #[error("controller {number}: {key}: {reason}. {ALTERED}")]
    Controller {
        /// Number of the controller.
        number: u32,
        /// The key.
        key: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// A keyframe contains a number that is out of bounds.
    #[error("the state before cycle {cycle}: {key}: {reason}. {ALTERED}")]
    Keyframe {
        /// Number of the cycle.
        cycle: u64,
        /// The key, with dots.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A cycle contains a value that no servo can have recorded.
    #[error("cycle {cycle}: {key}: {reason}. {ALTERED}")]
    Cycle {
        /// Number of the cycle.
        cycle: u64,
        /// The key, with dots.
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// A cycle does not come after the previous one.
    #[error("cycle {0} comes after a cycle with the same or a higher number. {ALTERED}")]
    Order(u64),
    /// A controller computes a command that is not a finite number.
    #[error("cycle {0}: the controller commands a torque that is not a finite number. {ALTERED}")]
    NotFinite(u64),
}

impl ContinuousReplay {
    /// Stores the source of a controller.
    ///
    /// # Errors
    /// Returns an error if no hand opens with the configuration `hand`, or with the finger or the gravity of `source`.
    pub fn controller(&mut self, source: ControllerSource, hand: ConfiguredHand) -> Result<(), Unsound> {
        let number = source.number;
        if self.hand.as_ref() != Some(&hand) {
            let unsound = |Unusable { key, reason }| Unsound::Hand { key: key.into(), reason: without_remedy(&reason) };
            hand.check().map_err(unsound)?;
            self.hand = Some(hand);
            self.ready.clear();
        }
        check_source(&source).map_err(|(key, reason)| Unsound::Controller { number, key, reason })?;
        if self.sources.get(&number) != Some(&source) {
            self.ready.remove(&number);
            self.sources.insert(number, source);
            while self.sources.len() > MOST_SOURCES {
                self.sources.pop_first();
            }
        }
        Ok(())
    }

    /// Takes the state of the controller before a cycle. Returns false if the replay has computed another state for
    /// this cycle. The replay continues with the state of the keyframe, so that later cycles can be compared.
    ///
    /// # Errors
    /// Returns an error if a number is out of bounds.
    pub fn keyframe(&mut self, cycle: u64, state: State) -> Result<bool, Unsound> {
        within_bounds(&state, "state").map_err(|(key, reason)| Unsound::Keyframe { cycle, key, reason })?;
        let computed = self.state.as_ref().filter(|_| self.next == Some(cycle));
        let same =
            computed.is_none_or(|computed| text(computed).is_some_and(|computed| Some(computed) == text(&state)));
        self.keyframe = Some((cycle, state));
        Ok(same)
    }

    /// Recomputes a cycle.
    ///
    /// # Errors
    /// Returns an error if the cycle contains a number that no servo can have recorded, if the cycle is out of order,
    /// if no controller can be constructed from a source that the cycle needs, or if the controller computes a torque
    /// that is not finite.
    pub fn cycle(&mut self, record: &CycleRecord) -> Result<Recomputed, Unsound> {
        let cycle = record.cycle;
        let gap = self.advance(record)?;
        let idle = |step| Ok(Recomputed { gap: gap.clone(), step });
        let Some(recorded) = record.control else { return idle(Step::Idle) };
        if let Some(number) = self.prepare(cycle, &recorded)? {
            // The state after this cycle is not known either.
            self.state = None;
            return idle(Step::UnknownController(number));
        }
        let Some(mut state) = self.state else { return idle(Step::Waiting) };
        let present = &self.ready[&recorded.controller];
        let previous = (recorded.previous != recorded.controller).then(|| &self.ready[&recorded.previous]);
        let (command, report) = recorded.input.run(present, previous, &mut state, record.feedback.as_ref());
        if !command.is_finite() {
            return Err(Unsound::NotFinite(cycle));
        }
        self.state = Some(state);
        let replayed = ControlRecord { command, report, ..recorded };
        idle(if same(&replayed, &recorded) { Step::Same } else { Step::Different(Box::new(replayed)) })
    }

    /// Notes that a cycle has arrived, and finds the state before it. Returns the cycles that are missing before it.
    fn advance(&mut self, record: &CycleRecord) -> Result<Option<Range<u64>>, Unsound> {
        let cycle = record.cycle;
        let next = self.next.unwrap_or(cycle);
        if cycle < next {
            return Err(Unsound::Order(cycle));
        }
        let gap = (cycle > next && !self.faulted).then_some(next..cycle);
        if cycle > next {
            self.state = None;
        }
        if let Some((_, state)) = self.keyframe.take_if(|(at, _)| *at <= cycle).filter(|(at, _)| *at == cycle) {
            self.state = Some(state);
        }
        self.next = Some(cycle.saturating_add(1));
        self.faulted = matches!(record.stage, Stage::Faulted(_));
        Ok(gap)
    }

    /// Checks the input of a cycle, and makes its controllers ready. Returns the number of a controller that has not
    /// arrived, if there is one.
    fn prepare(&mut self, cycle: u64, recorded: &ControlRecord) -> Result<Option<u32>, Unsound> {
        let Some(hand) = &self.hand else { return Ok(Some(recorded.controller)) };
        let wrong = |(key, reason)| Unsound::Cycle { cycle, key: format!("control.input.{key}"), reason };
        InputLimits::new(hand).check(&recorded.input).map_err(wrong)?;
        let named = [recorded.controller, recorded.previous];
        if self.ready.len() > MOST_READY {
            self.ready.retain(|number, _| named.contains(number));
        }
        for number in named {
            if self.ready.contains_key(&number) {
                continue;
            }
            let Some(source) = self.sources.get(&number) else { return Ok(Some(number)) };
            let made = Controller::in_gravity(&source.finger, &source.gravity, hand.rate);
            let unusable =
                |Unusable { key, reason }| Unsound::Controller { number, key, reason: without_remedy(&reason) };
            self.ready.insert(number, made.map_err(unusable)?);
        }
        Ok(None)
    }
}

/// Returns a text in which every number has enough digits to restore its bits. Black box files have the same format.
fn text(state: &State) -> Option<String> {
    serde_json::to_string(state).ok()
}

//! The state of a finger as the views show it.

use super::wake_ups::{Histogram, WakeUps};
use serde::Serialize;
use std::collections::VecDeque;
use sun2xp::finger::CycleRecord;
use sun2xp::model::configuration::Configuration;
use sun2xp::nalgebra::{UnitQuaternion, Vector3};
use sun2xp::realtime::CycleStage;
use sun2xp::telemetry::{Sample, Status};
use sun2xp::{Distribution, Fault, FingerNumber, Losses, Stage};

/// Time over which the rate is measured, ns.
const RATE_TIME: u64 = 1_000_000_000;

/// Interval of the history, ns.
const HISTORY_INTERVAL: u64 = 100_000_000;

/// Number of intervals in the history, which is 20 s long.
const HISTORY: usize = 200;

/// What is known of a finger.
#[derive(Clone, Debug, Serialize)]
pub struct FingerState {
    /// Number of the finger.
    pub finger: i32,
    /// Whether the finger is simulated.
    pub simulated: bool,
    /// Whether a status has arrived.
    #[serde(skip)]
    pub known: bool,
    /// Number of the last cycle.
    pub cycle: u64,
    /// Stage, in one word.
    pub stage: &'static str,
    /// The fault that has stopped the finger.
    pub fault: Option<FaultState>,
    /// The newest warning, if it was noted within the second before the newest status.
    pub warning: Option<FaultState>,
    /// Lower limits of the joints, degrees.
    pub joint_minimum_degrees: [f64; 3],
    /// Upper limits of the joints, degrees.
    pub joint_maximum_degrees: [f64; 3],
    /// t_min, N.
    pub tension_minimum: f64,
    /// t_max, N.
    pub tension_maximum: f64,
    /// The newest cycle in which the controller ran; none before the first such cycle. Its angles are in rad.
    pub sample: Option<Sample>,
    /// Estimated force on the touched object in the palm's frame, N, without the finger's own friction and weight.
    pub contact_force_in_palm: [f64; 3],
    /// Measured rate of the last second, Hz.
    pub rate: f64,
    /// Wake-up delays since the hand was opened or the planner restarted the statistics (sun2xp_reset_timing), us. A
    /// wake-up delay is the time from the scheduled beginning of a cycle to its first instruction.
    pub wake_up: Distribution,
    /// Wake-up delays of the last ten seconds.
    pub wake_up_histogram: Histogram,
    /// Numbers of cycles and of their errors since the hand was opened.
    pub losses: Losses,
    /// Cycles that were lost on the way to this reader.
    pub lost_samples: u64,
    /// Number of recoveries from a fault.
    pub recoveries: u32,
    /// Largest force at the tip in each tenth of a second, N, the newest last, with the number of the tenth.
    #[serde(skip)]
    pub force_history: VecDeque<(u64, f64)>,
    /// The fault that `fault` describes.
    #[serde(skip)]
    stopped: Option<Fault>,
    #[serde(skip)]
    to_palm: UnitQuaternion<f64>,
    #[serde(skip)]
    wake_ups: WakeUps,
    /// The cycles of the last second: the number of each cycle, and its beginning in ns.
    #[serde(skip)]
    marks: VecDeque<(u64, u64)>,
}

/// A fault or a warning.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct FaultState {
    /// Number of the kind, as in docs/faults.md.
    pub number: u8,
    /// Name of the kind.
    pub name: &'static str,
    /// Name, place, value, what has happened, likely cause and remedy.
    pub text: String,
}

impl From<&Fault> for FaultState {
    fn from(fault: &Fault) -> Self {
        Self { number: fault.kind.number(), name: fault.kind.description().name, text: fault.to_string() }
    }
}

impl FingerState {
    /// Returns the state before the first message.
    pub fn new(finger: FingerNumber, configuration: &Configuration) -> Self {
        let mut state = Self {
            finger: finger.get(),
            simulated: configuration.fingers[finger.index()].simulated(),
            known: false,
            cycle: 0,
            stage: "waiting",
            fault: None,
            warning: None,
            joint_minimum_degrees: [0.0; 3],
            joint_maximum_degrees: [0.0; 3],
            tension_minimum: 0.0,
            tension_maximum: 0.0,
            sample: None,
            contact_force_in_palm: [0.0; 3],
            to_palm: configuration.finger_to_palm(finger).rotation,
            rate: 0.0,
            wake_up: Distribution::default(),
            wake_up_histogram: Histogram::default(),
            losses: Losses::default(),
            lost_samples: 0,
            recoveries: 0,
            force_history: VecDeque::new(),
            stopped: None,
            wake_ups: WakeUps::default(),
            marks: VecDeque::new(),
        };
        state.configure(configuration);
        state
    }

    /// Uses another configuration from now on.
    pub fn configure(&mut self, configuration: &Configuration) {
        let Some(number) = FingerNumber::new(self.finger) else { return };
        let finger = &configuration.fingers[number.index()];
        (self.joint_minimum_degrees, self.joint_maximum_degrees) =
            (finger.joints.minimum_degrees, finger.joints.maximum_degrees);
        (self.tension_minimum, self.tension_maximum) = (finger.tendon.minimum, finger.tendon.maximum);
    }

    /// Takes a cycle into account.
    pub fn apply(&mut self, record: &CycleRecord) {
        self.cycle = record.cycle;
        self.note_stage(record.stage);
        if let Some(nanoseconds) = record.timing.duration(CycleStage::WakeUp) {
            self.wake_ups.note(record.began, nanoseconds);
        }
        self.note_rate(record);
    }

    /// Takes a status into account. The status comes once a second.
    pub fn note_status(&mut self, status: &Status) {
        self.known = true;
        self.wake_up = status.wake_up;
        self.losses = status.losses;
        self.recoveries = status.recoveries;
        self.warning = status.warning.as_ref().map(FaultState::from);
        self.wake_up_histogram = self.wake_ups.histogram();
        self.note_stage(status.stage);
    }

    fn note_stage(&mut self, stage: Stage) {
        let fault = match stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        };
        self.stage = stage.name();
        // The text of a fault is made once, and not in every cycle.
        if fault != self.stopped {
            self.fault = fault.as_ref().map(FaultState::from);
            self.stopped = fault;
        }
    }

    fn note_rate(&mut self, record: &CycleRecord) {
        self.marks.push_back((record.cycle, record.began));
        while self.marks.front().is_some_and(|&(_, began)| began + RATE_TIME < record.began) {
            self.marks.pop_front();
        }
        if let Some(&(cycle, began)) = self.marks.front()
            && record.began > began
        {
            self.rate = (record.cycle - cycle) as f64 / ((record.began - began) as f64 * 1e-9);
        }
    }

    /// Shows this cycle from now on.
    pub fn show(&mut self, sample: Sample) {
        let force = sample.tip_force.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
        let slot = sample.began / HISTORY_INTERVAL;
        match self.force_history.back_mut() {
            Some((last, most)) if *last == slot => *most = most.max(force),
            _ => self.force_history.push_back((slot, force)),
        }
        if self.force_history.len() > HISTORY {
            self.force_history.pop_front();
        }
        self.contact_force_in_palm = (self.to_palm * Vector3::from(sample.contact_force)).into();
        self.sample = Some(sample);
    }
}

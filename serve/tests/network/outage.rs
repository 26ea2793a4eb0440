//! Outages: the planner or the line fails, and the telemetry of the hand shows what the fingers do.

use super::line::{Direction, Line};
use super::observer::{Observer, has_stiffness};
use super::planner::{Motion, Planner, STIFF};
use super::served::{SOFT, Served};
use super::shaper::Conditions;
use std::time::Duration;
use sun2xp::realtime::now;
use sun2xp::{Stage, model::FingerNumber};

/// Longest time from an outage until every finger is caught, ms.
pub const CATCH_GOAL: f64 = 120.0;

/// Longest time from an outage until every finger is in its end state, ms.
pub const END_GOAL: f64 = 1100.0;

/// Longest time until the fingers follow a new planner.
const FOLLOWS: Duration = Duration::from_secs(15);

/// The age of a Target at which the servers of these tests catch the fingers, unless a test sets another age, ms.
pub const CATCH_MS: u32 = 100;

/// What fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
#[value(rename_all = "PascalCase")]
pub enum Failure {
    /// The planner is killed.
    Killed,
    /// The planner is stopped by SIGSTOP, and continued when the hand has another owner.
    Stopped,
    /// Nothing arrives in any direction.
    Unplugged,
    /// What the planner sends does not arrive.
    PlannerMuted,
    /// What the server sends does not arrive.
    ServerMuted,
}

impl Failure {
    pub const ALL: [Self; 5] = [Self::Killed, Self::Stopped, Self::Unplugged, Self::PlannerMuted, Self::ServerMuted];
}

/// What the hand did. `caught` and `ended` are times of the last finger, in ms.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// From the outage to the first cycle in which the finger was held softly.
    pub caught: f64,
    /// From the outage to the first cycle in which the finger was no spring any more.
    pub ended: f64,
    /// Largest distance of the set point of a finger from its joint angles in the first cycle in which the finger is
    /// held softly, rad.
    pub distance: f64,
    /// Longest time between two observed cycles of a finger, ms. Pauses of the machine and lost telemetry prolong it.
    pub pause: f64,
    /// Cycles that telemetry has lost.
    pub lost: u64,
}

/// A hand, its line, and an observer of the hand.
pub struct Rig {
    pub line: Line,
    pub served: Served,
    pub observer: Observer,
}

impl Rig {
    /// Starts a server that catches the fingers after `catch_ms`.
    pub fn new(line: Line, name: &str, catch_ms: u32) -> Self {
        let served = Served::start(&line, name, catch_ms);
        let observer = served.observer(&line);
        Self { line, served, observer }
    }

    /// Starts a planner, and waits until every finger has the stiffness of this planner.
    pub fn planner(&mut self, motion: Motion) -> Planner {
        let planner = Planner::start(&self.line, &self.served.remote("planner"), motion);
        self.follows();
        planner
    }

    /// Waits until every finger has the planner's stiffness.
    fn follows(&mut self) {
        for finger in FingerNumber::ALL {
            let follows = self
                .observer
                .until(FOLLOWS, |sample| (sample.finger == finger && has_stiffness(sample, STIFF)).then_some(()));
            assert!(follows.is_some(), "finger {finger} does not follow the planner");
        }
    }

    /// Lets `failure` happen while a planner moves the hand. Observes the hand until every finger is in its end state,
    /// and repairs the line. After [`Failure::Stopped`], the next planner must get the hand, and the planner that
    /// continues must not disturb it. After the other failures, the next call of `fail` starts the next planner,
    /// which must get the hand.
    pub fn fail(&mut self, failure: Failure) -> Outcome {
        let planner = self.planner(Motion::Swing);
        self.observer.skip();
        let begin = now();
        match failure {
            Failure::Killed => planner.signal(libc::SIGKILL),
            Failure::Stopped => planner.signal(libc::SIGSTOP),
            Failure::Unplugged => _ = self.line.set_both(Conditions::CUT),
            Failure::PlannerMuted => _ = self.line.set(Direction::Left, Conditions::CUT),
            Failure::ServerMuted => _ = self.line.set(Direction::Right, Conditions::CUT),
        }
        let outcome = self.outcome(begin);
        self.line.set_both(Conditions::default());
        if failure == Failure::Stopped {
            let next = self.planner(Motion::Swing);
            planner.signal(libc::SIGCONT);
            self.observer.skip();
            // What the first planner sends now has an old epoch, and changes nothing.
            let ended = self.observer.until(Duration::from_millis(300), |sample| {
                (sample.stage != Stage::Running || !has_stiffness(sample, STIFF)).then_some(sample.stage)
            });
            assert_eq!(ended, None, "the planner that was continued disturbs its successor");
            drop(next);
        }
        outcome
    }

    fn outcome(&mut self, begin: u64) -> Outcome {
        let mut outcomes = [(None, None); 3];
        let (mut distance, mut pause, mut last_began): (f64, f64, _) = (0.0, 0.0, [begin; 3]);
        let lost = self.observer.lost();
        let milliseconds = |time: u64| time.saturating_sub(begin) as f64 * 1e-6;
        self.observer.until(Duration::from_secs(4), |sample| {
            let (caught, ended) = &mut outcomes[sample.finger.index()];
            let before = std::mem::replace(&mut last_began[sample.finger.index()], sample.began);
            pause = pause.max(sample.began.saturating_sub(before) as f64 * 1e-6);
            if sample.began > begin && caught.is_none() && has_stiffness(sample, SOFT) {
                *caught = Some(milliseconds(sample.began));
                let set_point = sample.joint_set_point.unwrap_or(sample.joints);
                let apart = |joint: usize| (set_point[joint] - sample.joints[joint]).abs();
                distance = (0..3).map(apart).fold(distance, f64::max);
            }
            if sample.began > begin && ended.is_none() && sample.stage != Stage::Running {
                *ended = Some(milliseconds(sample.began));
            }
            outcomes.iter().all(|(_, ended)| ended.is_some()).then_some(())
        });
        // A finger that was not caught, or did not go to its end state, is later than every goal.
        let last = |a: f64, b: Option<f64>| a.max(b.unwrap_or(f64::INFINITY));
        let caught = outcomes.iter().fold(0.0, |latest, (caught, _)| last(latest, *caught));
        let ended = outcomes.iter().fold(0.0, |latest, (_, ended)| last(latest, *ended));
        Outcome { caught, ended, distance, pause, lost: self.observer.lost() - lost }
    }
}

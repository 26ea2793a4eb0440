//! The reflexes of a finger in its servo: the reactions of the rules, and the time for which the finger does not follow
//! the planner.

use super::FingerServo;
use crate::control::Activity;
use crate::finger::events::{EventKind, Occurrence};
use crate::finger::reflexes::{Bulletin, Facts, Fired};
use crate::finger::{Fault, FaultKind, Reaction, ReflexServer, Reflexes, Stage, reflexes};
use crate::model::{FingerNumber, Part};

impl FingerServo {
    /// Returns the servo, and a `Reflexes` with which planners install rules for the finger. The rules of each finger
    /// read the events of all fingers from clones of `bulletin`.
    pub fn with_reflexes(mut self, finger: FingerNumber, bulletin: &Bulletin) -> (Self, Reflexes) {
        let (planners, server) = reflexes(finger, bulletin);
        self.memory.append(server.memory());
        self.reflexes.server = Some(server);
        (self, planners)
    }

    /// Notes the events of this cycle for the rules of this finger and of the others.
    pub(super) fn note_events(&mut self) {
        let kinds = self.events.take_kinds();
        self.reflexes.server.iter_mut().for_each(|server| server.note(kinds));
    }

    /// Evaluates the rules of a finger in the stage `Running`, and carries out the reaction of a rule that has fired.
    /// `skipped` is the number of periods that will be skipped after this cycle.
    pub(super) fn react(&mut self, skipped: u64) {
        let period = self.motion.next_period;
        // Tactile events of this cycle have arrived before this point.
        self.note_events();
        if self.report.stage != Stage::Running {
            self.reflexes.server.iter_mut().for_each(ReflexServer::idle);
            (self.reflexes.inhibited_until, self.reflexes.last_set_point) = (None, period);
            return;
        }
        if self.reflexes.inhibited_until.is_some_and(|until| period >= until) {
            self.reflexes.inhibited_until = None;
            // Planners sent set points during the inhibition, but the finger has not followed them. Later changes
            // therefore start from the set point that the finger holds.
            self.begin_phase();
        }
        let seconds = self.limits.period();
        let facts = Facts {
            cycle: period,
            period: seconds,
            report: &self.report.cycle,
            link_lost: self.periods_without_reply(skipped) as f64 * seconds,
            planner_silent: period.saturating_sub(self.reflexes.last_set_point) as f64 * seconds,
        };
        if let Some(fired) = self.reflexes.server.as_mut().and_then(|server| server.run(&facts)) {
            self.carry_out_reaction(&fired);
        }
    }

    /// Returns the number of periods that have passed since the last reply; 0 in a cycle with a reply. `skipped` is the
    /// number of periods that will be skipped after this cycle.
    fn periods_without_reply(&self, skipped: u64) -> u64 {
        // `sample_age` already counts this cycle's period and the skipped ones.
        if self.answered { 0 } else { self.sample_age.saturating_sub(1 + skipped) }
    }

    /// Begins a spring phase (`FingerReport::springs`) with the set point in force. Planners number their next set
    /// points from the number of this set point on. They may already have given these numbers to set points that the
    /// finger did not follow. A renewal of validity that was sent in the previous phase is therefore discarded: it
    /// could renew the validity of a new set point with the same number. If a set point has expired, the finger may
    /// until now have accepted late set points of the phase that ended at the expiry (`FingerReport::expired_phase`).
    /// After this call it discards them.
    fn begin_phase(&mut self) {
        self.report.springs += 1;
        self.report.expired_phase = None;
        self.motion.renewal = None;
    }

    fn carry_out_reaction(&mut self, fired: &Fired) {
        let &Fired { rule, reaction, inhibited_until } = fired;
        self.events.write(Occurrence {
            kind: EventKind::ReflexFired,
            part: Part::Finger,
            values: [rule.into(), 0.0, 0.0, 0.0],
        });
        if reaction == Reaction::Stop {
            return self.fault(Fault::new(FaultKind::ReflexStop));
        }
        let Activity::Follow(followed) = &self.activity else { return };
        if let Some(next) = self.adjustable.reactions.react(&reaction, &self.report.cycle, followed) {
            self.follow(next, self.report.set_point_number);
            self.motion.rest(next.joints);
            // Later changes of planners start from this set point.
            self.begin_phase();
        }
        if inhibited_until > self.motion.next_period {
            // A later reaction does not shorten the inhibition of an earlier one.
            self.reflexes.inhibited_until = self.reflexes.inhibited_until.max(Some(inhibited_until));
        }
    }
}

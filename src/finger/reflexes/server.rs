//! The aperiodic server of a finger: evaluates all rules in every cycle, and lets at most one react. The others that
//! have fired wait for the next cycles, in the order of their priorities. The cost of a cycle is therefore bounded.

use super::bulletin::Bulletin;
use super::rule::{Condition, Reaction, Reflex};
use super::rule_set::{MOST_RULES, Rules};
use crate::control::Report;
use crate::model::FingerNumber;
use crate::realtime::{LockedMemory, Output};

/// What the conditions are evaluated with.
pub(in crate::finger) struct Facts<'a> {
    /// Number of this period. Skipped periods count too.
    pub cycle: u64,
    /// Length of a period, s.
    pub period: f64,
    /// The report of the last cycle.
    pub report: &'a Report,
    /// Time since the last reply, s; 0 in a cycle with a reply.
    pub link_lost: f64,
    /// Time since the last set point of the planner, s.
    pub planner_silent: f64,
}

/// A rule that reacts in this cycle.
pub(in crate::finger) struct Fired {
    /// Number of the rule.
    pub rule: u32,
    pub reaction: Reaction,
    /// Number of the first period in which the finger follows its planner again.
    pub inhibited_until: u64,
}

/// The servo's end of a finger's rules. It never waits or allocates.
pub struct ReflexServer {
    finger: FingerNumber,
    rules: Output<Rules>,
    states: [RuleState; MOST_RULES],
    bulletin: Bulletin,
    /// Kinds of events that have occurred since the rules were evaluated: a bit for each number.
    occurred: u32,
    /// The memory that planners and the other fingers share with the server.
    memory: LockedMemory,
}

/// The state of the rule that `number` names.
#[derive(Clone, Copy, Debug, Default)]
struct RuleState {
    number: u32,
    /// Whether the condition was true in the last cycle.
    was_true: bool,
    /// Whether the rule has fired and waits for its reaction.
    waiting: bool,
    /// The first period in which the rule may fire again.
    ready: u64,
    /// The count of another finger's events when the rule was last evaluated.
    seen: u32,
}

impl ReflexServer {
    pub(super) fn new(finger: FingerNumber, rules: Output<Rules>, bulletin: Bulletin, memory: LockedMemory) -> Self {
        Self { finger, rules, states: [RuleState::default(); MOST_RULES], bulletin, occurred: 0, memory }
    }

    /// Returns the memory that the server accesses outside this value.
    pub(in crate::finger) fn memory(&self) -> &LockedMemory {
        &self.memory
    }

    /// Notes events of this finger, for its own rules and for those of the other fingers. `kinds` has a bit for the
    /// number of each kind.
    pub(in crate::finger) fn note(&mut self, kinds: u32) {
        self.occurred |= kinds;
        self.bulletin.count(self.finger, kinds);
    }

    /// Forgets what has fired, because the finger does not follow set points.
    pub(in crate::finger) fn idle(&mut self) {
        self.occurred = 0;
        self.states = [RuleState::default(); MOST_RULES];
    }

    /// Evaluates all rules, and returns the one that reacts in this cycle.
    pub(in crate::finger) fn run(&mut self, facts: &Facts) -> Option<Fired> {
        let occurred = std::mem::take(&mut self.occurred);
        let mut first: Option<(usize, u32, Reflex)> = None;
        for (place, (rule, state)) in self.rules.read().0.iter().zip(&mut self.states).enumerate() {
            let &Some((number, reflex)) = rule else {
                *state = RuleState::default();
                continue;
            };
            if state.number != number {
                let seen = state_of_others(&reflex.condition, &self.bulletin);
                *state = RuleState { number, seen, ..RuleState::default() };
            }
            let is_true = holds(&reflex.condition, state, facts, occurred, &self.bulletin);
            let fires = is_true && facts.cycle >= state.ready && (!state.was_true || reflex.refractory > 0.0);
            (state.was_true, state.waiting) = (is_true, state.waiting || fires);
            let earlier = first.is_some_and(|(_, _, first)| first.priority >= reflex.priority);
            if state.waiting && !earlier {
                first = Some((place, number, reflex));
            }
        }
        let (place, rule, reflex) = first?;
        let cycles = |time: f64| (time / facts.period).ceil() as u64;
        let state = &mut self.states[place];
        (state.waiting, state.ready) = (false, facts.cycle + cycles(reflex.refractory).max(1));
        Some(Fired { rule, reaction: reflex.reaction, inhibited_until: facts.cycle + cycles(reflex.inhibition) })
    }
}

/// Returns how often the event of another finger has been counted so far; 0 for other conditions. A new rule begins
/// with this count, so events that were counted earlier do not fire the rule.
fn state_of_others(condition: &Condition, bulletin: &Bulletin) -> u32 {
    match *condition {
        Condition::OtherFinger { finger, event } => bulletin.counted(finger, event),
        _ => 0,
    }
}

/// Returns whether a condition is true. A condition on an event is true only in the cycle in which the rule sees the
/// event.
fn holds(condition: &Condition, state: &mut RuleState, facts: &Facts, occurred: u32, bulletin: &Bulletin) -> bool {
    let report = facts.report;
    match *condition {
        Condition::Event(kind) => occurred & 1 << kind.number() != 0,
        Condition::OtherFinger { finger, event } => {
            let counted = bulletin.counted(finger, event);
            counted != std::mem::replace(&mut state.seen, counted)
        }
        Condition::ForceAbove(bound) => report.contact.force.norm() > bound,
        Condition::TensionAbove(bound) => report.tensions.max() > bound,
        Condition::TensionBelow(bound) => report.tensions.min() < bound,
        Condition::JointAbove { joint, angle } => report.joints[joint] > angle,
        Condition::JointBelow { joint, angle } => report.joints[joint] < angle,
        Condition::LinkLost(time) => facts.link_lost > 0.0 && facts.link_lost >= time,
        Condition::PlannerSilent(time) => facts.planner_silent >= time,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Reflexes, reflexes};
    use super::*;
    use crate::finger::events::EventKind;

    const PERIOD: f64 = 0.001;

    fn ends() -> (Reflexes, ReflexServer, Bulletin) {
        let bulletin = Bulletin::new();
        let (planners, server) = reflexes(FingerNumber::ONE, &bulletin);
        (planners, server, bulletin)
    }

    fn rule(condition: Condition, reaction: Reaction) -> Reflex {
        Reflex { condition, reaction, priority: 0, refractory: 0.0, inhibition: 0.0 }
    }

    /// Runs one cycle with this force at the tip, N. Returns the number of the rule that reacts.
    fn run(server: &mut ReflexServer, cycle: u64, force: f64) -> Option<u32> {
        let mut report = Report::default();
        report.contact.force.x = force;
        let facts = Facts { cycle, period: PERIOD, report: &report, link_lost: 0.0, planner_silent: 0.0 };
        server.run(&facts).map(|fired| fired.rule)
    }

    #[test]
    fn a_rule_fires_when_its_condition_becomes_true() {
        let (planners, mut server, _) = ends();
        let number = planners.install(rule(Condition::ForceAbove(1.0), Reaction::Hold));
        let forces = [0.5, 1.5, 1.5, 0.5, 1.5];
        let fired: Vec<_> = (1..).zip(forces).map(|(cycle, force)| run(&mut server, cycle, force)).collect();
        assert_eq!(fired, [None, number, None, None, number]);
        assert!(planners.remove(number.expect("a number")) && !planners.remove(number.expect("a number")));
        assert_eq!((run(&mut server, 6, 0.5), run(&mut server, 7, 1.5)), (None, None));
    }

    #[test]
    fn a_rule_whose_condition_stays_true_fires_again_after_its_refractory_time() {
        let (planners, mut server, _) = ends();
        let reflex = Reflex { refractory: 3.0 * PERIOD, ..rule(Condition::ForceAbove(1.0), Reaction::Hold) };
        planners.install(reflex);
        let fired: Vec<u64> = (1..=8).filter(|&cycle| run(&mut server, cycle, 2.0).is_some()).collect();
        assert_eq!(fired, [1, 4, 7]);
    }

    /// Only one rule reacts in each cycle. The others wait, even if their conditions have become false.
    #[test]
    fn rules_react_one_by_one_in_the_order_of_their_priorities() {
        let (planners, mut server, _) = ends();
        let numbers: Vec<_> = [1, 3, 2, 3]
            .map(|priority| {
                let reflex = rule(Condition::Event(EventKind::Contact), Reaction::Hold);
                planners.install(Reflex { priority, ..reflex })
            })
            .into();
        server.note(1 << EventKind::Contact.number());
        let fired: Vec<_> = (1..=5).map(|cycle| run(&mut server, cycle, 0.0)).collect();
        assert_eq!(fired, [numbers[1], numbers[3], numbers[2], numbers[0], None]);
        server.note(1 << EventKind::Contact.number());
        server.idle();
        assert_eq!(run(&mut server, 6, 0.0), None);
    }

    #[test]
    fn a_rule_sees_each_later_event_of_another_finger() {
        let (planners, mut server, bulletin) = ends();
        bulletin.count(FingerNumber::TWO, 1 << EventKind::Slip.number());
        let condition = Condition::OtherFinger { finger: FingerNumber::TWO, event: EventKind::Slip };
        let number = planners.install(rule(condition, Reaction::Hold));
        assert_eq!(run(&mut server, 1, 0.0), None);
        bulletin.count(FingerNumber::THREE, 1 << EventKind::Slip.number());
        bulletin.count(FingerNumber::TWO, 1 << EventKind::Contact.number());
        assert_eq!(run(&mut server, 2, 0.0), None);
        bulletin.count(FingerNumber::TWO, 1 << EventKind::Slip.number());
        assert_eq!((run(&mut server, 3, 0.0), run(&mut server, 4, 0.0)), (number, None));
    }

    #[test]
    fn a_finger_has_a_limited_number_of_rules() {
        let (planners, ..) = ends();
        let reflex = rule(Condition::LinkLost(0.1), Reaction::Stop);
        let numbers: Vec<_> = (0..MOST_RULES).map(|_| planners.install(reflex)).collect();
        assert!(numbers.iter().all(Option::is_some) && planners.install(reflex).is_none());
        planners.clear();
        assert!(planners.install(reflex) > numbers[MOST_RULES - 1]);
    }
}

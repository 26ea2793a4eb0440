//! Computes a finger's command in one cycle. The servo takes what planners have sent, and then runs the controller.

use super::FingerServo;
use super::set_point_motion::Following;
use crate::control::events::Arrival;
use crate::control::motion::{Follower, InterpolationState};
use crate::control::{Activity, SetPoint};
use crate::finger::sent::SentSetPoint;
use crate::finger::{Adjustable, ControlInput, ControlRecord, Order, Stage};
use crate::model::configuration::EndState;

impl FingerServo {
    /// Computes the next command.
    pub(super) fn control(&mut self, skipped: u64) -> ControlRecord {
        let previous = self.take_commands();
        let previous = self.calibrate().or(previous);
        self.move_set_point();
        self.react(skipped);
        let input = ControlInput {
            anew_from: std::mem::take(&mut self.restart).then_some(self.feedback),
            activity: self.activity,
            skipped: if self.link.in_step() { 0 } else { skipped.min(self.link.fault_at().into()) },
            fading: self.link.fading(),
            gravity: Some((*self.mailbox.gravity()).into()),
            path_begins: std::mem::take(&mut self.motion.path.begins),
        };
        let Adjustable { controller, number, .. } = match &self.calibration {
            Some(calibration) => calibration.computes_with(),
            None => &self.adjustable,
        };
        let feedback = self.answered.then_some(&self.feedback);
        let before = previous.as_ref().map(|previous| &previous.controller);
        let adjusted = before.is_some();
        let (command, report) = input.run(controller, before, &mut self.state, feedback);
        (self.command, self.report.cycle) = (command, report);
        let previous = previous.map_or(*number, |previous| previous.number);
        let record = ControlRecord { controller: *number, previous, input, command, report };
        self.note_reference(input.skipped);
        self.watch(adjusted);
        self.observe();
        self.move_on();
        record
    }

    /// Takes what planners have sent. If the controller must continue with new data, returns the data of the last
    /// cycle.
    fn take_commands(&mut self) -> Option<Adjustable> {
        let running = self.report.stage == Stage::Running;
        let order = self.mailbox.new_order();
        // A planner writes the data before the order. The servo reads them in the opposite sequence, so that it never
        // has an order without the data of this order.
        let new = self.mailbox.new_adjustable();
        let mut previous = new.map(|new| std::mem::replace(&mut self.adjustable, new.clone()));
        if previous.as_ref().is_some_and(|before| self.adjustable.reactions.softer_than(&before.reactions)) {
            self.end_stiffness_of_path();
        }
        if self.calibration.is_some() {
            // A calibration computes with its own data.
            previous = None;
        }
        if let Some(order) = order {
            self.report.orders += 1;
            match order {
                Order::Nothing | Order::Calibrate(_) => {}
                Order::Restart { .. } => previous = None,
            }
            self.carry_out(order);
        }
        // `running` is the state before the order. If a set point and an order to calibrate arrive in the same cycle,
        // the set point still takes effect. The finger moves to it, and the routine must detect the motion.
        if let Some(sent) = self.mailbox.new_set_point()
            && running
        {
            self.take_set_point(&sent);
        }
        self.renew_validity();
        if self.mailbox.closing() && self.report.stage != Stage::Closing {
            self.enter(Stage::Closing);
            self.calibration = None;
            if self.end_state == EndState::Hold {
                self.enter(Stage::Closed);
            } else {
                let ramp = f64::from(self.limits.ramp) * self.limits.period_ms * 1e-3;
                self.activity = Activity::Release { ramp };
            }
        }
        previous
    }

    /// Follows the set point that a planner has sent. A set point of another spring phase (`FingerReport::springs`) is
    /// discarded, unless a planner sent it while the previous set point expired.
    pub(super) fn take_set_point(&mut self, sent: &SentSetPoint) {
        if sent.spring != self.report.springs && self.report.expired_phase != Some(sent.spring) {
            return;
        }
        let planned = self.note_planner(sent);
        if !planned && sent.spring != self.report.springs {
            // The set point that this one corrects has expired, and the finger holds its pose.
            return;
        }
        if self.reflexes.inhibits() {
            if planned {
                // The planner is not silent, so the validity begins again.
                self.begin_validity(sent);
            }
            return;
        }
        let held = self.report.set_point;
        let mut set_point = sent.set_point;
        self.report.expired_phase = self.report.expired_phase.filter(|_| !planned);
        self.report.expired &= !planned;
        self.motion.target = set_point.joints;
        self.take_path(sent, &held);
        let motion = &mut self.motion;
        if motion.path.follower.is_some() {
            (set_point.joints, set_point.motion) = (held.joints, held.motion);
            if motion.path.stiffness {
                set_point.stiffness = held.stiffness;
            }
        } else if self.adjustable.motion.interpolation.is_some() {
            set_point.joints = held.joints;
        } else {
            motion.interpolation = InterpolationState::at_rest(set_point.joints);
        }
        let moves = motion.path.follower.is_some() || motion.target != set_point.joints;
        self.follow(set_point, sent.number);
        if moves {
            // The motion has not begun. Without a reply the detectors do not run, and a planner that waits for the
            // arrival would see the arrival at the previous set point.
            self.report.arrival = Arrival::default();
        }
        if planned {
            self.begin_validity(sent);
        }
    }

    /// Begins the path of a set point or continues it. If the set point has no path, ends the previous path. `held` is
    /// the set point in force.
    fn take_path(&mut self, sent: &SentSetPoint, held: &SetPoint) {
        let motion = &mut self.motion;
        match &sent.path {
            Some(path) if path.number != motion.path.number => {
                // The buffer may already have a later path, whose set point is not published yet.
                let taken = self.mailbox.take_path();
                motion.path = Following {
                    number: taken.number,
                    follower: Some(Follower::new(taken.begin.unwrap_or(held.stiffness))),
                    // Only the set point of a later path shows whether that path changes the stiffness. When that set
                    // point arrives, it can switch the change off but not on, so the change is on at first.
                    stiffness: path.stiffness || taken.number != path.number,
                    begins: true,
                };
            }
            Some(path) => motion.path.stiffness &= path.stiffness,
            None if motion.path.follower.is_some() => {
                motion.path.follower = None;
                motion.interpolation = InterpolationState::stopped(held.joints);
            }
            None => {}
        }
    }

    /// Notes that a planner has sent a set point. Returns false if the library has only corrected the last one.
    fn note_planner(&mut self, sent: &SentSetPoint) -> bool {
        let planned = self.motion.note_planned(sent, self.report.set_point_number);
        if planned {
            self.reflexes.note_set_point(self.motion.next_period);
        }
        planned
    }

    /// Makes the finger follow a set point from this cycle on. `number` is the number of the set point.
    pub(super) fn follow(&mut self, set_point: SetPoint, number: u32) {
        if set_point != self.report.set_point {
            // The detectors compare the measurements with the new set point only after the next reply.
            self.report.arrival = Arrival::default();
        }
        self.report.set_point_number = number;
        self.report.set_point = set_point;
        self.report.set_point_period = self.report.period;
        self.activity = Activity::Follow(set_point);
    }
}

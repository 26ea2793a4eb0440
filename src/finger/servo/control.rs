//! Computes a finger's command in one cycle. The servo takes what planners have sent, and then runs the controller.

use super::FingerServo;
use crate::control::Activity;
use crate::finger::{Adjustable, ControlInput, ControlRecord, Order, Stage};
use crate::model::configuration::EndState;

impl FingerServo {
    /// Computes the next command.
    pub(super) fn control(&mut self, skipped: u64) -> ControlRecord {
        let previous = self.take_commands();
        let previous = self.calibrate().or(previous);
        self.move_set_point();
        self.react();
        let input = ControlInput {
            anew_from: std::mem::take(&mut self.restart).then_some(self.feedback),
            activity: self.activity,
            skipped: if self.link.in_step() { 0 } else { skipped.min(self.link.most().into()) },
            fading: self.link.fading(),
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
}

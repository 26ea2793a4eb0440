//! The stages of a finger's life, from open to close, and what leads from one to the next.

use super::{FingerServo, STOPS_AFTER_FAULT};
use crate::board::protocol::Configured;
use crate::control::{Activity, Feedback, MotorCommand, SetPoint};
use crate::finger::{Fault, FaultKind, Order, Stage};
use crate::model::Part;
use nalgebra::Vector4;

/// While its tendons hang after a blow a joint seems to be so much further, rad, than any at rest does. Of 100 fingers
/// that a force of 6 N flung aside one seemed to be 0.55 rad beyond its limits, and came back.
const FLUNG: f64 = 0.3;

/// A machine that runs less than this part of the cycles of a finger while it opens explains why it takes long.
const MOSTLY: f64 = 0.75;

impl FingerServo {
    pub(super) fn carry_out(&mut self, order: Order) {
        match order {
            Order::Nothing => {}
            Order::Calibrate(run) => {
                self.begin_calibration(run);
            }
            Order::Restart { limp } => {
                self.anew = true;
                if limp {
                    self.go_limp();
                } else {
                    self.take_up_slack();
                }
            }
        }
    }

    pub(super) fn go_limp(&mut self) {
        self.activity = Activity::Turn(Vector4::zeros());
        self.enter(Stage::Limp);
    }

    /// Decides what the finger does next by what the cycle has found.
    pub(super) fn move_on(&mut self) {
        self.stage_cycles += 1;
        match self.report.stage {
            Stage::Opening if self.report.cycle.under_tension => {
                // Without a reply it says what was, not what is.
                self.settled_cycles += u32::from(self.answered);
                if self.settled_cycles >= self.limits.settled {
                    self.check_pose(0.0);
                    if !self.under_control() {
                        return;
                    }
                    let joints = self.report.cycle.joints;
                    self.report.set_point = SetPoint { joints, ..self.initial };
                    self.report.springs += 1;
                    self.activity = Activity::Follow(self.report.set_point);
                    self.supervision.begin();
                    self.enter(Stage::Running);
                }
            }
            Stage::Opening => self.settled_cycles = 0,
            Stage::Running => self.check_pose(FLUNG),
            Stage::Closing if self.stage_cycles > self.limits.ramp => self.enter(Stage::Closed),
            _ => {}
        }
    }

    /// Stops a finger that has been opening for too long in the cycle that begins at `began`, ns. By the clock and not
    /// by cycles, because a machine that runs few of them must not keep a planner waiting.
    pub(super) fn limit_opening(&mut self, began: u64) {
        if self.report.stage != Stage::Opening {
            return;
        }
        let since = *self.opening_since.get_or_insert(began);
        let waited_ms = began.saturating_sub(since) as f64 * 1e-6;
        if waited_ms < self.limits.opening_ms {
            return;
        }
        // A tendon is to blame where the motors had the time to wind it in.
        let wound_ms = f64::from(self.stage_cycles) * self.limits.period_ms;
        self.fault(if wound_ms >= MOSTLY * waited_ms {
            let slackest = self.report.cycle.slackest;
            let value = self.report.cycle.tensions[slackest];
            Fault { kind: FaultKind::SlackTendon, part: Part::tendon(slackest), value }
        } else {
            Fault::of(FaultKind::OpeningTimedOut, waited_ms)
        });
    }

    pub(super) fn enter(&mut self, stage: Stage) {
        self.report.stage = stage;
        self.stage_cycles = 0;
    }

    /// Goes on after a fault: the board has been configured anew, and nothing has moved the motors yet.
    pub(in crate::finger) fn recover(&mut self, configured: &Configured, stop_calls: u32) {
        self.alarm.forget(stop_calls);
        self.feedback = Feedback { motor_counts: configured.encoders, gauge_counts: configured.gauges };
        self.status = configured.status;
        self.sampled_at = None;
        self.command = MotorCommand::default();
        self.anew = true;
        self.link.answered();
        self.calibration = None;
        // What was ordered before the fault and not begun is gone with it; what was handed over stays, but nothing goes
        // over to it.
        self.report.orders += u32::from(self.mailbox.new_order().is_some());
        if let Some(new) = self.mailbox.new_adjustable() {
            self.adjustable = new.clone();
        }
        self.stops_left = STOPS_AFTER_FAULT;
        self.report.recoveries += 1;
        self.take_up_slack();
    }

    fn take_up_slack(&mut self) {
        self.activity = Activity::TakeUpSlack;
        self.settled_cycles = 0;
        self.opening_since = None;
        self.enter(Stage::Opening);
    }

    /// A spring pulls a finger that is believed to be where it cannot be with all it has. `further`: rad, beyond
    /// what a joint at rest can seem to be.
    fn check_pose(&mut self, further: f64) {
        let (low, high) = self.adjustable.pose;
        let (low, high) = (low.add_scalar(-further), high.add_scalar(further));
        let joints = self.report.cycle.joints;
        if let Some(joint) = (0..3).find(|&joint| !(low[joint]..=high[joint]).contains(&joints[joint])) {
            let value = joints[joint].to_degrees();
            self.fault(Fault { kind: FaultKind::ImpossiblePose, part: Part::joint(joint), value });
        }
    }
}

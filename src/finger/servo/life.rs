//! The stages of a finger from open to close, and the transitions between them.

use super::construction::found;
use super::{FingerServo, STOPS_AFTER_FAULT};
use crate::control::{Activity, MotorCommand, SetPoint};
use crate::finger::{Fault, FaultKind, Order, RestoredBoard, Stage};
use crate::model::Part;
use nalgebra::Vector4;

/// Margin of the pose check in the stage Running, rad, in addition to the 0.5 rad beyond the joint limits that are
/// always permitted. After a blow, a joint whose tendons are slack can seem to be further beyond its limits than any
/// joint at rest. Of 100 fingers hit by a force of 6 N, one had a joint that seemed to be 0.55 rad beyond its limits
/// and then returned.
const BLOW_MARGIN: f64 = 0.3;

/// If less than this fraction of the scheduled cycles has run in an opening that times out, the fault names the machine
/// as the cause. Otherwise the fault names a tendon.
const MOST_CYCLES: f64 = 0.75;

impl FingerServo {
    pub(super) fn carry_out(&mut self, order: Order) {
        match order {
            Order::Nothing => {}
            Order::Calibrate(run) => {
                self.begin_calibration(run);
            }
            Order::Restart { limp } => {
                self.restart = true;
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

    /// Enters the next stage if this cycle's results permit it.
    pub(super) fn move_on(&mut self) {
        self.stage_cycles += 1;
        match self.report.stage {
            Stage::Opening if self.report.cycle.under_tension => {
                // Without a reply, `under_tension` describes an earlier cycle.
                self.settled_cycles += u32::from(self.answered);
                if self.settled_cycles >= self.limits.settled {
                    self.check_pose(0.0);
                    if !self.under_control() {
                        return;
                    }
                    let joints = self.report.cycle.joints;
                    self.report.springs += 1;
                    let stiffness = self.adjustable.reactions.stiffness(&self.initial.stiffness);
                    self.follow(SetPoint { joints, stiffness, ..self.initial }, self.report.set_point_number);
                    self.motion.begin(joints);
                    self.report.expired_phase = None;
                    self.report.expired = false;
                    self.supervision.begin();
                    // The detectors do not run until the next cycle. A planner may wait for the arrival before then,
                    // so the arrival is reported now.
                    self.report.arrival = self.events.restart_detectors(self.report.set_point);
                    self.enter(Stage::Running);
                }
            }
            Stage::Opening => self.settled_cycles = 0,
            Stage::Running => self.check_pose(BLOW_MARGIN),
            Stage::Closing if self.stage_cycles > self.limits.ramp => self.enter(Stage::Closed),
            _ => {}
        }
    }

    /// Faults a finger that has been opening for too long. `began` is the beginning of this cycle, ns. The limit is a
    /// time and not a number of cycles, because on a machine that runs few cycles the planner must not wait longer.
    pub(super) fn limit_opening(&mut self, began: u64) {
        if self.report.stage != Stage::Opening {
            return;
        }
        let since = *self.opening_since.get_or_insert(began);
        let waited_ms = began.saturating_sub(since) as f64 * 1e-6;
        if waited_ms < self.limits.opening_ms {
            return;
        }
        // If the motors had enough cycles to wind the tendon in, the tendon is the cause.
        let wound_ms = f64::from(self.stage_cycles) * self.limits.period_ms;
        self.fault(if wound_ms >= MOST_CYCLES * waited_ms {
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

    /// Ages the warnings of a finger that is faulted or closed, because its monitors do not run any more. `controlled`
    /// says whether the controller has run in this cycle. The warnings have then already aged, even if the finger has
    /// faulted in this cycle.
    pub(super) fn age_warnings(&mut self, controlled: bool) {
        if !controlled && !self.under_control() {
            self.report.warnings.note(&mut self.supervision.recent_warnings, None, self.limits.warning);
        }
    }

    /// Resumes after a fault. The board has been configured again, and its motors have been off since. A request to
    /// stop that is later than the requests in `restored` stops the finger again.
    pub(in crate::finger) fn recover(&mut self, restored: &RestoredBoard) {
        let RestoredBoard { configured, stops, restarts } = restored;
        self.alarm.forget(stops);
        self.mailbox.forget_stops(*stops);
        self.mailbox.discard_groups();
        self.feedback = found(configured);
        self.status = configured.status;
        if let Stage::Faulted(fault) = self.report.stage {
            self.touch.recover(fault.kind, *restarts);
        }
        self.sampled_at = None;
        self.command = MotorCommand::default();
        self.restart = true;
        // The motors have cooled since their torque ended. The servo notes the time of every cycle, even while the
        // finger is faulted. A keyframe is recorded before the first cycle, so a replay starts with the cooled motors
        // too.
        let off_ms = self.report.last.saturating_sub(self.faulted_at) as f64 * 1e-6 - self.limits.hold_ms;
        self.adjustable.controller.cool(&mut self.state, off_ms.max(0.0) * 1e-3);
        self.link.answered();
        self.supervision.recover();
        self.calibration = None;
        // An order that was given before the fault and was not taken is discarded. A configuration that came with the
        // order is kept: the controller starts with it, and does not continue from the state of the previous
        // controller.
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

    /// Faults a finger whose measured pose is impossible. Without the fault, its spring would pull it with full force.
    /// `margin`, rad, is added to the limits of a joint at rest.
    fn check_pose(&mut self, margin: f64) {
        let (low, high) = self.adjustable.pose;
        let (low, high) = (low.add_scalar(-margin), high.add_scalar(margin));
        let joints = self.report.cycle.joints;
        if let Some(joint) = (0..3).find(|&joint| !(low[joint]..=high[joint]).contains(&joints[joint])) {
            let value = joints[joint].to_degrees();
            self.fault(Fault { kind: FaultKind::ImpossiblePose, part: Part::joint(joint), value });
        }
    }
}

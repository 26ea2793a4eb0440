//! One finger in its servo thread. In each cycle it uses the board's reply to compute the next command. It does this
//! from the opening of the finger until the finger is closed.

mod calibrating;
mod calibration;
mod construction;
mod control;
mod event_output;
mod events;
mod exchange;
mod groups;
mod life;
mod motion;
mod reflexes;
mod reflexive;
mod set_point_motion;

use crate::board::LinkCounters;
use crate::board::protocol::{Identity, Status};
use crate::calibration::Verdict;
use crate::control::{Activity, Feedback, MotorCommand, SetPoint, State};
use crate::finger::Adjustable;
use crate::finger::events::Occurrence;
use crate::finger::link_watch::LinkWatch;
use crate::finger::mailbox::ServoEnd;
use crate::finger::supervision::Supervision;
use crate::finger::touch::{Elements, TouchFetching};
use crate::finger::{CycleRecord, Fault, FaultKind, FingerReport, Recorder, Stage, StopSignal};
use crate::model::configuration::EndState;
use crate::realtime::{self, CycleTiming, LockedMemory, Producer};
use calibration::Calibrating;
use event_output::EventOutput;
use reflexive::Reflexive;
use set_point_motion::SetPointMotion;

/// Number of Stop frames that the board gets after a fault. There are several, because a line that has just failed may
/// lose one.
const STOPS_AFTER_FAULT: u8 = 3;

/// One finger: its controller, its part of the board protocol, and its mailbox.
pub struct FingerServo {
    adjustable: Adjustable,
    state: State,
    activity: Activity,
    calibration: Option<Calibrating>,
    /// Status of the newest reply.
    status: Status,
    feedback: Feedback,
    /// Whether the controller must restart from the feedback.
    restart: bool,
    /// The value of `report.last` when the last fault occurred, ns.
    faulted_at: u64,
    command: MotorCommand,
    mailbox: ServoEnd,
    timing: CycleTiming,
    timings: Producer<CycleTiming>,
    black_box: Recorder,
    reflexes: Reflexive,
    touch: TouchFetching,
    events: EventOutput,
    /// The black box record of this cycle; none if the finger was already faulted or closed.
    record: Option<CycleRecord>,
    /// Whether the finger was under control at the end of the last cycle. The next cycle is then recorded, even if the
    /// finger stops in it.
    recording: bool,
    report: FingerReport,
    address: u8,
    /// The identity that the board has reported. It is used to convert torques to counts.
    board: Identity,
    sequence: u8,
    toggle: bool,
    answered: bool,
    /// Whether a reply was accepted in this cycle.
    replied: bool,
    /// Sequence number of the last reply that was accepted.
    last_answer: u8,
    link: LinkWatch,
    motion: SetPointMotion,
    supervision: Supervision,
    alarm: StopSignal,
    /// The board's clock at the last measurement, us modulo 65 536; none before the first measurement.
    sampled_at: Option<u16>,
    /// Number of periods from the last measurement to this cycle.
    sample_age: u64,
    limits: Limits,
    settled_cycles: u32,
    /// Cycles since the stage began.
    stage_cycles: u32,
    /// Time at which the finger began to take up slack, ns; none until the first cycle of the opening stage.
    opening_since: Option<u64>,
    stops_left: u8,
    /// The set point with which the finger enters the stage `Running`. The finger then holds its present pose, so the
    /// joint angles of this set point are not used.
    initial: SetPoint,
    end_state: EndState,
    /// The memory outside this struct that the servo accesses.
    memory: LockedMemory,
}

/// Limits from the configuration, in cycles unless the name has a unit.
struct Limits {
    period_ms: f64,
    /// Longest permitted time until the finger enters the stage `Running`, ms.
    opening_ms: f64,
    settled: u32,
    ramp: u32,
    /// Time for which a warning is kept.
    warning: u32,
    /// Time for which a board may keep the torque of a finger that has faulted, ms.
    hold_ms: f64,
}

impl Limits {
    /// Returns the period, s.
    fn period(&self) -> f64 {
        self.period_ms * 1e-3
    }
}

impl FingerServo {
    /// Keeps the motors off until a planner orders the finger to take up slack.
    pub fn limp(mut self) -> Self {
        self.go_limp();
        self
    }

    /// Returns the finger's tactile elements.
    pub fn touch(&self) -> &Elements {
        self.touch.elements()
    }

    /// Returns the memory outside this struct that the servo accesses.
    pub fn memory(&self) -> &LockedMemory {
        &self.memory
    }

    /// Sets the signal that stops this finger.
    pub fn with(mut self, alarm: StopSignal) -> Self {
        alarm.add_to(&mut self.memory);
        self.mailbox.forget_stops(alarm.answered());
        self.alarm = alarm;
        self
    }

    /// Begins a period. `began` is the time at which it began, ns. Faults the finger after an emergency stop call,
    /// after a request to stop this finger, or after the fault of a finger that stops together with this one.
    pub fn begin_period(&mut self, began: u64) {
        self.events.begin_cycle(self.report.losses.cycles + 1, began);
        self.replied = false;
        let requested = self.mailbox.stop_requested().then_some(FaultKind::FingerStopCall);
        if let Some(kind) = self.alarm.pending().or(requested) {
            self.fault(Fault::new(kind));
        }
    }

    /// Returns whether the finger has faulted, all of its Stop frames are sent, and it has not been asked to close.
    pub fn at_rest(&self) -> bool {
        matches!(self.report.stage, Stage::Faulted(_)) && self.stops_left == 0 && !self.mailbox.closing()
    }

    /// Returns the address of the finger on its port.
    pub fn address(&self) -> u8 {
        self.address
    }

    /// Returns whether the finger is closed, or is faulted and has been asked to close.
    pub fn finished(&self) -> bool {
        match self.report.stage {
            Stage::Closed => true,
            Stage::Faulted(_) => self.mailbox.closing(),
            _ => false,
        }
    }

    /// Ends a cycle and computes the next command. `next` is the scheduled beginning of the next cycle, ns. If that
    /// time has already passed, `overrun` is the number of skipped periods, which may be 0. Otherwise it is None.
    pub fn end(&mut self, began: u64, next: u64, overrun: Option<u64>, counters: &LinkCounters) {
        let skipped = overrun.unwrap_or(0);
        self.sample_age += 1 + skipped;
        let losses = &mut self.report.losses;
        losses.cycles += 1;
        losses.overruns += u64::from(overrun.is_some());
        losses.skipped_periods += skipped;
        (losses.damaged_frames, losses.foreign_frames) = (counters.damaged, counters.foreign);
        (self.report.last, self.report.next) = (began, next);
        if losses.cycles == 1 {
            self.report.first = began;
        }
        if self.under_control()
            // If the servo and a simulated board run in step, a missing reply indicates a busy machine, not line noise.
            && let Some(fault) =
                self.supervision.note_period(self.answered || self.link.in_step(), skipped, counters.damaged)
        {
            self.fault(fault);
        }
        if self.under_control() {
            self.count_replies();
        }
        let recorded = self.recording || self.under_control();
        if self.under_control() {
            self.black_box.keyframe(self.report.losses.cycles, &self.state, !self.recording);
        }
        self.limit_opening(began);
        let controls = self.under_control() && (self.answered || !self.link.in_step());
        let control = controls.then(|| self.control(skipped));
        self.age_warnings(control.is_some());
        if recorded {
            self.record = Some(CycleRecord {
                cycle: self.report.losses.cycles,
                began,
                stage: self.report.stage,
                timing: CycleTiming::default(),
                feedback: self.replied.then_some(self.feedback),
                status: self.status.0,
                control,
            });
        }
        self.recording = self.under_control();
        self.report.controller = self.adjustable.number;
    }

    /// Notes when a stage of this cycle began and ended, ns.
    pub fn note(&mut self, stage: realtime::CycleStage, from: u64, to: u64) {
        self.timing.note(stage, from, to);
    }

    /// Publishes the timing, the record and the report of this cycle. The report comes after the record, so that a
    /// planner that has read the report of a cycle also finds the record of that cycle. The exception is a record that
    /// the black box holds back until an earlier fault is reported (`BlackBox::wait_at_faults`).
    pub fn publish(&mut self) {
        let timing = std::mem::take(&mut self.timing);
        if let Some(record) = self.record.take() {
            self.black_box.record(CycleRecord { timing, ..record });
        }
        self.mailbox.publish(self.report);
        // The events come after the report, so that a planner that has read an event finds the report of its cycle.
        self.events.publish(self.report.next);
        self.note_events();
        // The timing comes after the report, so that a reader never counts more timings than cycles. The ring is full
        // only if no thread collects the timings. Then the timing is dropped, because the cycle is more important.
        let _ = self.timings.push(timing);
    }

    /// Stops the finger because of a fault.
    pub fn fault(&mut self, fault: Fault) {
        if self.under_control() {
            self.alarm.raise(fault.kind);
            self.events.write(Occurrence::fault(&fault));
            self.faulted_at = self.report.last;
            self.enter(Stage::Faulted(fault));
        }
    }

    fn under_control(&self) -> bool {
        !matches!(self.report.stage, Stage::Closed | Stage::Faulted(_))
    }

    /// Runs the monitors of a finger that follows set points, and notes the warning of this cycle.
    fn watch(&mut self, adjusted: bool) {
        if adjusted {
            self.supervision.adjusted();
        }
        let spring = match &self.calibration {
            Some(calibration) => calibration.spring(),
            None => (self.report.stage == Stage::Running).then_some(&self.adjustable),
        };
        if let Some(Adjustable { controller, .. }) = spring {
            let feedback = self.answered.then_some(&self.feedback);
            if let Some(fault) = self.supervision.spring(controller, &self.state, feedback) {
                self.fault(fault);
            }
        }
        let failed = match self.report.calibration {
            Some(Verdict::Refused(_)) if self.report.stage == Stage::Limp => {
                Some(Fault::new(FaultKind::CalibrationFailed))
            }
            _ => None,
        };
        let warning = failed.or(self.supervision.warning());
        let new = self.report.warnings.note(&mut self.supervision.recent_warnings, warning, self.limits.warning);
        if let Some(warning) = warning.filter(|_| new) {
            self.events.write(Occurrence::warning(&warning));
        }
    }

    fn count_replies(&mut self) {
        if self.answered {
            if self.link.answered() {
                self.restart = true;
                self.supervision.resume();
            }
            return;
        }
        self.report.losses.lost_replies += 1;
        if let Some(lost) = self.link.missed() {
            self.fault_silence(lost);
        }
    }
}

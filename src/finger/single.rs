//! One finger in its servo thread: from reply to command, and from open to close.

mod life;

use crate::board::protocol::{Command as BoardCommand, Configured, Identity, Status};
use crate::board::{LinkCounters, OutgoingCommand, Received};
use crate::control::calibration::Verdict;
use crate::control::{Activity, Command, Controller, Feedback, SetPoint, State};
use crate::finger::link_watch::LinkWatch;
use crate::finger::mailbox::{Adjustable, CalibrationRun, Mailbox, ServoEnd, mailbox};
use crate::finger::watching::Watching;
use crate::finger::{
    Alarm, ControlInput, ControlRecord, CycleRecord, Fault, FaultKind, FingerReport, Recorder, Stage, stop_calls,
};
use crate::model::configuration::{Configuration, EndState, Unusable};
use crate::realtime::{self, CycleTiming, Memory};
use nalgebra::{Matrix3, Vector3};
use rtrb::Producer;

/// For so long, s, every tendon must be under tension and the motors still before the finger becomes a spring.
const TENSION_SETTLED: f64 = 0.02;

/// So far beyond its soft limits, rad, no joint gets: stops are closer, and measured angles err by less.
const BEYOND_LIMITS: f64 = 0.5;

/// The board's clock wraps after 65.5 ms: after a longer silence, ms, it does not say how old a measurement is.
const CLOCK_UNKNOWN_MS: f64 = 60.0;

/// After a fault the board is told to stop so many times: more than once, because a line that has just failed may lose one.
const STOPS_AFTER_FAULT: u8 = 3;

/// So long, ms, a warning stays after it was last given.
const WARNING_MS: f64 = 1000.0;

/// One finger: its controller, its place in the protocol, its mailbox.
pub struct FingerServo {
    adjustable: Adjustable,
    state: State,
    activity: Activity,
    calibration: Option<CalibrationRun>,
    /// Of the newest reply.
    status: Status,
    feedback: Feedback,
    /// The state is to be made anew from the feedback.
    anew: bool,
    command: Command,
    mailbox: ServoEnd,
    timing: CycleTiming,
    timings: Producer<CycleTiming>,
    black_box: Recorder,
    /// What this cycle leaves in the black box; none of a finger that was faulted or closed before.
    record: Option<CycleRecord>,
    /// Whether the last cycle left something there.
    recording: bool,
    report: FingerReport,
    address: u8,
    /// Knows the torque of one count of a command.
    board: Identity,
    sequence: u8,
    toggle: bool,
    answered: bool,
    /// Sequence number of the reply that was taken last.
    last_answer: u8,
    link: LinkWatch,
    watching: Watching,
    alarm: Alarm,
    /// The board's clock at the last measurement, us modulo 65 536; none before the first.
    sampled_at: Option<u16>,
    /// Periods from that measurement to this cycle.
    sample_age: u64,
    limits: Limits,
    settled_cycles: u32,
    /// Cycles since the stage began.
    stage_cycles: u32,
    stops_left: u8,
    /// How the finger holds the pose that it finds at open.
    initial: SetPoint,
    end_state: EndState,
    /// What of the finger is on the heap.
    memory: Memory,
}

/// Times of the configuration, in cycles.
struct Limits {
    period_ms: f64,
    tension: u32,
    settled: u32,
    ramp: u32,
    /// How long a warning stays.
    warning: u32,
}

impl Adjustable {
    /// What the configuration says. `number`: of the controller, in the finger's black box.
    ///
    /// # Errors
    /// A configuration that no controller can be made from.
    pub fn new(configuration: &Configuration, index: usize, number: u32) -> Result<Self, Unusable> {
        let finger = &configuration.fingers[index];
        let (low, high) = finger.joint_limits();
        let pose = (low.add_scalar(-BEYOND_LIMITS), high.add_scalar(BEYOND_LIMITS));
        let controller = Controller::in_gravity(finger, &configuration.gravity(index), configuration.hand.rate)?;
        Ok(Self { number, controller, pose })
    }
}

impl FingerServo {
    /// A finger that stands where its board says, limp, with the planners' end of its mailbox. Timings go to `timings`, records
    /// of its cycles to `black_box`; those that nobody collects are dropped.
    ///
    /// `stiffness` is the Kx that it will hold its pose with, already admitted.
    ///
    /// # Errors
    /// A configuration that no controller can be made from.
    pub fn new(
        configuration: &Configuration,
        index: usize,
        stiffness: Matrix3<f64>,
        identity: &Identity,
        configured: &Configured,
        mut timings: Producer<CycleTiming>,
        mut black_box: Recorder,
    ) -> Result<(Self, Mailbox), Unusable> {
        let (hand, finger) = (&configuration.hand, &configuration.fingers[index]);
        let address = configuration.address(index);
        let adjustable = Adjustable::new(configuration, index, 0)?;
        let feedback = Feedback { motor_counts: configured.encoders, gauge_counts: configured.gauges };
        let state = adjustable.controller.start(&feedback);
        let cycles = |milliseconds: f64| (milliseconds * 1e-3 * hand.rate).ceil() as u32;
        let link = LinkWatch::new(hand, finger.simulated());
        let law = finger.controller.law;
        let initial = SetPoint { law, ..SetPoint::hard_finger(Vector3::zeros(), stiffness) };
        let report = FingerReport {
            stage: Stage::Opening,
            set_point: initial,
            springs: 0,
            controller: 0,
            cycle: Default::default(),
            orders: 0,
            calibration: None,
            cycles: 0,
            overruns: 0,
            skipped_periods: 0,
            lost_replies: 0,
            late_replies: 0,
            duplicate_replies: 0,
            damaged_frames: 0,
            foreign_frames: 0,
            recoveries: 0,
            warnings: Default::default(),
            first: 0,
            last: 0,
        };
        let (planners, servo, mut memory) = mailbox(report, &adjustable);
        memory.append(&black_box.memory());
        memory.add(timings.buffer());
        let every = timings.slots();
        if let Ok(mut room) = timings.write_chunk(every) {
            // Nothing is sent: the room is written to, so that it is there.
            let (first, second) = room.as_mut_slices();
            memory.add(first);
            memory.add(second);
        }
        let this = Self {
            adjustable,
            state,
            activity: Activity::TakeUpSlack,
            calibration: None,
            status: configured.status,
            feedback,
            anew: false,
            command: Command::default(),
            mailbox: servo,
            timing: CycleTiming::default(),
            timings,
            black_box,
            record: None,
            recording: false,
            report,
            address,
            board: *identity,
            sequence: 0,
            toggle: false,
            answered: true,
            last_answer: 0,
            watching: Watching::new(hand.rate, link.most(), identity.gauge_bits),
            link,
            alarm: Alarm::new(false, stop_calls()),
            sampled_at: None,
            sample_age: 0,
            limits: Limits {
                period_ms: 1000.0 / hand.rate,
                tension: cycles(hand.open_timeout_ms.into()),
                settled: cycles(TENSION_SETTLED * 1e3),
                ramp: cycles(hand.release_ramp_ms.into()),
                warning: cycles(WARNING_MS),
            },
            settled_cycles: 0,
            stage_cycles: 0,
            stops_left: STOPS_AFTER_FAULT,
            initial,
            end_state: hand.end_state,
            memory,
        };
        Ok((this, planners))
    }

    /// The same finger with its motors off until it is told to take up slack.
    pub fn limp(mut self) -> Self {
        self.go_limp();
        self
    }

    /// What of the finger its servo touches and is not in this value itself.
    pub fn memory(&self) -> &Memory {
        &self.memory
    }

    /// The same finger, to be stopped by this alarm.
    pub fn with(mut self, alarm: Alarm) -> Self {
        self.alarm = alarm;
        self
    }

    /// Begins a period: stops where an emergency stop was called for, or another finger has faulted.
    pub fn listen(&mut self) {
        if let Some(kind) = self.alarm.heard() {
            self.fault(Fault::new(kind));
        }
    }

    /// Whether the finger has faulted, and its board been told.
    pub fn at_rest(&self) -> bool {
        matches!(self.report.stage, Stage::Faulted(_)) && self.stops_left == 0 && !self.mailbox.closing()
    }

    /// The address of the finger on its port.
    pub fn address(&self) -> u8 {
        self.address
    }

    /// Whether the finger has nothing more to tell its board.
    pub fn finished(&self) -> bool {
        match self.report.stage {
            Stage::Closed => true,
            Stage::Faulted(_) => self.mailbox.closing(),
            _ => false,
        }
    }

    /// Begins a cycle: the command that the last one found, if the finger is under control and the command due.
    pub fn begin(&mut self) -> Option<OutgoingCommand> {
        if !self.under_control() {
            return None;
        }
        if self.answered || !self.link.in_step() {
            self.sequence = self.sequence.wrapping_add(1);
            self.toggle = !self.toggle;
            self.answered = false;
        } else if !self.link.repeats() {
            return None;
        }
        let torques = self.command.motor_torques.map(|torque| self.board.torque_count(torque)).into();
        let command = BoardCommand { toggle: self.toggle, enable: true, torques };
        Some(OutgoingCommand { address: self.address, sequence: self.sequence, command })
    }

    /// Whether the board shall be told to stop, after a fault or at the end.
    pub fn stopping(&mut self) -> bool {
        let stopping = !self.under_control() && self.stops_left > 0;
        self.stops_left -= u8::from(stopping);
        stopping
    }

    /// Whether this cycle's reply is still awaited.
    pub fn waiting(&self) -> bool {
        !self.answered && self.under_control()
    }

    /// Whether a reply answers this cycle's command: a late one would be an old measurement.
    pub fn awaits(&self, received: &Received) -> bool {
        received.sequence == self.sequence && self.waiting()
    }

    /// Counts a reply that this cycle does not await: it came once more, or when its cycle was over.
    pub fn pass_over(&mut self, received: &Received) {
        match received.sequence == self.last_answer {
            true => self.report.duplicate_replies += 1,
            false => self.report.late_replies += 1,
        }
    }

    /// The board's clock as this cycle's command arrived, us modulo 65 536; none without a reply.
    pub fn sampled_at(&self) -> Option<u16> {
        self.sampled_at.filter(|_| self.answered)
    }

    /// Takes in the reply that answers this cycle's command.
    pub fn take(&mut self, received: &Received) {
        self.answered = true;
        self.last_answer = received.sequence;
        let reply = &received.reply;
        let mut age = self.sample_age as f64;
        // This cycle's command took effect as it was sampled; what it was computed from was sampled before.
        if let Some(before) = self.sampled_at
            && self.sample_age as f64 * self.limits.period_ms < CLOCK_UNKNOWN_MS
        {
            let microseconds = reply.sampled_at.wrapping_sub(before);
            self.timing.note(realtime::Stage::Age, 0, u64::from(microseconds) * 1000);
            age = f64::from(microseconds) * 1e-3 / self.limits.period_ms;
        }
        (self.sampled_at, self.sample_age) = (Some(reply.sampled_at), 0);
        self.feedback.motor_counts = reply.counts_after(self.feedback.motor_counts);
        self.feedback.gauge_counts = reply.gauges;
        self.watching.note_reply(reply.status, age);
        let zero_lost = self.status.has(Status::ZERO_VALID) && !reply.status.has(Status::ZERO_VALID);
        self.status = reply.status;
        if reply.status.has(Status::FAULTS | Status::WATCHDOG_TRIPPED | Status::ENDED) {
            self.fault(Fault::stopped(reply.status));
        } else if zero_lost {
            self.fault(Fault::of(FaultKind::ZeroLost, f64::from(reply.status.0)));
        }
    }

    /// Ends a cycle: computes the next command. `overrun`: the next cycle should have begun already, and so many periods are
    /// skipped.
    pub fn end(&mut self, began: u64, overrun: Option<u64>, heard: &LinkCounters) {
        let skipped = overrun.unwrap_or(0);
        self.sample_age += 1 + skipped;
        self.report.cycles += 1;
        self.report.overruns += u64::from(overrun.is_some());
        self.report.skipped_periods += skipped;
        (self.report.damaged_frames, self.report.foreign_frames) = (heard.damaged, heard.foreign);
        self.report.last = began;
        if self.report.cycles == 1 {
            self.report.first = began;
        }
        if self.under_control()
            // A machine that is busy is no noise on the line.
            && let Some(fault) =
                self.watching.note_period(self.answered || self.link.in_step(), skipped, heard.damaged)
        {
            self.fault(fault);
        }
        if self.under_control() {
            self.count_replies();
        }
        let recorded = self.recording || self.under_control();
        if self.under_control() {
            self.black_box.keyframe(self.report.cycles, &self.state, !self.recording);
        }
        let controls = self.under_control() && (self.answered || !self.link.in_step());
        let control = controls.then(|| self.control(skipped));
        if recorded {
            self.record = Some(CycleRecord {
                cycle: self.report.cycles,
                began,
                stage: self.report.stage,
                timing: CycleTiming::default(),
                feedback: self.answered.then_some(self.feedback),
                status: self.status.0,
                control,
            });
        }
        self.recording = self.under_control();
        self.report.controller = self.adjustable.number;
    }

    /// Computes the next command.
    fn control(&mut self, skipped: u64) -> ControlRecord {
        let previous = self.take_commands();
        self.calibrate();
        let input = ControlInput {
            anew_from: std::mem::take(&mut self.anew).then_some(self.feedback),
            activity: self.activity,
            skipped: if self.link.in_step() { 0 } else { skipped.min(self.link.most().into()) },
            fading: self.link.fading(),
        };
        let Adjustable { controller, number, .. } = match &self.calibration {
            Some(run) => &run.adjustable,
            None => &self.adjustable,
        };
        let feedback = self.answered.then_some(&self.feedback);
        let before = previous.as_ref().map(|previous| &previous.controller);
        let adjusted = before.is_some();
        let (command, report) = input.run(controller, before, &mut self.state, feedback);
        (self.command, self.report.cycle) = (command, report);
        let previous = previous.map_or(*number, |previous| previous.number);
        let record = ControlRecord { controller: *number, previous, input, command, report };
        self.watch(adjusted);
        self.move_on();
        record
    }

    /// Notes when a stage of this cycle began and ended, ns.
    pub fn note(&mut self, stage: realtime::Stage, from: u64, to: u64) {
        self.timing.note(stage, from, to);
    }

    /// Leaves the timing and the record of this cycle to whoever collects them, and then reports: who knows the report of a cycle
    /// finds its record.
    pub fn tell(&mut self) {
        let timing = std::mem::take(&mut self.timing);
        // A full ring means that nobody collects: the cycle is worth more than its figure.
        let _ = self.timings.push(timing);
        if let Some(record) = self.record.take() {
            self.black_box.record(CycleRecord { timing, ..record });
        }
        self.mailbox.publish(self.report);
    }

    /// Stops the finger for a reason.
    pub fn fault(&mut self, fault: Fault) {
        if self.under_control() {
            self.alarm.raise(fault.kind);
            self.enter(Stage::Faulted(fault));
        }
    }

    fn under_control(&self) -> bool {
        !matches!(self.report.stage, Stage::Closed | Stage::Faulted(_))
    }

    /// The monitors of a finger that is a spring.
    fn watch(&mut self, adjusted: bool) {
        if adjusted {
            self.watching.adjusted();
        }
        if self.report.stage == Stage::Running {
            let feedback = self.answered.then_some(&self.feedback);
            if let Some(fault) = self.watching.spring(&self.adjustable.controller, &self.state, feedback) {
                self.fault(fault);
            }
        }
        let failed = match self.report.calibration {
            Some(Verdict::Refused(_)) if self.report.stage == Stage::Limp => {
                Some(Fault::new(FaultKind::CalibrationFailed))
            }
            _ => None,
        };
        self.report.warnings.note(failed.or(self.watching.warning()), self.limits.warning);
    }

    fn count_replies(&mut self) {
        if self.answered {
            if self.link.answered() {
                self.anew = true;
                self.watching.begin();
            }
            return;
        }
        self.report.lost_replies += 1;
        if let Some(lost) = self.link.missed() {
            let milliseconds = f64::from(lost) * self.limits.period_ms;
            self.fault(self.watching.silence(milliseconds));
        }
    }
}

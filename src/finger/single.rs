//! One finger in its servo thread: from reply to command, and from open to close.

use crate::board::protocol::{Command as BoardCommand, Configured, Identity, Status};
use crate::board::{OutgoingCommand, Received};
use crate::control::calibration::{Calibration, Sample, Verdict};
use crate::control::{Activity, Command, Controller, Feedback, SetPoint, State};
use crate::finger::mailbox::{Adjustable, Mailbox, Order, ServoEnd, mailbox};
use crate::finger::{ControlInput, ControlRecord, CycleRecord, Fault, FaultKind, FingerReport, Recorder, Stage};
use crate::model::configuration::{Configuration, EndState, Unusable};
use crate::realtime::{self, CycleTiming, Memory};
use nalgebra::{Matrix3, Vector3, Vector4};
use rtrb::Producer;

/// For so long, s, every tendon must be under tension and the motors still before the finger becomes a spring.
const TENSION_SETTLED: f64 = 0.02;

/// A simulated board is silent when the machine is too busy to run it, or to carry its bytes: no reason to stop the hand.
const SIMULATION_PATIENCE_MS: f64 = 5000.0;

/// So long, ms, a simulated board has to answer before its command is sent again: either may have been thrown away.
const REPEAT_MS: f64 = 200.0;

/// So long, ms, the last command is repeated where replies stay away. Then the motors are let go until one comes: a torque that
/// nobody watches winds a tendon up, or off its motor, within some ms, and the watchdog does not see it, as commands go on.
const BLIND_MS: f64 = 10.0;

/// At slow rates so many lost replies in a row are let pass all the same.
const LEAST_BLIND: u32 = 3;

/// So far beyond its soft limits, rad, no joint gets: stops are closer, and measured angles err by less.
const BEYOND_LIMITS: f64 = 0.5;

/// The board's clock wraps after 65.5 ms: after a longer silence, ms, it does not say how old a measurement is.
const CLOCK_UNKNOWN_MS: f64 = 60.0;

/// After a fault the board is told to stop so many times: more than once, because a line that has just failed may lose one.
const STOPS_AFTER_FAULT: u8 = 3;

/// One finger: its controller, its place in the protocol, its mailbox.
pub struct FingerServo {
    adjustable: Adjustable,
    state: State,
    activity: Activity,
    calibration: Option<Calibration>,
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
    /// A simulated finger and its controller go on together: the next command leaves when the last one was answered, however late,
    /// and a cycle without a reply is none for the controller. The board stands still meanwhile.
    in_step: bool,
    lost_in_a_row: u32,
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
    lost: u32,
    repeat: u32,
    blind: u32,
    tension: u32,
    settled: u32,
    ramp: u32,
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
        let law = finger.controller.law;
        let initial = SetPoint { law, ..SetPoint::hard_finger(Vector3::zeros(), stiffness) };
        let report = FingerReport {
            stage: Stage::Opening,
            set_point: initial,
            cycle: Default::default(),
            orders: 0,
            calibration: None,
            cycles: 0,
            overruns: 0,
            skipped_periods: 0,
            lost_replies: 0,
            late_replies: 0,
            damaged_frames: 0,
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
            in_step: finger.simulated(),
            lost_in_a_row: 0,
            sampled_at: None,
            sample_age: 0,
            limits: Limits {
                period_ms: 1000.0 / hand.rate,
                lost: cycles(if finger.simulated() { SIMULATION_PATIENCE_MS } else { hand.watchdog_ms.into() }),
                repeat: cycles(REPEAT_MS),
                blind: if finger.simulated() { u32::MAX } else { cycles(BLIND_MS).max(LEAST_BLIND) },
                tension: cycles(hand.open_timeout_ms.into()),
                settled: cycles(TENSION_SETTLED * 1e3),
                ramp: cycles(hand.release_ramp_ms.into()),
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
        if self.answered || !self.in_step {
            self.sequence = self.sequence.wrapping_add(1);
            self.toggle = !self.toggle;
            self.answered = false;
        } else if !self.lost_in_a_row.is_multiple_of(self.limits.repeat) {
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

    /// Counts a reply that this cycle does not await.
    pub fn pass_over(&mut self, received: &Received) {
        self.report.late_replies += u64::from(received.sequence != self.sequence);
    }

    /// The board's clock as this cycle's command arrived, us modulo 65 536; none without a reply.
    pub fn sampled_at(&self) -> Option<u16> {
        self.sampled_at.filter(|_| self.answered)
    }

    /// Takes in the reply that answers this cycle's command.
    pub fn take(&mut self, received: &Received) {
        self.answered = true;
        let reply = &received.reply;
        // This cycle's command took effect as it was sampled; what it was computed from was sampled before.
        if let Some(before) = self.sampled_at
            && self.sample_age as f64 * self.limits.period_ms < CLOCK_UNKNOWN_MS
        {
            self.timing.note(realtime::Stage::Age, 0, u64::from(reply.sampled_at.wrapping_sub(before)) * 1000);
        }
        (self.sampled_at, self.sample_age) = (Some(reply.sampled_at), 0);
        self.feedback.motor_counts = reply.counts_after(self.feedback.motor_counts);
        self.feedback.gauge_counts = reply.gauges;
        self.status = reply.status;
        if reply.status.has(Status::FAULTS | Status::WATCHDOG_TRIPPED | Status::ENDED) {
            self.fault(Fault::stopped(reply.status));
        }
    }

    /// Ends a cycle: computes the next command and reports. `overrun`: the next cycle should have begun already, and so many periods are
    /// skipped.
    pub fn end(&mut self, began: u64, overrun: Option<u64>, damaged_frames: u64) {
        let skipped = overrun.unwrap_or(0);
        self.sample_age += 1 + skipped;
        self.report.cycles += 1;
        self.report.overruns += u64::from(overrun.is_some());
        self.report.skipped_periods += skipped;
        self.report.damaged_frames = damaged_frames;
        self.report.last = began;
        if self.report.cycles == 1 {
            self.report.first = began;
        }
        if self.under_control() {
            self.count_replies();
        }
        let recorded = self.recording || self.under_control();
        let controls = self.under_control() && (self.answered || !self.in_step);
        let control = controls.then(|| self.control(if self.in_step { 0 } else { skipped }));
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
        self.mailbox.publish(self.report);
    }

    /// Computes the next command.
    fn control(&mut self, skipped: u64) -> ControlRecord {
        let previous = self.take_commands();
        self.calibrate();
        let input = ControlInput {
            anew_from: std::mem::take(&mut self.anew).then_some(self.feedback),
            activity: self.activity,
            skipped: skipped.min(self.limits.lost.into()),
            let_go: self.lost_in_a_row >= self.limits.blind,
        };
        self.black_box.keyframe(self.report.cycles, &self.state, !self.recording);
        let Adjustable { controller, number, .. } = &self.adjustable;
        let feedback = self.answered.then_some(&self.feedback);
        let before = previous.as_ref().map(|previous| &previous.controller);
        let (command, report) = input.run(controller, before, &mut self.state, feedback);
        (self.command, self.report.cycle) = (command, report);
        let previous = previous.map_or(*number, |previous| previous.number);
        let record = ControlRecord { controller: *number, previous, input, command, report };
        self.move_on();
        record
    }

    /// Notes when a stage of this cycle began and ended, ns.
    pub fn note(&mut self, stage: realtime::Stage, from: u64, to: u64) {
        self.timing.note(stage, from, to);
    }

    /// Leaves the timing and the record of this cycle to whoever collects them.
    pub fn tell(&mut self) {
        let timing = std::mem::take(&mut self.timing);
        // A full ring means that nobody collects: the cycle is worth more than its figure.
        let _ = self.timings.push(timing);
        if let Some(record) = self.record.take() {
            self.black_box.record(CycleRecord { timing, ..record });
        }
    }

    /// Stops the finger for a reason.
    pub fn fault(&mut self, fault: Fault) {
        if self.under_control() {
            self.enter(Stage::Faulted(fault));
        }
    }

    fn under_control(&self) -> bool {
        !matches!(self.report.stage, Stage::Closed | Stage::Faulted(_))
    }

    /// A spring pulls a finger that is believed to be where it cannot be with all it has.
    fn check_pose(&mut self) {
        let (low, high) = self.adjustable.pose;
        let joints = self.report.cycle.joints;
        if let Some(joint) = (0..3).find(|&joint| !(low[joint]..=high[joint]).contains(&joints[joint])) {
            let value = joints[joint].to_degrees();
            self.fault(Fault { kind: FaultKind::ImpossiblePose, part: joint as u8, value });
        }
    }

    fn count_replies(&mut self) {
        if self.answered {
            if self.lost_in_a_row >= self.limits.blind {
                // The motors were let go: begin with what the tendons pull now, and not with what was commanded then.
                self.anew = true;
            }
            self.lost_in_a_row = 0;
            return;
        }
        self.report.lost_replies += 1;
        self.lost_in_a_row += 1;
        // Counted in attempts, not in time: a machine that pauses everything has lost no reply.
        if self.lost_in_a_row >= self.limits.lost {
            let milliseconds = f64::from(self.lost_in_a_row) * self.limits.period_ms;
            self.fault(Fault::of(FaultKind::LostReplies, milliseconds));
        }
    }

    /// Whatever planners have sent; what it computed with until now, if something else takes over from it.
    fn take_commands(&mut self) -> Option<Adjustable> {
        let order = self.mailbox.new_order();
        // After the order: what was handed over with it is there.
        let new = self.mailbox.new_adjustable();
        let mut previous = new.map(|new| std::mem::replace(&mut self.adjustable, new.clone()));
        if let Some(order) = order {
            self.report.orders += 1;
            if let Order::Restart { .. } = order {
                previous = None;
            }
            self.carry_out(order);
        }
        if let Some(set_point) = self.mailbox.new_set_point()
            && let Activity::Follow(_) = self.activity
        {
            self.report.set_point = set_point;
            self.activity = Activity::Follow(set_point);
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

    fn carry_out(&mut self, order: Order) {
        match order {
            Order::Nothing => {}
            Order::Calibrate(calibration) => {
                self.calibration = Some(calibration);
                self.report.calibration = None;
                self.enter(Stage::Calibrating);
            }
            Order::Restart { limp } => {
                self.anew = true;
                if limp {
                    self.go_limp();
                } else {
                    self.activity = Activity::TakeUpSlack;
                    self.settled_cycles = 0;
                    self.enter(Stage::Opening);
                }
            }
        }
    }

    /// One step of the calibration, if there is one: it decides what the finger does.
    fn calibrate(&mut self) {
        let Some(calibration) = &mut self.calibration else { return };
        if !self.answered {
            return;
        }
        let zero_valid = self.status.has(Status::ZERO_VALID);
        let sample = Sample { feedback: &self.feedback, report: &self.report.cycle, zero_valid };
        let (activity, verdict) = calibration.cycle(&sample);
        self.activity = activity;
        self.report.calibration = Some(verdict);
        if !matches!(verdict, Verdict::Going(_)) {
            self.calibration = None;
            self.go_limp();
        }
    }

    fn go_limp(&mut self) {
        self.activity = Activity::Turn(Vector4::zeros());
        self.enter(Stage::Limp);
    }

    /// Decides what the finger does next by what the cycle has found.
    fn move_on(&mut self) {
        self.stage_cycles += 1;
        match self.report.stage {
            Stage::Opening if self.report.cycle.under_tension => {
                // Without a reply it says what was, not what is.
                self.settled_cycles += u32::from(self.answered);
                if self.settled_cycles >= self.limits.settled {
                    self.check_pose();
                    if !self.under_control() {
                        return;
                    }
                    let joints = self.report.cycle.joints;
                    self.report.set_point = SetPoint { joints, ..self.initial };
                    self.activity = Activity::Follow(self.report.set_point);
                    self.enter(Stage::Running);
                }
            }
            Stage::Opening => {
                self.settled_cycles = 0;
                if self.stage_cycles >= self.limits.tension {
                    let slackest = self.report.cycle.slackest;
                    let value = self.report.cycle.tensions[slackest];
                    self.fault(Fault { kind: FaultKind::SlackTendon, part: slackest as u8 + 1, value });
                }
            }
            Stage::Running => self.check_pose(),
            Stage::Closing if self.stage_cycles > self.limits.ramp => self.enter(Stage::Closed),
            _ => {}
        }
    }

    fn enter(&mut self, stage: Stage) {
        self.report.stage = stage;
        self.stage_cycles = 0;
    }
}

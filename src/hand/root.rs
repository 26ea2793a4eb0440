//! Root: opens and closes a hand, owns its threads and ports, reports its status.

use crate::board::{Port, SimulatedFinger, SimulatedPort};
use crate::control::calibration::Verdict;
use crate::finger::{FingerReport, Servo, Stage};
use crate::hand::announcement::say;
use crate::hand::dispatcher::Dispatcher;
use crate::hand::opening::{Line, check, reach, simulate};
use crate::hand::{HandError, configured};
use crate::model::configuration::{Configuration, FINGERS};
use crate::realtime::{self, Distribution, MonotonicClock, Priority, Realtime, Schedule, now, spawn};
use crossbeam_channel::bounded;
use nalgebra::Vector3;
use parking_lot::RwLock;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::id;
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

type PortServo = Servo<Port, MonotonicClock>;

/// The first cycle begins so long after the threads are started, ns: they have their priorities and cores by then.
const HEAD_START: u64 = 10_000_000;

/// Bound on the components of a push, N: far beyond what tears a finger off, and not beyond what can be simulated.
const STRONGEST_PUSH: f64 = 1000.0;

/// A board takes no longer than this, ns, to confirm that it has stopped.
const STOPPING: u64 = 300_000_000;

/// A servo's last frames are on the line after this.
const LAST_WORDS: Duration = Duration::from_millis(20);

/// How often OpenHand looks whether every finger holds its pose.
const LOOKING: Duration = Duration::from_millis(1);

/// An open hand: three fingers, their servo threads and their ports. A value: a process can have several.
///
/// Every call may come from several threads. Dropping it closes it.
pub struct Hand {
    pub(super) dispatcher: Dispatcher,
    servos: Vec<JoinHandle<PortServo>>,
    simulated: [Option<SimulatedPort>; FINGERS],
    /// As it is now: planners may adjust it, and calibration changes what it finds.
    pub(super) configuration: RwLock<Configuration>,
    /// Where the configuration was read from, and where calibration is stored.
    pub(super) file: Option<PathBuf>,
    pub(super) realtime: bool,
    /// Within this time, ns, every finger reaches its end state.
    ending: u64,
    /// The process that has the threads. A forked child inherits this value, but not them.
    process: u32,
}

/// What is known of a finger and of the thread that serves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerStatus {
    /// Where the finger is between open and close.
    pub stage: Stage,
    /// Whether every servo thread runs under SCHED_FIFO.
    pub realtime: bool,
    /// Configured cycles in a second, Hz.
    pub rate: f64,
    /// Measured cycles in a second since open, Hz.
    pub measured_rate: f64,
    /// From the scheduled beginning of a cycle to its first instruction, microseconds: the servo's jitter.
    pub wake_up: Distribution,
    /// Cycles since open.
    pub cycles: u64,
    /// Cycles without a valid reply.
    pub lost_replies: u64,
    /// Periods skipped because the servo was late.
    pub skipped_periods: u64,
    /// Damaged or foreign frames on the finger's port.
    pub damaged_frames: u64,
    /// The part of the wanted joint torque that the tension limits let through in the last cycle, 0 to 1.
    pub torque_scale: f64,
    /// The part of the calibration under way that is done, 0 to 1; 0 where there is none.
    pub calibration: f64,
}

impl Hand {
    /// Opens the hand that the configuration file describes; where there is no such file the simulated one, and says so in
    /// one line on standard error.
    ///
    /// # Errors
    /// As [`Hand::open`], and a configuration file that cannot be read or used.
    pub fn open_configured() -> Result<Self, HandError> {
        Self::open_as(configured()?)
    }

    /// Opens the hand that [`configured`] has found.
    ///
    /// # Errors
    /// As [`Hand::open`].
    pub fn open_as((configuration, file): (Configuration, Option<PathBuf>)) -> Result<Self, HandError> {
        if file.is_none() {
            say("no configuration file: this is the simulated hand (SUN2XP_CONFIG or sun2xp.toml names a real one)");
        }
        Self::open_from(configuration, file, false)
    }

    /// Opens the hand: shakes hands with its boards, takes up the slack of its tendons and returns when every finger holds the
    /// pose it is in at its initial stiffness.
    ///
    /// # Errors
    /// A configuration that cannot be used, a port or board that does not serve, a finger that faults. Everything that was
    /// opened is closed again then, and every motor is in its end state.
    pub fn open(configuration: Configuration) -> Result<Self, HandError> {
        Self::open_from(configuration, None, false)
    }

    /// Opens the hand with its motors off: to find signs and zeros before anything pulls. `file`: where calibration shall
    /// be stored. A finger becomes a spring when it has been calibrated by [`Hand::zero`] or [`Hand::identify`].
    ///
    /// # Errors
    /// As [`Hand::open`].
    pub fn open_limp(configuration: Configuration, file: Option<PathBuf>) -> Result<Self, HandError> {
        Self::open_from(configuration, file, true)
    }

    fn open_from(configuration: Configuration, file: Option<PathBuf>, limp: bool) -> Result<Self, HandError> {
        check(&configuration)?;
        let simulated = simulate(&configuration)?;
        let (lines, reached) = reach(&configuration, &simulated, limp)?;
        let mut threads: Vec<u8> = lines.iter().map(|line| line.thread).collect();
        threads.sort_unstable();
        threads.dedup();

        let dispatcher = Dispatcher::new(reached);
        let ending = u64::from(configuration.hand.release_ramp_ms) * 1_000_000 + STOPPING;
        let configuration = RwLock::new(configuration);
        let servos = Vec::new();
        let mut hand =
            Self { dispatcher, servos, simulated, configuration, file, realtime: true, ending, process: id() };
        // From here on, dropping the hand closes it.
        hand.start(&threads, lines)?;
        hand.wait_for_every_finger()?;
        Ok(hand)
    }

    /// theta_d of finger 1, 2 or 3: joints 0, 1, 2, rad. Takes effect within a cycle.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, beyond a joint limit, finger faulted.
    pub fn send_position(&self, finger: i32, joints: [f64; 3]) -> Result<(), HandError> {
        self.dispatcher.send_position(finger, joints)
    }

    /// Kx of finger 1, 2 or 3 in the finger's frame, N/cm: `rows[row][column]`. Taken over whole, without a
    /// jump in torque: 95 % of the change is there after 50 ms.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, not symmetric, a negative eigenvalue, stiffer than the bound, finger faulted.
    pub fn send_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), HandError> {
        self.dispatcher.send_stiffness(finger, rows)
    }

    /// Measured joint angles of finger 1, 2 or 3, rad, not older than a cycle.
    ///
    /// # Errors
    /// No such finger, finger faulted.
    pub fn position(&self, finger: i32) -> Result<[f64; 3], HandError> {
        self.dispatcher.report(finger).map(|report| report.cycle.joints.into())
    }

    /// The newest report of finger 1, 2 or 3, faulted or not.
    ///
    /// # Errors
    /// No such finger.
    pub fn report(&self, finger: i32) -> Result<FingerReport, HandError> {
        self.dispatcher.last_report(finger)
    }

    /// How finger 1, 2 or 3 and its thread are doing.
    ///
    /// # Errors
    /// No such finger.
    pub fn status(&self, finger: i32) -> Result<FingerStatus, HandError> {
        let report = self.dispatcher.last_report(finger)?;
        let seconds = report.last.saturating_sub(report.first) as f64 * 1e-9;
        let intervals = report.cycles.saturating_sub(1) as f64;
        Ok(FingerStatus {
            stage: report.stage,
            realtime: self.realtime,
            rate: self.configuration.read().hand.rate,
            measured_rate: if seconds > 0.0 { intervals / seconds } else { 0.0 },
            wake_up: self.timing(finger, realtime::Stage::WakeUp)?,
            cycles: report.cycles,
            lost_replies: report.lost_replies,
            skipped_periods: report.skipped_periods,
            damaged_frames: report.damaged_frames,
            torque_scale: report.cycle.torque_scale,
            calibration: match report.calibration {
                Some(Verdict::Going(progress)) => progress.part,
                _ => 0.0,
            },
        })
    }

    /// How long a stage of the cycles of finger 1, 2 or 3 has taken since open or since the timings were last reset.
    ///
    /// # Errors
    /// No such finger.
    pub fn timing(&self, finger: i32, stage: realtime::Stage) -> Result<Distribution, HandError> {
        self.dispatcher.timing(finger, stage)
    }

    /// Forgets the timings of finger 1, 2 or 3.
    ///
    /// # Errors
    /// No such finger.
    pub fn reset_timing(&self, finger: i32) -> Result<(), HandError> {
        self.dispatcher.reset_timing(finger)
    }

    /// Pushes the fingertip of a simulated finger with a force in the finger's frame, N, until the next such call.
    ///
    /// # Errors
    /// No such finger, NaN or infinity, a finger on a real port.
    pub fn push_simulated(&self, finger: i32, force: [f64; 3]) -> Result<(), HandError> {
        self.dispatcher.member(finger)?.admission.read().finite("Force", &force)?;
        let index = finger as usize - 1; // the member is there: 1 to 3
        let port = self.simulated[index].as_ref().ok_or(HandError::NotSimulated(finger))?;
        let largest = Vector3::from(force).amax();
        if largest > STRONGEST_PUSH {
            return Err(HandError::TooMuchForce { finger, force: largest, strongest: STRONGEST_PUSH });
        }
        let push = |finger: &mut SimulatedFinger| finger.plant().set_external_force(Vector3::from(force));
        // The board was made with this one address.
        port.with_finger(self.configuration.read().address(index), push);
        Ok(())
    }

    /// Asks every finger to go to its end state, and waits until that should be done. Waits for no lock and frees nothing, so that it
    /// serves where a process is about to end, even in a signal handler. The hand is of no use afterwards.
    pub fn end(&self) {
        let members = self.dispatcher.members();
        members.iter().for_each(|member| member.mailbox.close());
        let limit = now() + self.ending;
        while now() < limit && !members.iter().all(|member| member.mailbox.ended() == Some(true)) {
            sleep(LOOKING);
        }
        // The servo says so a moment before it has told the board.
        sleep(LAST_WORDS);
    }

    /// Brings every finger to its end state, as configured, and ends the threads. The same as dropping the hand.
    pub fn close(self) {}

    fn start(&mut self, threads: &[u8], lines: Vec<Line>) -> Result<(), HandError> {
        let system = |doing| move |source| HandError::System { doing, source };
        self.dispatcher.start_collecting().map_err(system("start the thread that collects reports"))?;
        let period = (1e9 / self.configuration.read().hand.rate).round() as u64;
        let first = now() + HEAD_START;
        let mut lines: Vec<Option<Line>> = lines.into_iter().map(Some).collect();
        let (told, hear) = bounded(threads.len());
        for (place, &thread) in threads.iter().enumerate() {
            let own = lines.iter_mut().filter(|line| line.as_ref().is_some_and(|line| line.thread == thread));
            let ports = own.filter_map(Option::take).map(|line| line.port).collect();
            // Staggered, so that the fingers do not ask for one core at one instant.
            let phase = period * place as u64 / threads.len() as u64;
            let servo = Servo::new(MonotonicClock, Schedule::new(first + phase, period), ports);
            let told = told.clone();
            let handle = spawn(&format!("sun2xp servo {thread}"), self.priority(thread), move |realtime| {
                // The receiver waits for this; if OpenHand has given up meanwhile, nobody needs it.
                let _ = told.send(realtime);
                run(servo)
            });
            self.servos.push(handle.map_err(system("start a servo thread"))?);
        }
        // Ours would keep the channel open where a thread died before it could tell.
        drop(told);
        let had: Vec<Realtime> = hear.iter().take(threads.len()).collect();
        let asked = threads.iter().all(|&thread| self.priority(thread).fifo > 0);
        self.realtime = asked && had.len() == threads.len() && had.iter().all(|had| had.scheduling.is_none());
        announce(&had);
        Ok(())
    }

    fn priority(&self, thread: u8) -> Priority {
        let configuration = self.configuration.read();
        let own = (0..FINGERS).find(|&index| configuration.thread(index) == thread);
        // Fingers that share a thread have the same priority and core: the configuration was checked.
        let finger = own.map(|index| &configuration.fingers[index]);
        finger.map_or_else(Priority::default, |finger| Priority { fifo: finger.priority, core: finger.core })
    }

    /// Until every finger is a spring that holds its pose. Each decides by itself within the open time-out.
    fn wait_for_every_finger(&self) -> Result<(), HandError> {
        loop {
            let mut opening = false;
            for member in self.dispatcher.members() {
                match member.mailbox.report().stage {
                    Stage::Faulted(fault) => {
                        return Err(HandError::Faulted { finger: member.admission.read().finger, fault });
                    }
                    stage => opening |= stage == Stage::Opening,
                }
            }
            if !opening {
                self.dispatcher.members().iter().for_each(|member| member.mailbox.adopt());
                return Ok(());
            }
            sleep(LOOKING);
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        if self.process != id() {
            // A forked child: the threads and the motors are its parent's.
            self.servos.drain(..).for_each(std::mem::forget);
            self.dispatcher.forget_collector();
            return;
        }
        self.dispatcher.members().iter().for_each(|member| member.mailbox.close());
        for servo in self.servos.drain(..) {
            // A servo thread catches its own panics. Its ports are closed here, not in the servo: it may take long.
            let _ = servo.join();
        }
    }
}

/// The body of a servo thread. A panic is a defect, but it must not leave the last torque on the motors.
fn run(mut servo: PortServo) -> PortServo {
    if catch_unwind(AssertUnwindSafe(|| servo.run())).is_err() {
        // If even this panics, the board's watchdog is left.
        let _ = catch_unwind(AssertUnwindSafe(|| servo.fail()));
    }
    servo
}

/// Tells on standard error where servo threads are not what they should be.
fn announce(had: &[Realtime]) {
    if let Some(error) = had.iter().find_map(|had| had.scheduling.as_ref()) {
        say(&format!(
            "the servo is not real-time ({error}): allow it with CAP_SYS_NICE or an rtprio limit, or set \
             `finger.priority = 0`; until then its cycles may be late"
        ));
    }
    if let Some(error) = had.iter().find_map(|had| had.core.as_ref()) {
        say(&format!("a servo thread is not bound to its core ({error}): see `finger.core`"));
    }
}

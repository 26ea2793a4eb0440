//! Root: opens and closes a hand, owns its threads and ports.

use crate::finger::{FingerReport, Losses, Stage};
use crate::hand::dispatcher::Dispatcher;
use crate::hand::opening::{Connected, black_box_folder, check, from_here, reach, simulate};
use crate::hand::reconnection::Recovery;
use crate::hand::servo_threads::{Given, PortServo, start};
use crate::hand::{Configured, Fingers, Found, HandError, find_configuration};
use crate::model::configuration::{Configuration, FINGERS};
use crate::realtime::{self, Distribution, MonotonicClock, now};
use crate::simulated::{SimulatedFinger, SimulatedPort};
use nalgebra::Vector3;
use parking_lot::{Mutex, RwLock};
use std::path::PathBuf;
use std::process::id;
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

/// Bound on the components of a push, N: far beyond what tears a finger off, and not beyond what can be simulated.
const STRONGEST_PUSH: f64 = 1000.0;

/// A board takes no longer than this, ns, to confirm that it has stopped.
const STOPPING: u64 = 300_000_000;

/// A servo's last frames are on the line after this.
const LAST_WORDS: Duration = Duration::from_millis(20);

/// How often OpenHand looks whether every finger holds its pose.
const LOOKING: Duration = Duration::from_millis(1);

/// An open hand: its fingers, their servo threads and their ports. A value: a process can have several.
///
/// Every call may come from several threads. Dropping it closes it.
pub struct Hand {
    pub(super) dispatcher: Dispatcher,
    servos: Vec<JoinHandle<PortServo>>,
    pub(super) recovery: Recovery,
    simulated: [Option<SimulatedPort>; FINGERS],
    /// As it is now: planners may adjust it, and calibration changes what it finds.
    pub(super) configuration: RwLock<Configuration>,
    /// Where the configuration was read from, and where calibration is stored.
    pub(super) file: Option<PathBuf>,
    /// What calibration has found since it was last stored.
    pub(super) found: Mutex<Vec<Found>>,
    pub(super) given: Given,
    /// Within this time, ns, every finger reaches its end state.
    ending: u64,
    /// The process that has the threads. A forked child inherits this value, but not them.
    process: u32,
}

impl Hand {
    /// Opens the hand that the configuration file describes; where there is no such file the simulated one. One line on
    /// standard error says which fingers are simulated because no file names their ports.
    ///
    /// # Errors
    /// As [`Hand::open`], and a configuration file that cannot be read or used.
    pub fn open_configured() -> Result<Self, HandError> {
        Self::open_as(find_configuration()?)
    }

    /// Opens the hand that [`configured`] has found.
    ///
    /// # Errors
    /// As [`Hand::open`].
    pub fn open_as(configured: Configured) -> Result<Self, HandError> {
        configured.announce(Fingers::ALL);
        Self::open_from(configured.configuration, configured.file, Fingers::ALL, false)
    }

    /// Opens the hand: shakes hands with its boards, takes up the slack of its tendons and returns when every finger
    /// holds the pose it is in at its initial stiffness.
    ///
    /// # Errors
    /// A configuration that cannot be used, a port or board that does not serve, a finger that faults. Everything that
    /// was opened is closed again then, and every motor is in its end state.
    pub fn open(configuration: Configuration) -> Result<Self, HandError> {
        Self::open_from(configuration, None, Fingers::ALL, false)
    }

    /// Opens these fingers of the hand, with their motors off: to find signs and zeros before anything pulls. `file`:
    /// where calibration shall be stored. A finger becomes a spring when it has been calibrated by [`Hand::zero`] or
    /// [`Hand::identify`].
    ///
    /// # Errors
    /// As [`Hand::open`].
    pub fn open_limp(configuration: Configuration, file: Option<PathBuf>, fingers: Fingers) -> Result<Self, HandError> {
        Self::open_from(configuration, file, fingers, true)
    }

    fn open_from(
        configuration: Configuration,
        file: Option<PathBuf>,
        fingers: Fingers,
        limp: bool,
    ) -> Result<Self, HandError> {
        check(&configuration)?;
        // Where a sandbox forbids it, the servo threads would never wait, and others would panic.
        let waiting = MonotonicClock::check_sleep();
        waiting.map_err(|source| HandError::System { doing: "wait for a time (clock_nanosleep)", source })?;
        let (folder, file) = (black_box_folder(&configuration)?, file.map(from_here));
        let simulated = simulate(&configuration, fingers)?;
        let Connected { lines, reached, workshops } = reach(&configuration, fingers, &simulated, limp)?;
        let recovery = Recovery::new(workshops);
        let dispatcher = Dispatcher::new(reached);
        let ending = u64::from(configuration.hand.release_ramp_ms) * 1_000_000 + STOPPING;
        let configuration = RwLock::new(configuration);
        let servos = Vec::new();
        let given = Given::default();
        let (found, process) = (Mutex::default(), id());
        let mut hand =
            Self { dispatcher, servos, recovery, simulated, configuration, file, found, given, ending, process };
        // From here on, dropping the hand closes it.
        let collecting = hand.dispatcher.start_collecting(folder);
        collecting.map_err(|source| HandError::System { doing: "start the thread that collects reports", source })?;
        hand.given = start(&hand.configuration.read(), lines, &mut hand.servos)?;
        hand.wait_for_every_finger()?;
        let reconnecting = hand.recovery.start();
        reconnecting.map_err(|source| HandError::System { doing: "start the thread that looks for ports", source })?;
        Ok(hand)
    }

    /// Measured joint angles of finger 1, 2 or 3, rad, not older than a cycle.
    ///
    /// # Errors
    /// No such finger, finger faulted.
    pub fn position(&self, finger: i32) -> Result<[f64; 3], HandError> {
        self.dispatcher.position(finger)
    }

    /// The newest report of finger 1, 2 or 3, faulted or not.
    ///
    /// # Errors
    /// No such finger.
    pub fn report(&self, finger: i32) -> Result<FingerReport, HandError> {
        self.dispatcher.last_report(finger)
    }

    /// How long a stage of the cycles of finger 1, 2 or 3 has taken since open or since the timings were last reset.
    ///
    /// # Errors
    /// No such finger.
    pub fn timing(&self, finger: i32, stage: realtime::CycleStage) -> Result<Distribution, HandError> {
        self.dispatcher.timing(finger, stage)
    }

    /// How many cycles finger 1, 2 or 3 has had, and what went wrong in them, since open or since the timings were last
    /// reset.
    ///
    /// # Errors
    /// No such finger.
    pub fn losses(&self, finger: i32) -> Result<Losses, HandError> {
        self.dispatcher.losses(finger)
    }

    /// Begins to count timings and losses of finger 1, 2 or 3 anew.
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

    /// Asks every finger to go to its end state, and waits until that should be done. Waits for no lock and frees
    /// nothing, so that it serves where a process is about to end, even in a signal handler. The hand is of no use
    /// afterwards.
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

    /// Until every finger is a spring that holds its pose. Each decides by itself within the open time-out.
    fn wait_for_every_finger(&self) -> Result<(), HandError> {
        loop {
            let mut opening = false;
            for member in self.dispatcher.members() {
                match member.mailbox.report().stage {
                    Stage::Faulted(fault) => {
                        return Err(HandError::FaultedAtOpening { finger: member.admission.read().finger, fault });
                    }
                    stage => opening |= stage == Stage::Opening,
                }
            }
            if !opening {
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
            self.recovery.forget();
            return;
        }
        self.dispatcher.members().iter().for_each(|member| member.mailbox.close());
        for servo in self.servos.drain(..) {
            // A servo thread catches its own panics. Its ports are closed here, not in the servo: it may take long.
            let _ = servo.join();
        }
        self.recovery.end();
    }
}

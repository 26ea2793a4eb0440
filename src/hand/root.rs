//! Opens and closes a hand, and owns its threads and ports.

use crate::finger::{FingerReport, Losses, Stage};
use crate::hand::board_search::find_boards;
use crate::hand::dispatcher::Dispatcher;
use crate::hand::events::EventSource;
use crate::hand::hardware::Hardware;
use crate::hand::opening::{Connected, black_box_folder, check, check_goes_on, from_here, reach};
use crate::hand::reconnection::Recovery;
use crate::hand::servo_threads::{PortServo, RealtimeState, start};
use crate::hand::simulated_hand::SimulatedHand;
use crate::hand::unstored::Unstored;
use crate::hand::{Configured, HandError, find_configuration};
use crate::model::configuration::Configuration;
use crate::model::{FingerNumber, Fingers};
use crate::realtime::{self, Distribution, MonotonicClock, RwLock, now};
use crate::simulated::SimulatedFinger;
use nalgebra::Vector3;
use std::path::PathBuf;
use std::process::id;
use std::sync::Arc;
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

/// Largest component of a push, N. It is far above what would tear a finger off, and low enough to be simulated.
const STRONGEST_PUSH: f64 = 1000.0;

/// Longest time that a board takes to confirm that it has stopped, ns.
const STOP_CONFIRMATION: u64 = 300_000_000;

/// Time for the last frames of a servo to leave the port.
const FLUSH_TIME: Duration = Duration::from_millis(20);

/// Interval at which the stages of the fingers are polled while the hand opens or ends.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// An open hand: its fingers, servo threads and ports. A process can have several.
///
/// All functions may be called from several threads. Dropping the hand closes it.
#[must_use = "a hand that is dropped is closed"]
pub struct Hand {
    pub(super) dispatcher: Dispatcher,
    pub(super) events: Arc<EventSource>,
    servos: Vec<JoinHandle<PortServo>>,
    pub(super) recovery: Recovery,
    pub(super) simulated: SimulatedHand,
    /// The fingers that were opened.
    opened: Fingers,
    /// The configuration in force. Planners can adjust it, and a calibration puts its results into it.
    pub(super) configuration: RwLock<Configuration>,
    /// The configuration file, in which calibration results are stored.
    pub(super) file: Option<PathBuf>,
    /// Calibration results that are not stored yet.
    pub(super) unstored: Unstored,
    pub(super) real_time: RealtimeState,
    /// Time in which every finger reaches its end state, ns.
    ending: u64,
    /// The process that has the threads. A forked child inherits this value, but not the threads.
    process: u32,
}

impl Hand {
    /// Opens the hand that the configuration file describes, or the simulated hand if there is no file. If fingers are
    /// simulated because no file names their ports, one line reports this to the program's log callback, or on standard
    /// error if there is no callback.
    ///
    /// # Errors
    /// Returns the errors of [`Hand::open`]. Returns an error if the configuration file cannot be read or used.
    pub fn open_configured() -> Result<Self, HandError> {
        Self::open_as(find_configuration()?)
    }

    /// Opens the hand of a configuration, which may come from a file ([`Configured::read`]).
    ///
    /// # Errors
    /// Returns the errors of [`Hand::open`], and an error if the configuration names a hand on another machine.
    pub fn open_as(configured: Configured) -> Result<Self, HandError> {
        Self::open_while(configured, &|| true)
    }

    /// Opens the hand, with the fingers of `hand.fingers`. Shakes hands with its boards, takes up the slack of its
    /// tendons, and returns when every finger holds its pose at its initial stiffness.
    ///
    /// # Errors
    /// Returns an error if the configuration cannot be used, if a port or board does not work, or if a finger faults.
    /// Then everything that was opened is closed again, and every motor is in its end state.
    pub fn open(configuration: Configuration) -> Result<Self, HandError> {
        Self::open_from(configuration, None, Fingers::ALL, Hardware::default(), false, &|| true)
    }

    /// Opens these fingers of the hand with their motors off, so that signs and zeros can be found before a tendon is
    /// pulled. Calibration results are stored in `file`. A finger becomes a spring after [`Hand::zero`] or
    /// [`Hand::identify`].
    ///
    /// # Errors
    /// Returns the errors of [`Hand::open`].
    pub fn open_limp(configuration: Configuration, file: Option<PathBuf>, fingers: Fingers) -> Result<Self, HandError> {
        Self::open_from(configuration, file, fingers, Hardware::default(), true, &|| true)
    }

    pub(super) fn open_from(
        mut configuration: Configuration,
        file: Option<PathBuf>,
        fingers: Fingers,
        mut hardware: Hardware,
        limp: bool,
        goes_on: &dyn Fn() -> bool,
    ) -> Result<Self, HandError> {
        hardware.prepare(&mut configuration, fingers)?;
        check(&configuration)?;
        let opened = fingers.in_hand(&configuration.hand)?;
        find_boards(&mut configuration, opened)?;
        // A sandbox may forbid clock_nanosleep. Then servo threads would not wait, and other threads would panic.
        let waiting = MonotonicClock::check_sleep();
        waiting.map_err(|source| HandError::System { doing: "sleep until a given time (clock_nanosleep)", source })?;
        let (folder, file) = (black_box_folder(&configuration)?, file.map(from_here));
        let simulated = SimulatedHand::start(&configuration, opened)?;
        let tested = configuration.hand.self_test && !limp;
        let connected = reach(&configuration, opened, &simulated, &mut hardware, limp || tested)?;
        let Connected { lines, reached, gate, repairs, events, alarm } = connected;
        check_goes_on(goes_on)?;
        let recovery = Recovery::new(repairs, alarm);
        let dispatcher = Dispatcher::new(reached, configuration.hand.fingers, gate);
        let ending = u64::from(configuration.hand.release_ramp_ms) * 1_000_000 + STOP_CONFIRMATION;
        let configuration = RwLock::new(configuration);
        let servos = Vec::new();
        let real_time = RealtimeState::default();
        let (events, unstored, process) = (Arc::new(events), Unstored::default(), id());
        let mut hand = Self {
            dispatcher,
            events,
            servos,
            recovery,
            simulated,
            opened,
            configuration,
            file,
            unstored,
            real_time,
            ending,
            process,
        };
        // From here on, dropping the hand closes it.
        let collecting = {
            let (configuration, object) = (hand.configuration.read(), hand.simulated.object_view());
            hand.dispatcher.start_collecting(folder, &configuration, &hand.events, object)
        };
        collecting.map_err(|source| HandError::System { doing: "start the thread that collects reports", source })?;
        hand.real_time = start(&hand.configuration.read(), lines, &mut hand.servos)?;
        hand.wait_for_every_finger(goes_on)?;
        if tested {
            hand.test_every_finger()?;
        }
        let reconnecting = hand.recovery.start();
        reconnecting.map_err(|source| HandError::System { doing: "start the thread that reopens ports", source })?;
        Ok(hand)
    }

    /// Returns the fingers that were opened. Calls for all fingers apply to these fingers only.
    pub fn fingers(&self) -> Fingers {
        self.opened
    }

    /// Measured joint angles of finger 1, 2 or 3, rad, from the last cycle. While the servo thread does not run, the
    /// angles stay those of its last cycle, and the skipped periods of [`Hand::status`] grow.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn position(&self, finger: i32) -> Result<[f64; 3], HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.position(finger)
    }

    /// The newest report of finger 1, 2 or 3, whether the finger is faulted or not.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn report(&self, finger: i32) -> Result<FingerReport, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.last_report(finger)
    }

    /// The distribution of the durations of one stage of the cycle (`realtime::CycleStage`), over all cycles of
    /// finger 1, 2 or 3 since open or the last reset.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn timing(&self, finger: i32, stage: realtime::CycleStage) -> Result<Distribution, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.timing(finger, stage)
    }

    /// Counts of the cycles and errors of finger 1, 2 or 3, since open or the last reset.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn losses(&self, finger: i32) -> Result<Losses, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.losses(finger)
    }

    /// Resets timings and losses of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn reset_timing(&self, finger: i32) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.reset_timing(finger)
    }

    /// Pushes the fingertip of a simulated finger with a force in the finger's frame, N, until the next call.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if a component is NaN, infinite or beyond 1000 N, or if the finger
    /// is not simulated.
    pub fn push_simulated(&self, finger: i32, force: [f64; 3]) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?.admission.read().finite("Force", &force)?;
        if !self.configuration.read().fingers[finger.index()].simulated() {
            return Err(HandError::NotSimulated(finger));
        }
        let largest = Vector3::from(force).amax();
        if largest > STRONGEST_PUSH {
            return Err(HandError::TooMuchForce { finger, force: largest, strongest: STRONGEST_PUSH });
        }
        let push = |finger: &mut SimulatedFinger| finger.plant().set_external_force(Vector3::from(force));
        self.simulated.with_finger(finger, push).ok_or(HandError::NotSimulated(finger))
    }

    /// Requests the end state of every finger. Like [`Hand::end`], this function waits for no lock and frees no
    /// memory.
    pub(crate) fn request_end(&self) {
        self.dispatcher.members().iter().for_each(|member| member.mailbox.close());
    }

    /// Requests the end state of every finger, and waits until all fingers have reached it or the time limit is over.
    /// This function waits for no lock and frees no memory, so it can be called when the process is about to end, even
    /// in a signal handler. The hand cannot be used afterwards.
    pub fn end(&self) {
        self.request_end();
        let members = self.dispatcher.members();
        let limit = now() + self.ending;
        while now() < limit && !members.iter().all(|member| member.mailbox.ended() == Some(true)) {
            sleep(POLL_INTERVAL);
        }
        // The servo reports the end shortly before it sends the last frame.
        sleep(FLUSH_TIME);
    }

    /// Brings every finger to its configured end state and ends the threads. Dropping the hand does the same.
    pub fn close(self) {}

    /// Waits until no finger is opening any more: each finger is a spring that holds its pose, or was opened limp. Each
    /// finger applies the open time-out itself.
    fn wait_for_every_finger(&self, goes_on: &dyn Fn() -> bool) -> Result<(), HandError> {
        loop {
            check_goes_on(goes_on)?;
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
            sleep(POLL_INTERVAL);
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        if self.process != id() {
            // This is a forked child. The threads and the motors belong to its parent.
            self.servos.drain(..).for_each(std::mem::forget);
            self.dispatcher.forget_collector();
            self.recovery.forget();
            return;
        }
        self.events.close();
        self.dispatcher.members().iter().for_each(|member| member.mailbox.close());
        for servo in self.servos.drain(..) {
            // A servo thread catches its panics. Its ports are closed here and not in the servo, because closing may
            // take long.
            let _ = servo.join();
        }
        self.recovery.end();
    }
}

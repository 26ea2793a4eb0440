//! The calls of a planner in C and of a planner in Rust.

use crate::EXITED;
use crate::case::{Action, Stage};
use std::ffi::{c_int, c_void};
use std::path::PathBuf;
use std::process::exit;
use std::ptr::null_mut;
use std::sync::RwLock;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::calibration::Task;
use sun2xp::finger;
use sun2xp::groups::{Until, Waiting};
use sun2xp::hand::{Calibrating, CalibrationState, Fingers, Hand, HandError, Recovering, read_configuration, stop_all};

/// Interval at which a planner in Rust polls.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// Longest wait for a finger.
const WAIT: Duration = Duration::from_secs(1);

/// A planner. Its calls may be refused, because the hand is shut down meanwhile.
pub trait Planner: Sync {
    /// Opens a hand, with the motors off if `limp`. A planner in C ignores `limp`. Returns whether the hand is open.
    fn open(&self, limp: bool) -> bool;

    fn stop_all(&self);

    /// The stage of finger 1; none if no hand is open, or if no case begins in this stage.
    fn stage(&self) -> Option<Stage>;

    fn act(&self, action: Action);
}

/// A planner that uses the C calls.
pub struct InC;

/// The first two members of the structs that the C calls fill, and more room than the other members need.
#[repr(C)]
struct Filled {
    size: usize,
    second: c_int,
    room: [u64; 32],
}

impl Filled {
    fn new() -> Self {
        Self { size: size_of::<Self>(), second: 0, room: [0; 32] }
    }
}

type Callback = extern "C" fn(*const c_void, *mut c_void);

#[allow(non_snake_case)]
unsafe extern "C" {
    safe fn OpenHand() -> c_int;
    safe fn CloseHand() -> c_int;
    safe fn sun2xp_default_hand() -> *mut c_void;
    safe fn sun2xp_stop_all() -> c_int;
    safe fn sun2xp_zero(hand: *mut c_void, finger: c_int) -> c_int;
    safe fn sun2xp_recover(hand: *mut c_void, finger: c_int) -> c_int;
    fn sun2xp_status(hand: *mut c_void, finger: c_int, status: *mut Filled) -> c_int;
    fn sun2xp_wait_event(hand: *mut c_void, event: *mut Filled, seconds: f64) -> c_int;
    safe fn sun2xp_wait(hand: *mut c_void, finger: c_int, until: c_int, seconds: f64) -> c_int;
    fn sun2xp_on_event(hand: *mut c_void, callback: Callback, context: *mut c_void) -> c_int;
}

extern "C" fn close_in_callback(_event: *const c_void, _context: *mut c_void) {
    CloseHand();
}

impl Planner for InC {
    fn open(&self, _limp: bool) -> bool {
        OpenHand() == 0
    }

    fn stop_all(&self) {
        assert_eq!(sun2xp_stop_all(), 0);
    }

    fn stage(&self) -> Option<Stage> {
        let mut status = Filled::new();
        // SAFETY: the struct is larger than a sun2xp_status, and begins with its size.
        let filled = unsafe { sun2xp_status(sun2xp_default_hand(), 1, &mut status) };
        // The numbers SUN2XP_STATE_... of the header.
        match status.second {
            _ if filled != 0 => None,
            1 => Some(Stage::Running),
            2 => Some(Stage::Faulted),
            4 => Some(Stage::Calibrating),
            5 => Some(Stage::Recovering),
            _ => None,
        }
    }

    fn act(&self, action: Action) {
        let _ = match action {
            Action::Open => OpenHand(),
            Action::Calibrate => sun2xp_zero(sun2xp_default_hand(), 1),
            Action::Recover => sun2xp_recover(sun2xp_default_hand(), 1),
            Action::Close | Action::End => CloseHand(),
            Action::CloseInCallback => {
                // SAFETY: the callback is a function that accepts every argument.
                unsafe { sun2xp_on_event(sun2xp_default_hand(), close_in_callback, null_mut()) };
                // The stop faults the fingers, and each fault is an event for the callback.
                sun2xp_stop_all()
            }
            Action::Exit => exit(EXITED),
            Action::StopAll => sun2xp_stop_all(),
            Action::WaitForEvent => {
                let mut event = Filled::new();
                // SAFETY: the struct is larger than a sun2xp_event, and begins with its size.
                while unsafe { sun2xp_wait_event(sun2xp_default_hand(), &mut event, -1.0) } == 1 {}
                0
            }
            Action::WaitForFinger => sun2xp_wait(sun2xp_default_hand(), 1, 1, WAIT.as_secs_f64()),
        };
    }
}

/// A planner in Rust. It holds the lock for writing only to insert or remove a hand.
#[derive(Default)]
pub struct InRust(RwLock<Option<Hand>>);

impl InRust {
    /// Calls a function with the hand. Returns none if there is no hand, or if the hand refuses the call.
    fn with<T>(&self, call: impl FnOnce(&Hand) -> Result<T, HandError>) -> Option<T> {
        call(self.0.read().expect("not poisoned").as_ref()?).ok()
    }

    /// Calls a function with the hand until the function returns true or an error, or no hand is open.
    fn poll(&self, mut done: impl FnMut(&Hand) -> Result<bool, HandError>) {
        while self.with(&mut done) == Some(false) {
            sleep(POLL_INTERVAL);
        }
    }
}

impl Planner for InRust {
    fn open(&self, limp: bool) -> bool {
        let file = std::env::var_os("SUN2XP_CONFIG").map(PathBuf::from).expect("a configuration file");
        let configuration = read_configuration(&file).expect("a usable file");
        let hand = if limp { Hand::open_limp(configuration, None, Fingers::ALL) } else { Hand::open(configuration) };
        *self.0.write().expect("not poisoned") = Some(hand.unwrap_or_else(|error| panic!("open: {error}")));
        true
    }

    fn stop_all(&self) {
        stop_all();
    }

    fn stage(&self) -> Option<Stage> {
        match self.with(|hand| hand.report(1))?.stage {
            finger::Stage::Running => Some(Stage::Running),
            finger::Stage::Limp => Some(Stage::Limp),
            finger::Stage::Faulted(_) => Some(Stage::Faulted),
            finger::Stage::Calibrating => Some(Stage::Calibrating),
            finger::Stage::Opening => Some(Stage::Recovering),
            _ => None,
        }
    }

    fn act(&self, action: Action) {
        match action {
            Action::Open => assert!(self.open(false)),
            Action::Calibrate => {
                if let Some(mut calibrating) = self.with(|hand| Calibrating::begin(hand, 1, Task::Zero)) {
                    self.poll(|hand| Ok(matches!(calibrating.poll(hand)?, CalibrationState::Done(_))));
                }
            }
            Action::Recover => {
                let Some(recovering) = self.with(|hand| Recovering::begin(hand, 1)) else { return };
                if recovering.reconnect().is_ok() {
                    self.poll(|hand| recovering.poll(hand));
                }
            }
            Action::Close | Action::CloseInCallback => {
                let hand = self.0.write().expect("not poisoned").take();
                drop(hand);
            }
            Action::End => {
                self.with(|hand| {
                    hand.end();
                    Ok(())
                });
            }
            Action::Exit => exit(EXITED),
            Action::StopAll => stop_all(),
            Action::WaitForEvent => {
                let queue = self.with(|hand| Ok(hand.events()));
                while queue.as_ref().is_some_and(|queue| queue.wait(None).is_some()) {}
            }
            Action::WaitForFinger => {
                let waiting = self.with(|hand| Waiting::begin(hand, &[1], Until::Arrived, WAIT));
                if let Some(waiting) = waiting {
                    self.poll(|hand| waiting.poll(hand));
                }
            }
        }
    }
}

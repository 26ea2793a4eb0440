//! Simulated boards, each at a serial port of its own. The fingers of all boards touch the same object.
//!
//! One thread advances all of these boards and the object together, step by step. Separate threads of the boards would
//! wait for each other at every step. To its host, each port looks like the port of a
//! [`SimulatedPort`](crate::simulated::SimulatedPort).

use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, FINGERS};
use crate::realtime::{self, Input, Mutex, Output, Priority, spawn, triple_buffer};
use crate::simulated::board::{STEP, SimulatedBoard, SimulatedBoardError};
use crate::simulated::finger::SimulatedFinger;
use crate::simulated::pseudo_terminal::{Closed, PseudoTerminal};
use crate::simulated::scene::{ObjectState, Scene};
use crate::simulated::shared_time::SharedTime;
use nalgebra::Vector3;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep};
use std::time::Duration;
use thiserror::Error;

/// Interval at which the physics advances while no bytes arrive.
const TICK: Duration = Duration::from_millis(1);

/// Interval at which the physics advances while the bytes of a host cannot be taken yet ([`SharedTime::takes`]).
const SHORT_TICK: Duration = Duration::from_micros(100);

/// A port is prepared for a new host when its host has sent nothing for longer than this time, ns.
const SILENCE: u64 = 100_000_000;

/// Why coupled boards cannot start.
#[derive(Debug, Error)]
pub enum CoupledPortsError {
    /// A board cannot be built.
    #[error("finger {finger}: {source}")]
    Board {
        /// The finger.
        finger: FingerNumber,
        /// The reason.
        source: SimulatedBoardError,
    },
    /// The system cannot open a pseudo-terminal or start the thread.
    #[error(transparent)]
    System(#[from] io::Error),
}

/// Simulated boards with one finger each, an object, and the thread that runs them. Dropping this value ends the thread
/// and removes the ports.
pub struct CoupledPorts {
    shared: Arc<Mutex<Shared>>,
    object: ObjectView,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// The process in which the thread runs. A forked child inherits this value, but not the thread.
    process: u32,
}

/// The newest state of the object. A thread that reads it does not make the boards' thread wait.
#[derive(Clone)]
pub struct ObjectView(Arc<Mutex<Output<ObjectState>>>);

impl ObjectView {
    /// Returns the state of the object, at most some milliseconds old.
    pub fn state(&self) -> ObjectState {
        *self.0.lock().read()
    }
}

/// The data that the boards' thread and its owner share.
struct Shared {
    boards: [Option<SimulatedBoard>; FINGERS],
    scene: Scene,
    /// `None` for a finger that does not exist, and after another part of the program has closed the descriptors of
    /// the terminal.
    terminals: [Option<Arc<PseudoTerminal>>; FINGERS],
    /// The boards' clock, ns.
    time: u64,
}

impl CoupledPorts {
    /// Starts boards for these fingers around `scene`. The thread requests `priority`, and runs without it if the
    /// system refuses the request.
    pub fn start(
        hand: &Configuration,
        fingers: impl Iterator<Item = FingerNumber>,
        scene: Scene,
        priority: Priority,
    ) -> Result<Self, CoupledPortsError> {
        let (mut boards, mut terminals) = ([const { None }; FINGERS], [const { None }; FINGERS]);
        for finger in fingers {
            let mut board = SimulatedBoard::without_object(hand, &[finger])
                .map_err(|source| CoupledPortsError::Board { finger, source })?;
            board.advance(0);
            boards[finger.index()] = Some(board);
            terminals[finger.index()] = Some(Arc::new(PseudoTerminal::open()?));
        }
        let (published, object) = triple_buffer(&scene.state());
        let shared = Arc::new(Mutex::new(Shared { boards, scene, terminals, time: 0 }));
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let (shared, ended, rate) = (shared.clone(), ended.clone(), hand.hand.rate);
            // A refused priority is ignored, because a simulation does not need real-time priority.
            spawn("sun2xp board", priority, move |_| run(&shared, rate, published, &ended))?
        };
        let object = ObjectView(Arc::new(Mutex::new(object)));
        Ok(Self { shared, object, ended, thread: Some(thread), process: std::process::id() })
    }

    /// Returns the path of a finger's port, or `None` if the finger has no port.
    pub fn path(&self, finger: FingerNumber) -> Option<PathBuf> {
        self.shared.lock().terminals[finger.index()].as_ref().map(|terminal| terminal.path().to_owned())
    }

    /// Calls `look` with one finger. Returns `None` if this finger has no board here. The boards' thread waits
    /// meanwhile, so `look` must be short.
    pub fn with_finger<R>(&self, finger: FingerNumber, look: impl FnOnce(&mut SimulatedFinger) -> R) -> Option<R> {
        self.shared.lock().boards[finger.index()].as_mut()?.fingers().first_mut().map(look)
    }

    /// Sets the gravity that acts on the object, m/s^2 in the palm's frame.
    pub fn set_object_gravity(&self, gravity: Vector3<f64>) {
        self.shared.lock().scene.object().set_gravity(gravity);
    }

    /// Returns the view of the object's state.
    pub fn object(&self) -> &ObjectView {
        &self.object
    }
}

impl Drop for CoupledPorts {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let thread = self.thread.take().filter(|_| self.process == std::process::id());
        if let Some(thread) = thread {
            // If the boards' thread panicked, it has already ended.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// Advances the physics to `now`, ns.
    fn advance(&mut self, now: u64) {
        while self.time + STEP <= now {
            self.time += STEP;
            self.scene.step(self.boards.iter_mut().flatten().flat_map(|board| board.fingers()));
            self.boards.iter_mut().flatten().for_each(|board| board.step(self.time));
        }
    }

    /// Passes the bytes that have arrived for a finger to its board. Returns whether there were any.
    fn receive(&mut self, finger: usize, now: u64) -> bool {
        let mut input = [0; 512];
        let (Some(terminal), Some(board)) = (&self.terminals[finger], &mut self.boards[finger]) else { return false };
        match terminal.read(&mut input, Duration::ZERO) {
            Ok(taken) => {
                board.receive(now, &input[..taken], &mut |answer| terminal.write(answer));
                taken > 0
            }
            Err(Closed) => {
                self.terminals[finger] = None;
                false
            }
        }
    }

    fn under_control(&mut self, finger: usize) -> bool {
        self.boards[finger].as_mut().is_some_and(|board| board.fingers().iter().any(SimulatedFinger::enabled))
    }
}

fn run(shared: &Mutex<Shared>, rate: f64, mut published: Input<ObjectState>, ended: &AtomicBool) {
    let mut time = SharedTime::new(rate, realtime::now());
    let mut host_forgotten = [false; FINGERS];
    while !ended.load(Ordering::Relaxed) {
        let taken_from: [bool; FINGERS] = std::array::from_fn(|finger| time.takes(finger));
        let mut terminals = shared.lock().terminals.clone();
        for (terminal, takes) in terminals.iter_mut().zip(taken_from) {
            terminal.take_if(|_| !takes);
        }
        let all_taken = taken_from.iter().all(|&takes| takes);
        let ready = PseudoTerminal::wait_for_any(&terminals, if all_taken { TICK } else { SHORT_TICK });
        let now = time.wake(realtime::now());

        let mut shared = shared.lock();
        shared.advance(now);
        let mut idle = true;
        for finger in 0..FINGERS {
            let received = taken_from[finger] && shared.receive(finger, now);
            idle &= !received;
            let controls = shared.under_control(finger);
            match received {
                true => time.received(finger, controls),
                false => time.set_control(finger, controls),
            }
            host_forgotten[finger] &= !received;
            if !host_forgotten[finger] && time.silence(finger) > SILENCE {
                host_forgotten[finger] = true;
                shared.terminals[finger].iter().for_each(|terminal| terminal.forget_last_host());
            }
        }
        published.write(shared.scene.state());
        drop(shared);
        if ready && idle {
            // A terminal that is ready but has no bytes must not occupy a core.
            sleep(TICK);
        }
    }
}

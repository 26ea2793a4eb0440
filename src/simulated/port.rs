//! A simulated board at a serial port: a pseudo-terminal and a thread.
//!
//! Each wake-up of the board's thread advances the time of the simulated board by at most 2 ms, so this time stops
//! while the machine does not run the thread. Otherwise a pause of a virtual machine for 50 ms, which also stops the
//! host's servo, would trip the watchdog of the simulated board, and the finger would move for 50 ms without its
//! controller. A simulated hand must not stop for this reason.

use crate::realtime::{self, Mutex, Priority, spawn};
use crate::simulated::board::SimulatedBoard;
use crate::simulated::finger::SimulatedFinger;
use crate::simulated::line::{LineFault, SimulatedLine};
use crate::simulated::pace::{Pace, PacedTime};
use crate::simulated::pseudo_terminal::{Closed, PseudoTerminal};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

/// Interval at which the physics advances while no bytes arrive.
const TICK: Duration = Duration::from_millis(1);

/// The port is prepared for a new host when the host has sent nothing for longer than this time, ns. If that host still
/// runs, the port loses the host's mark of exclusive use (TIOCEXCL). The host's lock (flock) stays.
const SILENCE: u64 = 100_000_000;

/// A simulated board with its own port and a thread that runs the board. Dropping this value ends the thread and
/// removes the port.
#[derive(Debug)]
pub struct SimulatedPort {
    shared: Arc<Mutex<Shared>>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// The process in which the thread runs. A forked child inherits this value, but not the thread.
    process: u32,
}

/// The data that the board's thread and its owner share.
#[derive(Debug)]
struct Shared {
    board: SimulatedBoard,
    /// The direction from the board to the host.
    line: SimulatedLine,
    /// The direction from the host to the board.
    line_to_board: SimulatedLine,
    /// `None` while the cable is unplugged, and after another part of the program has closed the terminal's
    /// descriptors.
    terminal: Option<Arc<PseudoTerminal>>,
    /// The board's clock, ns.
    time: u64,
}

impl SimulatedPort {
    /// Starts the board. Its thread requests `priority`, and runs without it if the system refuses the request.
    pub fn start(board: SimulatedBoard, pace: Pace, priority: Priority) -> io::Result<Self> {
        let terminal = Some(Arc::new(PseudoTerminal::open()?));
        let [line, line_to_board] = [(); 2].map(|()| SimulatedLine::new());
        let shared = Arc::new(Mutex::new(Shared { board, line, line_to_board, terminal, time: 0 }));
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let (shared, ended) = (shared.clone(), ended.clone());
            // A refused priority is ignored, because a simulation does not need real-time priority.
            spawn("sun2xp board", priority, move |_| run(&shared, pace, &ended))?
        };
        Ok(Self { shared, ended, thread: Some(thread), process: std::process::id() })
    }

    /// Returns the path of the port, or an empty path while the cable is unplugged. The path changes when the cable is
    /// plugged in again.
    pub fn path(&self) -> PathBuf {
        self.shared.lock().terminal.as_deref().map(PseudoTerminal::path).map(Path::to_owned).unwrap_or_default()
    }

    /// Unplugs the cable. The host loses the port, and bytes in transit are lost. The board continues to run.
    pub fn unplug(&self) {
        let mut shared = self.shared.lock();
        shared.terminal = None;
        shared.line.cut();
        shared.line_to_board.cut();
    }

    /// Plugs the cable in again, at a new port, see [`SimulatedPort::path`]. Does nothing if it is plugged in.
    pub fn plug_in(&self) -> io::Result<()> {
        let terminal = PseudoTerminal::open()?;
        self.shared.lock().terminal.get_or_insert(Arc::new(terminal));
        Ok(())
    }

    /// Applies `fault` to each frame from the board with this probability. The fault lasts for `time`, ns. A stall
    /// ignores the probability. `seed` restarts the random numbers.
    pub fn inject(&self, fault: LineFault, probability: f64, time: u64, seed: u64) {
        let mut shared = self.shared.lock();
        let until = shared.time.saturating_add(time);
        shared.line.inject(fault, probability, until, seed);
    }

    /// Applies `fault` to each frame on its way to the board. The parameters are those of [`SimulatedPort::inject`].
    pub fn inject_to_board(&self, fault: LineFault, probability: f64, time: u64, seed: u64) {
        let mut shared = self.shared.lock();
        let until = shared.time.saturating_add(time);
        shared.line_to_board.inject(fault, probability, until, seed);
    }

    /// Removes all faults of the line in both directions.
    pub fn clear(&self) {
        let mut shared = self.shared.lock();
        shared.line.clear();
        shared.line_to_board.clear();
    }

    /// Calls `look` with the board. The board's thread waits meanwhile, so `look` must be short.
    pub fn with_board<R>(&self, look: impl FnOnce(&mut SimulatedBoard) -> R) -> R {
        look(&mut self.shared.lock().board)
    }

    /// Calls `look` with one finger. Returns `None` if the board has no such address.
    pub fn with_finger<R>(&self, address: u8, look: impl FnOnce(&mut SimulatedFinger) -> R) -> Option<R> {
        self.with_board(|board| board.finger(address).map(look))
    }
}

impl Drop for SimulatedPort {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let thread = self.thread.take().filter(|_| self.process == std::process::id());
        if let Some(thread) = thread {
            // If the board's thread panicked, it has already ended.
            let _ = thread.join();
        }
    }
}

fn run(shared: &Mutex<Shared>, pace: Pace, ended: &AtomicBool) {
    let mut input = [0; 512];
    let mut clock = PacedTime::new(pace, realtime::now());
    let mut host_forgotten = false;
    while !ended.load(Ordering::Relaxed) {
        let terminal = shared.lock().terminal.clone();
        let received = match &terminal {
            Some(terminal) => terminal.read(&mut input, TICK),
            None => {
                sleep(TICK);
                Ok(0)
            }
        };
        let taken = received.unwrap_or(0);
        let board_time = clock.wake(realtime::now(), taken > 0);

        let mut shared = shared.lock();
        let Shared { board, line, line_to_board, terminal: current, time } = &mut *shared;
        *time = board_time;
        if taken > 0 {
            host_forgotten = false;
        }
        let Some(terminal) = terminal else {
            board.advance(board_time);
            continue;
        };
        if received == Err(Closed) {
            current.take_if(|current| Arc::ptr_eq(current, &terminal));
            continue;
        }
        let mut send = |frame: &[u8]| terminal.write(frame);
        line.arrive(board_time, &mut send);
        board.advance(board_time);
        let mut receive = |bytes: &[u8]| {
            board.receive(board_time, bytes, &mut |answer| line.carry(board_time, answer, &mut send));
        };
        line_to_board.arrive(board_time, &mut receive);
        if taken > 0 {
            line_to_board.carry_bytes(board_time, &input[..taken], &mut receive);
        }
        drop(shared);

        if !host_forgotten && clock.silence() > SILENCE {
            host_forgotten = true;
            terminal.forget_last_host();
        }
    }
}

//! A simulated board behind a real serial port, as far as its user can tell: a pseudo-terminal and a thread.
//!
//! The time of the simulated board does not pass while the machine does not let its thread run: each wake-up counts as
//! 2 ms at most. Otherwise a virtual machine that is paused for 50 ms, which stops the host's servo just the same,
//! would trip a watchdog that no real board would trip, and the finger would fall on for 50 ms without its controller.

use crate::realtime::{self, Priority, spawn};
use crate::simulated::board::SimulatedBoard;
use crate::simulated::finger::SimulatedFinger;
use crate::simulated::line::{LineFault, SimulatedLine};
use crate::simulated::pace::{Pace, PacedTime};
use crate::simulated::pseudo_terminal::{Closed, PseudoTerminal};
use parking_lot::Mutex;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{JoinHandle, sleep};
use std::time::Duration;

/// How often the physics moves on while no bytes come.
const TICK: Duration = Duration::from_millis(1);

/// After such a silence nobody is taken to be at the other end, ns. A host that is there all the same loses its mark of
/// exclusive use, but not its lock.
const SILENCE: u64 = 100_000_000;

/// A simulated board with a port of its own and a thread that runs it. Dropping it ends both.
#[derive(Debug)]
pub struct SimulatedPort {
    shared: Arc<Mutex<Shared>>,
    ended: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// The process that has the thread. A forked child inherits this value, but not the thread.
    process: u32,
}

/// What the board's thread and its owner both use.
#[derive(Debug)]
struct Shared {
    board: SimulatedBoard,
    /// From the board to the host.
    line: SimulatedLine,
    /// From the host to the board.
    line_to_board: SimulatedLine,
    /// None while the cable is out, and after another part of the program has closed its descriptors.
    terminal: Option<Arc<PseudoTerminal>>,
    /// The board's clock, ns.
    time: u64,
}

impl SimulatedPort {
    /// Starts the board. Its thread asks for this priority, and goes on without where that is not permitted.
    pub fn start(board: SimulatedBoard, pace: Pace, priority: Priority) -> io::Result<Self> {
        let terminal = Some(Arc::new(PseudoTerminal::open()?));
        let [line, line_to_board] = [(); 2].map(|()| SimulatedLine::new());
        let shared = Arc::new(Mutex::new(Shared { board, line, line_to_board, terminal, time: 0 }));
        let ended = Arc::new(AtomicBool::new(false));
        let thread = {
            let (shared, ended) = (shared.clone(), ended.clone());
            // Not real-time is good enough for a simulation.
            spawn("sun2xp board", priority, move |_| run(&shared, pace, &ended))?
        };
        Ok(Self { shared, ended, thread: Some(thread), process: std::process::id() })
    }

    /// The port to open; empty while the cable is out. Another one after it was out.
    pub fn path(&self) -> PathBuf {
        self.shared.lock().terminal.as_deref().map(PseudoTerminal::path).map(Path::to_owned).unwrap_or_default()
    }

    /// Pulls the cable out: for the host the port vanishes, and what was on its way is lost. The board goes on.
    pub fn unplug(&self) {
        let mut shared = self.shared.lock();
        shared.terminal = None;
        shared.line.cut();
        shared.line_to_board.cut();
    }

    /// Puts the cable in again: a new port, for which see [`SimulatedPort::path`].
    pub fn plug_in(&self) -> io::Result<()> {
        let terminal = PseudoTerminal::open()?;
        self.shared.lock().terminal.get_or_insert(Arc::new(terminal));
        Ok(())
    }

    /// The line becomes bad: this happens to each frame from the board with this probability, for so long, ns. A stall
    /// always happens. Chance begins anew with this seed.
    pub fn inject(&self, fault: LineFault, probability: f64, time: u64, seed: u64) {
        let mut shared = self.shared.lock();
        let until = shared.time.saturating_add(time);
        shared.line.inject(fault, probability, until, seed);
    }

    /// The same with frames to the board.
    pub fn inject_to_board(&self, fault: LineFault, probability: f64, time: u64, seed: u64) {
        let mut shared = self.shared.lock();
        let until = shared.time.saturating_add(time);
        shared.line_to_board.inject(fault, probability, until, seed);
    }

    /// The line is good again, both ways.
    pub fn clear(&self) {
        let mut shared = self.shared.lock();
        shared.line.clear();
        shared.line_to_board.clear();
    }

    /// Looks at the board or changes it. The board stands still meanwhile, so be brief.
    pub fn with_board<R>(&self, look: impl FnOnce(&mut SimulatedBoard) -> R) -> R {
        look(&mut self.shared.lock().board)
    }

    /// The same with one finger; none where the board has no such address.
    pub fn with_finger<R>(&self, address: u8, look: impl FnOnce(&mut SimulatedFinger) -> R) -> Option<R> {
        self.with_board(|board| board.finger(address).map(look))
    }
}

impl Drop for SimulatedPort {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let thread = self.thread.take().filter(|_| self.process == std::process::id());
        if let Some(thread) = thread {
            // A panic in the board's thread ended it; there is nothing left to end.
            let _ = thread.join();
        }
    }
}

fn run(shared: &Mutex<Shared>, pace: Pace, ended: &AtomicBool) {
    let mut input = [0; 512];
    let mut clock = PacedTime::new(pace, realtime::now());
    let mut forgotten = false;
    while !ended.load(Ordering::Relaxed) {
        let terminal = shared.lock().terminal.clone();
        let heard = match &terminal {
            Some(terminal) => terminal.read(&mut input, TICK),
            None => {
                sleep(TICK);
                Ok(0)
            }
        };
        let taken = heard.unwrap_or(0);
        let board_time = clock.wake(realtime::now(), taken > 0);

        let mut shared = shared.lock();
        let Shared { board, line, line_to_board, terminal: current, time } = &mut *shared;
        *time = board_time;
        if taken > 0 {
            forgotten = false;
        }
        let Some(terminal) = terminal else {
            board.advance(board_time);
            continue;
        };
        if heard == Err(Closed) {
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

        if !forgotten && clock.silence() > SILENCE {
            forgotten = true;
            terminal.forget_last_host();
        }
    }
}

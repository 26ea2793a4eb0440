//! How the time of a simulated board passes beside that of the wall. No clock and no thread: both are told.

/// The most that one wake-up of the board's thread counts, ns.
const LONGEST_STEP: u64 = 2_000_000;

/// For so long, ns, a [`Pace::Patient`] board takes silence for a pause of the machine. Cycles of a host that is not
/// real-time can be some 10 ms apart on a busy machine, and an answer that was thrown away is missed for a hundred of
/// them.
const PATIENCE: u64 = 2_000_000_000;

/// How the time of a simulated board passes.
///
/// Either way it does not pass while the machine does not let the board's thread run: a wake-up counts 2 ms at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// As on the wall: a host that falls silent meets the watchdog in time.
    RealTime,
    /// It also stands still, for up to two seconds, while commands stay away. Bytes in a pseudo-terminal are carried by
    /// an ordinary kernel thread, which a busy machine keeps waiting for tens of ms, and so it does a servo: no reason
    /// to stop a simulated hand.
    Patient {
        /// How far the board goes on after the last bytes, ns. No longer than a finger can do without its controller:
        /// with 10 ms of an old torque, again and again, joints turned by radians, and with 1.5 ms at 1000 Hz they
        /// shook.
        ahead: u64,
    },
}

impl Pace {
    /// Patient with a host of so many cycles a second: a command is for one period.
    pub fn patient(rate: f64) -> Self {
        Self::Patient { ahead: (1e9 / rate) as u64 }
    }
}

/// The time of a simulated board, ns.
#[derive(Clone, Copy, Debug)]
pub struct PacedTime {
    pace: Pace,
    board: u64,
    /// The last wake-up, on the wall.
    woken: u64,
    /// The last bytes, on the board's clock.
    heard: u64,
    silence: u64,
}

impl PacedTime {
    /// At 0 when it is `now` on the wall, ns.
    pub fn new(pace: Pace, now: u64) -> Self {
        Self { pace, board: 0, woken: now, heard: 0, silence: 0 }
    }

    /// The board's thread wakes up at `now` on the wall, ns, and finds that bytes have come, or none: the time on the
    /// board, ns.
    pub fn wake(&mut self, now: u64, bytes: bool) -> u64 {
        let passed = (now - self.woken).min(LONGEST_STEP);
        self.woken = now;
        self.silence += passed;
        let next = self.board + passed;
        self.board = match self.pace {
            Pace::Patient { ahead } if self.silence < PATIENCE => next.min(self.board.max(self.heard + ahead)),
            Pace::Patient { .. } | Pace::RealTime => next,
        };
        if bytes {
            (self.heard, self.silence) = (self.board, 0);
        }
        self.board
    }

    /// For how long nothing has come, ns; as the board's thread sees it, which the machine may not let run.
    pub fn silence(&self) -> u64 {
        self.silence
    }
}

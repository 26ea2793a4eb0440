//! Relates the time of a simulated board to real time. This module has no clock and no thread; the caller passes the
//! real time.

/// The longest time by which one wake-up of the board's thread advances the board's time, ns.
pub(super) const LONGEST_STEP: u64 = 2_000_000;

/// The longest silence that a [`Pace::Patient`] board attributes to a pause of the machine, ns. A host at 1000 Hz sends
/// a command again if the answer has not arrived after a hundred cycles. On a busy machine, the cycles of a host that
/// is not real-time can be some 10 ms apart. The hundred cycles then take about 1 s.
pub(super) const PATIENCE: u64 = 2_000_000_000;

/// The rate at which the time of a simulated board passes.
///
/// With both variants, the board's time stops while the machine does not run the board's thread, because a wake-up
/// advances it by at most 2 ms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// The rate of real time. The watchdog trips in time when the host falls silent.
    RealTime,
    /// The board's time also stops, for up to two seconds, while no commands arrive. An ordinary kernel thread carries
    /// the bytes of a pseudo-terminal. A busy machine can delay that thread, and a servo, by tens of ms. Such a delay
    /// must not stop a simulated hand.
    Patient {
        /// How far the board's time continues after the last bytes, ns. It must not exceed the time for which a finger
        /// can do without its controller. When an old torque acted for 10 ms again and again, joints turned by radians.
        /// When it acted for 1.5 ms at 1000 Hz, they shook.
        grace: u64,
    },
}

impl Pace {
    /// Creates a patient pace for a host with `rate` cycles per second. A command is valid for one period, so the grace
    /// is one period.
    pub fn patient(rate: f64) -> Self {
        Self::Patient { grace: (1e9 / rate) as u64 }
    }
}

/// The time of a simulated board, ns.
#[derive(Clone, Copy, Debug)]
pub struct PacedTime {
    pace: Pace,
    /// Time of the board's clock.
    board: u64,
    /// Real time of the last wake-up.
    woken: u64,
    /// When the last bytes arrived, by the board's clock.
    received_at: u64,
    silence: u64,
}

impl PacedTime {
    /// Creates a board's time that is 0 when the real time is `now`, ns.
    pub fn new(pace: Pace, now: u64) -> Self {
        Self { pace, board: 0, woken: now, received_at: 0, silence: 0 }
    }

    /// Advances the time at a wake-up of the board's thread. `now` is the real time, ns, and `bytes` says whether bytes
    /// have arrived. Returns the board's time, ns.
    pub fn wake(&mut self, now: u64, bytes: bool) -> u64 {
        let passed = (now - self.woken).min(LONGEST_STEP);
        self.woken = now;
        self.silence += passed;
        let next = self.board + passed;
        self.board = match self.pace {
            Pace::Patient { grace } if self.silence < PATIENCE => next.min(self.board.max(self.received_at + grace)),
            Pace::Patient { .. } | Pace::RealTime => next,
        };
        if bytes {
            (self.received_at, self.silence) = (self.board, 0);
        }
        self.board
    }

    /// Returns how long no bytes have arrived, ns, without the time in which the board's thread did not run.
    pub fn silence(&self) -> u64 {
        self.silence
    }
}

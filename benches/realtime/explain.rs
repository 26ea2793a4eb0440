//! Late cycles and what made them late: a clock that notes what it is asked, and watchers that note when their core stood still.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::JoinHandle;
use sun2xp::finger::REPLY_WINDOW;
use sun2xp::realtime::{Clock, MonotonicClock, Priority, Schedule, now, spawn};

/// How many late cycles, and how many pauses of a core, are kept.
const KEPT: usize = 100_000;

/// A cycle that was not done when the next one should have begun. ns.
#[derive(Clone, Copy)]
pub struct LateCycle {
    /// Its scheduled beginning.
    pub beginning: u64,
    /// Its first instruction.
    pub woken: u64,
    /// When replies, or the time for them, had come, and it began to compute.
    pub computing: u64,
    /// When it was done.
    pub done: u64,
}

/// What a servo is asked of its clock in one cycle: to sleep until the beginning; the time when it has woken; and last the times when it
/// begins to compute and when it has. So the clock knows of every late cycle, and the library that is measured is the one that is used.
pub struct NotingClock {
    period: u64,
    beginning: Cell<u64>,
    woken: Cell<Option<u64>>,
    /// The last two times that were asked for.
    last: Cell<(u64, u64)>,
    late: Cell<Vec<LateCycle>>,
    cycles: Cell<u64>,
}

impl NotingClock {
    pub fn new(period: u64) -> Self {
        Self {
            period,
            beginning: Cell::new(0),
            woken: Cell::new(None),
            last: Cell::new((0, 0)),
            late: Cell::new(Vec::with_capacity(KEPT)),
            cycles: Cell::new(0),
        }
    }

    /// How many cycles there were, and the late ones.
    pub fn finish(self) -> (u64, Vec<LateCycle>) {
        self.end_cycle();
        (self.cycles.get(), self.late.take())
    }

    fn end_cycle(&self) {
        let Some(woken) = self.woken.take() else { return };
        self.cycles.set(self.cycles.get() + 1);
        let (beginning, (computing, done)) = (self.beginning.get(), self.last.get());
        if done > beginning + self.period {
            let mut late = self.late.take();
            if late.len() < KEPT {
                late.push(LateCycle { beginning, woken, computing, done });
            }
            self.late.set(late);
        }
    }
}

impl Clock for &NotingClock {
    fn now(&self) -> u64 {
        let time = now();
        if self.woken.get().is_none() {
            self.woken.set(Some(time));
        }
        self.last.set((self.last.get().1, time));
        time
    }

    fn sleep_until(&self, deadline: u64) {
        self.end_cycle();
        self.beginning.set(deadline);
        MonotonicClock.sleep_until(deadline);
    }
}

/// A time in which a core did not run a thread that was due, above all servos: from, to, ns.
pub type Pause = (u64, u64);

/// One thread a core that does nothing but wake up, as cyclictest's do, and notes when it was late.
pub struct Watchers {
    ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<Vec<Pause>>>,
}

/// A watcher looks so often, ns.
const LOOKING: u64 = 250_000;

/// Later than this, ns, counts as a pause.
const PAUSE: u64 = 50_000;

impl Watchers {
    pub fn start(priority: u8) -> std::io::Result<Self> {
        let ended = Arc::new(AtomicBool::new(false));
        let cores = std::thread::available_parallelism()?.get();
        let watch = |core| {
            let ended = ended.clone();
            spawn("watcher", Priority { fifo: priority, core: Some(core) }, move |_| watch(&ended))
        };
        let threads = (0..cores).map(watch).collect::<Result<_, _>>()?;
        Ok(Self { ended, threads })
    }

    pub fn finish(self) -> Pauses {
        self.ended.store(true, Relaxed);
        Pauses(self.threads.into_iter().map(|thread| thread.join().unwrap_or_default()).collect())
    }
}

fn watch(ended: &AtomicBool) -> Vec<Pause> {
    let mut pauses = Vec::with_capacity(KEPT);
    let mut schedule = Schedule::new(now() + LOOKING, LOOKING);
    while !ended.load(Relaxed) {
        let due = schedule.next();
        MonotonicClock.sleep_until(due);
        let woken = MonotonicClock.now();
        if woken > due + PAUSE && pauses.len() < KEPT {
            pauses.push((due, woken));
        }
        schedule.advance(woken);
    }
    pauses
}

/// The pauses of every core.
pub struct Pauses(Vec<Vec<Pause>>);

impl Pauses {
    pub fn count(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }

    /// Whether they explain why a cycle was late. On any core: a servo may have been on any.
    fn explain(&self, cycle: &LateCycle, period: u64) -> bool {
        let excess = cycle.done - (cycle.beginning + period);
        let overlap = |&(from, to): &Pause| to.min(cycle.done).saturating_sub(from.max(cycle.beginning));
        // A watcher looks from time to time: a pause that begins between two looks is seen shorter than it is.
        let seen = |overlap: u64| if overlap > 0 { overlap + LOOKING } else { 0 };
        self.0.iter().any(|core| core.iter().map(overlap).map(seen).sum::<u64>() >= excess)
    }
}

/// What made a cycle late.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Cause {
    /// Its own wake-up: without that it would have been in time.
    WakeUp,
    /// A core stood still meanwhile to a thread above all servos, for as long as the cycle was late.
    Pause,
    /// It was late when it had done with sending and receiving, and no watcher has met a pause. Most often a poll returned long after
    /// its deadline, on a core that a watcher did not look at meanwhile or behind a worker of the kernel that holds the terminal; but
    /// this does not prove it: the library's own sending, reading and decoding lie in the same time.
    Exchange,
    /// None of these: the library itself, in its computation.
    Library,
}

/// A computation that took no longer than this part of a period has not made the cycle late.
const COMPUTING: f64 = 0.1;

/// `pauses`: of threads above all servos.
pub fn cause(cycle: &LateCycle, period: u64, pauses: &Pauses) -> Cause {
    let &LateCycle { woken, computing, done, .. } = cycle;
    let waited_for = (computing - woken) as f64 > REPLY_WINDOW * period as f64;
    let computed_briefly = (done - computing) as f64 <= COMPUTING * period as f64;
    match () {
        _ if done - woken <= period => Cause::WakeUp,
        _ if pauses.explain(cycle, period) => Cause::Pause,
        _ if waited_for && computed_briefly => Cause::Exchange,
        _ => Cause::Library,
    }
}

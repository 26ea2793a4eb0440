//! Late cycles and what made them late: a clock that notes what it is asked, and watchers that note when their core
//! stood still.

use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::JoinHandle;
use sun2xp::finger::REPLY_WINDOW;
use sun2xp::realtime::{Clock, MonotonicClock, Priority, Schedule, now, spawn};

/// How many late cycles, and how many pauses of a core, are kept: of a busy machine for half an hour.
const KEPT: usize = 4_000_000;

/// A cycle that was not done when the next one should have begun. ns.
#[derive(Clone, Copy)]
pub struct LateCycle {
    /// Its scheduled beginning.
    pub beginning: u64,
    /// Its first instruction.
    pub woken: u64,
    /// When it was done.
    pub done: u64,
    /// For how long its thread ran meanwhile, by the kernel's account: with its system calls, without waiting.
    pub ran: u64,
    /// For how much of that it computed, which is without system calls.
    pub computed: u64,
}

/// What a servo asks of its clock in one cycle: to sleep until the beginning; the time when it has woken; and last the
/// times when it begins to compute and when it has. So the clock knows of every late cycle, and the library that is
/// measured is the one that is used.
pub struct NotingClock {
    period: u64,
    beginning: Cell<u64>,
    woken: Cell<Option<Instant>>,
    /// The last two that were asked for.
    last: Cell<[Instant; 2]>,
    late: Cell<Vec<LateCycle>>,
    cycles: Cell<u64>,
}

impl NotingClock {
    pub fn new(period: u64) -> Self {
        Self {
            period,
            beginning: Cell::new(0),
            woken: Cell::new(None),
            last: Cell::default(),
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
        let (beginning, [computing, done]) = (self.beginning.get(), self.last.get());
        if done.time > beginning + self.period {
            let mut late = self.late.take();
            if late.len() < KEPT {
                late.push(LateCycle {
                    beginning,
                    woken: woken.time,
                    done: done.time,
                    ran: done.ran - woken.ran,
                    computed: done.ran - computing.ran,
                });
            }
            self.late.set(late);
        }
    }
}

impl Clock for &NotingClock {
    fn now(&self) -> u64 {
        let instant = Instant { time: now(), ran: thread_time() };
        if self.woken.get().is_none() {
            self.woken.set(Some(instant));
        }
        self.last.set([self.last.get()[1], instant]);
        instant.time
    }

    fn sleep_until(&self, deadline: u64) {
        self.end_cycle();
        self.beginning.set(deadline);
        MonotonicClock.sleep_until(deadline);
    }
}

/// Of the servo's thread, ns.
#[derive(Clone, Copy, Default)]
struct Instant {
    time: u64,
    /// For how long it has run.
    ran: u64,
}

/// For how long the calling thread has run, ns.
fn thread_time() -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is writable; the clock exists on every Linux.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// A time in which a core did not run a thread that was due, above all servos: from, to, ns.
pub type Pause = (u64, u64);

/// One thread a core that does nothing but wake up, as cyclictest's do, and notes when it was late.
pub struct Watchers {
    ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<Vec<Pause>>>,
}

/// A watcher looks so often, ns: within what a cycle may run for, so that no pause that makes one late goes unseen.
const LOOKING: u64 = 100_000;

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
        self.0.iter().any(|core| {
            // They are in the order of time.
            let near = &core[core.partition_point(|pause| pause.1 <= cycle.beginning)..];
            let near = near.iter().take_while(|pause| pause.0 < cycle.done);
            near.map(overlap).map(seen).sum::<u64>() >= excess
        })
    }
}

/// What made a cycle late.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Cause {
    /// Its own wake-up: without that it would have been in time.
    WakeUp,
    /// A core stood still meanwhile to a thread above all servos, for as long as the cycle was late.
    Pause,
    /// It was kept from its core: by a poll that returned after its deadline, or by other threads. It ran for so short
    /// a time that it would have been done with what is left of a period after the latest reply, had it run when it was
    /// due.
    Kept,
    /// It ran for longer than that, but would have been late without its computation too: write, wait and read took
    /// long.
    Exchange,
    /// None of these: the library itself, in its computation.
    Library,
}

/// A computation that ran for no longer than this part of a period has not made the cycle late.
const COMPUTING: f64 = 0.05;

/// `pauses`: of threads above all servos.
pub fn cause(cycle: &LateCycle, period: u64, pauses: &Pauses) -> Cause {
    let &LateCycle { beginning, woken, done, ran, computed } = cycle;
    let late_without_computation = done - computed > beginning + period;
    let within = |time: u64, part: f64| time as f64 <= part * period as f64;
    match () {
        _ if done - woken <= period => Cause::WakeUp,
        _ if pauses.explain(cycle, period) => Cause::Pause,
        _ if within(ran, 1.0 - REPLY_WINDOW) => Cause::Kept,
        _ if late_without_computation || within(computed, COMPUTING) => Cause::Exchange,
        _ => Cause::Library,
    }
}

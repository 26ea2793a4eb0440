//! Classifies late cycles by their causes. A clock records the times at which the servo calls it, and watch threads
//! record when their core paused.

use crate::cores::permitted;
use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::thread::JoinHandle;
use sun2xp::finger::REPLY_WINDOW;
use sun2xp::realtime::{Clock, MonotonicClock, Priority, Schedule, now, spawn};

/// Largest number of late cycles, and of pauses of each core, that is stored. It suffices for half an hour on a busy
/// machine.
const KEPT: usize = 4_000_000;

/// A cycle that was not complete when the next one was due. All times are in ns.
#[derive(Clone, Copy)]
pub struct LateCycle {
    /// Scheduled start.
    pub beginning: u64,
    /// Time of the first instruction.
    pub woken: u64,
    /// Time of the end.
    pub done: u64,
    /// Run time of the thread during the cycle, by the kernel's account. It includes system calls, but no waiting.
    pub ran: u64,
    /// The part of the run time that was computation, without system calls.
    pub computed: u64,
}

/// A clock that records late cycles. It finds them by the calls that a servo makes in one cycle, so the measured
/// library needs no change. The servo sleeps until the start of the cycle, and reads the time when it wakes up. Its
/// last two readings in the cycle are the start and the end of its computation.
pub struct NotingClock {
    period: u64,
    beginning: Cell<u64>,
    woken: Cell<Option<Instant>>,
    /// The last two readings.
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

    /// Returns the number of cycles, and the late ones.
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

/// A time on the servo's thread, ns.
#[derive(Clone, Copy, Default)]
struct Instant {
    time: u64,
    /// Run time of the thread so far.
    ran: u64,
}

/// Returns the run time of the calling thread, ns.
fn thread_time() -> u64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: `time` is writable, and the clock exists on every Linux.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

/// An interval in which a core did not run a thread that was due and had a priority above all servos: start and end,
/// ns.
pub type Pause = (u64, u64);

/// One thread for each core on which this process may run. Like the threads of cyclictest, it only wakes up, and
/// records when it was late.
pub struct Watchers {
    ended: Arc<AtomicBool>,
    threads: Vec<JoinHandle<Vec<Pause>>>,
}

/// Interval between two wake-ups of a watch thread, ns. Every pause longer than this interval plus [`PAUSE`] is
/// detected. At 1000 Hz, this sum is the part of a period that is left after [`REPLY_WINDOW`].
const CHECK_INTERVAL: u64 = 100_000;

/// A wake-up that is later than this counts as a pause, ns.
const PAUSE: u64 = 50_000;

impl Watchers {
    pub fn start(priority: u8) -> std::io::Result<Self> {
        let ended = Arc::new(AtomicBool::new(false));
        let watch = |core| {
            let ended = ended.clone();
            spawn("watcher", Priority { fifo: priority, core: Some(core) }, move |_| watch(&ended))
        };
        let threads = permitted()?.into_iter().map(watch).collect::<Result<_, _>>()?;
        Ok(Self { ended, threads })
    }

    pub fn finish(self) -> Pauses {
        self.ended.store(true, Relaxed);
        Pauses(self.threads.into_iter().map(|thread| thread.join().unwrap_or_default()).collect())
    }
}

fn watch(ended: &AtomicBool) -> Vec<Pause> {
    let mut pauses = Vec::with_capacity(KEPT);
    let mut schedule = Schedule::new(now() + CHECK_INTERVAL, CHECK_INTERVAL);
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

    /// Returns the total length of the pauses between two times, ns, on the core for which this total is largest.
    pub fn total_on_worst_core(&self, [from, to]: [u64; 2]) -> u64 {
        let overlap = |&(begun, ended): &Pause| ended.min(to).saturating_sub(begun.max(from));
        let total = |core: &Vec<Pause>| {
            let near = &core[core.partition_point(|pause| pause.1 <= from)..];
            near.iter().take_while(|pause| pause.0 < to).map(overlap).sum()
        };
        self.0.iter().map(total).max().unwrap_or(0)
    }

    /// Returns whether the pauses of any one core explain why a cycle was late. The servo may have been on any core.
    fn explain(&self, cycle: &LateCycle, period: u64) -> bool {
        let excess = cycle.done - (cycle.beginning + period);
        let overlap = |&(from, to): &Pause| to.min(cycle.done).saturating_sub(from.max(cycle.beginning));
        // If a pause begins between two wake-ups of a watch thread, the recorded pause is shorter than the true one.
        let corrected = |overlap: u64| if overlap > 0 { overlap + CHECK_INTERVAL } else { 0 };
        self.0.iter().any(|core| {
            // The pauses are sorted by time.
            let near = &core[core.partition_point(|pause| pause.1 <= cycle.beginning)..];
            let near = near.iter().take_while(|pause| pause.0 < cycle.done);
            near.map(overlap).map(corrected).sum::<u64>() >= excess
        })
    }
}

/// The cause of a late cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Cause {
    /// Its thread was woken late. If the thread had been woken on time, the cycle would have met its deadline.
    WakeUp,
    /// During the cycle, a core did not run a thread whose priority is above that of all servos. The pauses of this
    /// core, each lengthened by `CHECK_INTERVAL`, lasted in total at least as long as the time by which the cycle was
    /// late.
    Pause,
    /// A poll that returned late, or other threads, kept the thread off its core. The run time of the thread was at
    /// most the part of a period that is left after [`REPLY_WINDOW`]. If the thread had kept its core, the cycle would
    /// have met its deadline.
    KeptFromCore,
    /// The run time of the thread was above the limit of [`Cause::KeptFromCore`], but the computation was not the
    /// cause. Either the cycle would have been late even without the computation, or the computation took at most the
    /// fraction `COMPUTING` of a period. The system calls that write, poll and read used too much run time.
    Exchange,
    /// None of the above: the computation of the library itself.
    Library,
}

/// A computation whose run time is at most this part of a period does not count as the cause of a late cycle.
const COMPUTING: f64 = 0.05;

/// Returns the cause of a late cycle. `pauses` are the pauses of threads whose priority is above that of all servos.
pub fn cause(cycle: &LateCycle, period: u64, pauses: &Pauses) -> Cause {
    let &LateCycle { beginning, woken, done, ran, computed } = cycle;
    let late_without_computation = done - computed > beginning + period;
    let within = |time: u64, part: f64| time as f64 <= part * period as f64;
    match () {
        _ if done - woken <= period => Cause::WakeUp,
        _ if pauses.explain(cycle, period) => Cause::Pause,
        _ if within(ran, 1.0 - REPLY_WINDOW) => Cause::KeptFromCore,
        _ if late_without_computation || within(computed, COMPUTING) => Cause::Exchange,
        _ => Cause::Library,
    }
}

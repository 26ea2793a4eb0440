//! Compares the off-line analysis with an independent simulation of the scheduler: no simulated cycle may take longer
//! than the bound, whatever the phases, and however much each part falls short of its worst case.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::cell::Cell;
use sun2xp::realtime::{PeriodicThread, response_times};

/// A simulated thread, and the rest of its present cycle.
struct Running<'a> {
    thread: &'a PeriodicThread,
    /// Beginning of the present cycle, or of the next one.
    began: u64,
    doing: Doing,
    /// When it became ready to compute. Threads of equal priority run in this order.
    ready_since: u64,
}

#[derive(Clone, Copy, PartialEq)]
enum Doing {
    /// Time of the wake-up.
    Sleeping(u64),
    /// Time left to compute before the wait.
    Before(u64),
    /// Time at which the wait ends.
    Waiting(u64),
    /// Time left to compute after the wait.
    After(u64),
}

impl Running<'_> {
    fn ready(&self) -> bool {
        matches!(self.doing, Doing::Before(_) | Doing::After(_))
    }
}

/// Returns for each thread the longest time from the scheduled beginning of a cycle to its end, within `ticks`. One
/// tick is 1 ns. Every core runs the thread of the highest priority among the ready threads that may run on it.
fn simulate(threads: &[PeriodicThread], cores: usize, ticks: u64, seed: u64) -> Vec<u64> {
    let mut random = Pcg64::seed_from_u64(seed);
    // Mostly the worst case, sometimes anything below it.
    let mut up_to =
        move |most: u64| if random.next_u32() % 4 > 0 { most } else { u64::from(random.next_u32()) % (most + 1) };
    let mut longest = vec![0; threads.len()];
    let mut running: Vec<Running> = threads
        .iter()
        .map(|thread| {
            let began = up_to(thread.period);
            Running { thread, began, doing: Doing::Sleeping(began + up_to(thread.wake_up)), ready_since: 0 }
        })
        .collect();
    for now in 0..ticks {
        // Handles everything that takes no time, possibly several steps in a row.
        for (index, it) in running.iter_mut().enumerate() {
            loop {
                it.doing = match it.doing {
                    Doing::Sleeping(until) if until <= now => {
                        it.ready_since = now;
                        Doing::Before(up_to(it.thread.before))
                    }
                    Doing::Before(0) => Doing::Waiting(now + up_to(it.thread.waiting)),
                    Doing::Waiting(until) if until <= now => {
                        it.ready_since = now;
                        Doing::After(up_to(it.thread.after))
                    }
                    Doing::After(0) => {
                        longest[index] = longest[index].max(now - it.began);
                        it.began += it.thread.period;
                        Doing::Sleeping(it.began.max(now) + up_to(it.thread.wake_up))
                    }
                    _ => break,
                }
            }
        }
        let mut taken = vec![false; cores];
        let mut order: Vec<usize> = (0..running.len()).filter(|&index| running[index].ready()).collect();
        order.sort_by_key(|&index| {
            (std::cmp::Reverse(running[index].thread.priority), running[index].ready_since, index)
        });
        for index in order {
            let it = &mut running[index];
            let core = it.thread.core.or_else(|| taken.iter().position(|taken| !taken));
            if let Some(core) = core.filter(|&core| !taken[core]) {
                taken[core] = true;
                if let Doing::Before(left) | Doing::After(left) = &mut it.doing {
                    *left -= 1;
                }
            }
        }
    }
    longest
}

fn thread() -> impl Strategy<Value = PeriodicThread> {
    let parts = (0..5u64, 0..8u64, 0..30u64, 0..12u64);
    // Most threads have the same period, as servo threads do.
    let period = prop_oneof![3 => Just(60u64), 1 => 25..90u64];
    (prop_oneof![4 => (0..2usize).prop_map(Some), 1 => Just(None)], 1..4u8, period, parts).prop_map(
        |(core, priority, period, (wake_up, before, waiting, after))| PeriodicThread {
            core,
            priority,
            period,
            wake_up,
            before,
            waiting,
            after,
        },
    )
}

#[test]
fn no_cycle_takes_longer_than_its_bound() {
    let usual = ProptestConfig::default();
    let config = ProptestConfig { cases: usual.cases.max(400), failure_persistence: None, ..usual };
    let (all, bounded) = (Cell::new(0), Cell::new(0));
    let sets = (prop::collection::vec(thread(), 1..5), any::<u64>());
    let found = TestRunner::new(config).run(&sets, |(threads, seed)| {
        let bounds = response_times(&threads);
        let took = simulate(&threads, 2, 6000, seed);
        all.set(all.get() + threads.len());
        for (index, bound) in bounds.iter().enumerate() {
            if let Some(bound) = bound {
                bounded.set(bounded.get() + 1);
                let took = took[index];
                prop_assert!(took <= bound.done, "thread {index} took {took} of {bound:?}: {threads:#?}");
            }
        }
        Ok(())
    });
    found.unwrap_or_else(|failure| panic!("{failure}"));
    // An analysis that finds no bound would never be wrong. On average, the threads of a set need at most half of the
    // time of a core, so many of them must have a bound.
    let (all, bounded) = (all.get(), bounded.get());
    assert!(4 * bounded > all, "only {bounded} of {all} threads have a bound");
}

/// Without wake-up and waiting, the bound is reached when all threads begin a cycle at the same time. This test detects
/// an analysis that is always too pessimistic.
#[test]
fn the_bound_is_tight() {
    let threads = [(3, 7, 3), (2, 12, 3), (1, 20, 5)].map(|(priority, period, after)| PeriodicThread {
        core: Some(0),
        priority,
        period,
        wake_up: 0,
        before: 0,
        waiting: 0,
        after,
    });
    let bounds: Vec<u64> = response_times(&threads).iter().map(|bound| bound.expect("met").done).collect();
    let mut took = vec![0; 3];
    for seed in 0..200 {
        for (worst, took) in took.iter_mut().zip(simulate(&threads, 1, 2000, seed)) {
            *worst = took.max(*worst);
        }
    }
    assert_eq!(took, bounds);
}

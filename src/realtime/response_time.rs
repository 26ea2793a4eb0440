//! Off-line response time analysis of periodic threads, which section 6.2 of the report asks for.

/// A servo thread as the analysis models it. In every period it computes, waits for the serial line without using the
/// core, and computes again. All times are worst cases in ns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PeriodicThread {
    /// The core that the thread is bound to. Without one, the thread may compete with every other thread.
    pub core: Option<usize>,
    /// SCHED_FIFO priority. The thread with the higher number runs first.
    pub priority: u8,
    /// Time from one beginning to the next.
    pub period: u64,
    /// Time from the scheduled beginning to the first instruction.
    pub wake_up: u64,
    /// Computing time before the wait.
    pub before: u64,
    /// Length of the wait.
    pub waiting: u64,
    /// Computing time after the wait.
    pub after: u64,
}

/// Bounds on the progress of a thread, ns after the scheduled beginning of its period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Response {
    /// The end of the wait.
    pub waited: u64,
    /// The end of the cycle. It is never later than the end of the period.
    pub done: u64,
}

impl PeriodicThread {
    fn computing(&self) -> u64 {
        self.before.saturating_add(self.after)
    }

    fn alone(&self) -> u64 {
        // The sums saturate, so that times that are far too long do not wrap to short ones.
        self.wake_up.saturating_add(self.before).saturating_add(self.waiting).saturating_add(self.after)
    }

    /// Whether `other` may delay this thread on its core. Threads of equal priority run in the order in which they
    /// become ready. Each may have to wait for the other, but never longer than if the other had the higher priority.
    fn waits_for(&self, other: &Self) -> bool {
        let meet = match (self.core, other.core) {
            (Some(own), Some(others)) => own == others,
            _ => true,
        };
        meet && other.priority >= self.priority
    }
}

/// Computes a bound for each thread. The bounds hold for all phases of the threads. A thread has no bound if it may
/// still be busy when its next period begins, or if it waits for a thread without a bound.
///
/// Within any window of length w, thread j computes for at most ceil((w + R_j - C_j) / T_j) C_j, wherever its wait
/// lies: a cycle that reaches into the window began at most R_j before the window. R_j is the bound of thread j, C_j
/// its computing time, and T_j its period. So the smallest solution of R_i = wake-up + computing + waiting + sum over j
/// of ceil((R_i + R_j - C_j) / T_j) C_j, for all i at once, is a bound.
pub fn response_times(threads: &[PeriodicThread]) -> Vec<Option<Response>> {
    let mut done: Vec<Option<u64>> = threads.iter().map(|thread| within(thread, thread.alone())).collect();
    loop {
        let next: Vec<Option<u64>> =
            (0..threads.len()).map(|own| finish(threads, &done, own, threads[own].alone(), done[own]?)).collect();
        if next == done {
            break;
        }
        done = next;
    }
    let respond = |own: usize| {
        let thread = &threads[own];
        let alone = thread.alone() - thread.after;
        let mut waited = alone;
        loop {
            let next = finish(threads, &done, own, alone, waited)?;
            if next == waited {
                return Some(Response { waited, done: done[own]? });
            }
            waited = next;
        }
    };
    (0..threads.len()).map(respond).collect()
}

fn within(thread: &PeriodicThread, time: u64) -> Option<u64> {
    (time <= thread.period).then_some(time)
}

/// Returns `alone` plus the computing time, within `window`, of the threads that may delay thread `own`. Returns `None`
/// if the sum exceeds the period of thread `own`, or if one of those threads has no bound.
fn finish(threads: &[PeriodicThread], done: &[Option<u64>], own: usize, alone: u64, window: u64) -> Option<u64> {
    let thread = &threads[own];
    let mut time = alone;
    for (other, done) in threads.iter().zip(done).enumerate().filter(|(index, _)| *index != own).map(|(_, pair)| pair) {
        if thread.waits_for(other) && other.computing() > 0 {
            let cycles = (window.saturating_add((*done)?) - other.computing()).div_ceil(other.period);
            time = time.saturating_add(cycles.saturating_mul(other.computing()));
        }
    }
    within(thread, time)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thread(core: usize, priority: u8, period: u64, parts: [u64; 4]) -> PeriodicThread {
        let [wake_up, before, waiting, after] = parts;
        PeriodicThread { core: Some(core), priority, period, wake_up, before, waiting, after }
    }

    fn done(threads: &[PeriodicThread]) -> Vec<Option<u64>> {
        response_times(threads).iter().map(|response| response.map(|response| response.done)).collect()
    }

    /// The cycle ends after 10 + 20 + 300 + 40 ns, and the wait ends 40 ns earlier.
    #[test]
    fn a_single_thread_responds_after_the_sum_of_its_parts() {
        let [Some(response)] = response_times(&[thread(0, 80, 1000, [10, 20, 300, 40])])[..] else { panic!("late") };
        assert_eq!(response, Response { waited: 330, done: 370 });
    }

    /// The textbook example of three tasks without waiting: computing times C = 3, 3, 5, periods T = 7, 12, 20, bounds
    /// R = 3, 6, 20.
    #[test]
    fn without_waiting_it_is_the_classical_analysis() {
        let tasks =
            [(3, 7, 3), (2, 12, 3), (1, 20, 5)].map(|(priority, period, c)| thread(0, priority, period, [0, c, 0, 0]));
        // R_j - C_j is 0 for the first and 3 for the second: R_3 = 5 + 3 ceil(R/7) + 3 ceil((R + 3)/12) = 5 + 9 + 6 =
        // 20.
        assert_eq!(done(&tasks), [Some(3), Some(6), Some(20)]);
    }

    /// By hand: R_2 = 100 + 30 ceil((R_2 + 530 - 30)/1000). There is one cycle of the other thread, because 130 + 500 <
    /// 1000.
    #[test]
    fn a_thread_that_waits_may_delay_another_one_twice() {
        let other = thread(0, 90, 1000, [0, 10, 500, 20]);
        assert_eq!(done(&[other, thread(0, 80, 1000, [0, 100, 0, 0])]), [Some(530), Some(130)]);
        // 600 + 30 * 2, because 660 + 500 > 1000.
        assert_eq!(done(&[other, thread(0, 80, 1000, [0, 600, 0, 0])]), [Some(530), Some(660)]);
        // A thread on another core or of a lower priority does not matter.
        assert_eq!(done(&[other, thread(1, 80, 1000, [0, 600, 0, 0])]), [Some(530), Some(600)]);
        assert_eq!(done(&[thread(0, 70, 1000, [0, 9, 0, 0]), thread(0, 80, 1000, [0, 600, 0, 0])])[1], Some(600));
        let anywhere = PeriodicThread { core: None, ..other };
        assert_eq!(done(&[anywhere, thread(1, 80, 1000, [0, 600, 0, 0])]), [Some(530), Some(660)]);
    }

    #[test]
    fn endless_times_have_no_bound() {
        for endless in [[u64::MAX, 1, 1, 1], [1, u64::MAX, 1, 1], [1, 1, u64::MAX, 1], [1, 1, 1, u64::MAX]] {
            assert_eq!(done(&[thread(0, 90, 1000, endless), thread(0, 80, 1000, [0, 10, 0, 0])]), [None, None]);
        }
    }

    /// The periods are so long that each of these threads would end its cycle within its period if it were alone.
    #[test]
    fn sums_that_are_too_large_have_no_bound() {
        const TENTH: u64 = u64::MAX / 10;
        let longest = |priority, period, computing| thread(0, priority, period, [0, computing, 0, 0]);
        // The sum of the window and the bound of the other thread is 12 tenths of the largest number.
        let half = longest(80, u64::MAX - 1, 6 * TENTH);
        assert_eq!(done(&[half, half]), [None, None]);
        // Three cycles of the other thread come to 9 tenths.
        let often = longest(90, 3 * TENTH, 3 * TENTH);
        assert_eq!(done(&[often, longest(80, u64::MAX - 1, 9 * TENTH)]), [Some(3 * TENTH), None]);
    }

    #[test]
    fn a_thread_that_may_be_late_has_no_bound_nor_has_one_that_waits_for_it() {
        let late = thread(0, 90, 1000, [0, 600, 500, 0]);
        assert_eq!(
            done(&[late, thread(0, 80, 1000, [0, 10, 0, 0]), thread(1, 80, 1000, [0, 10, 0, 0])]),
            [None, None, Some(10)]
        );
        // Together, these two threads of equal priority need more time than the core has.
        let half = thread(0, 80, 1000, [0, 501, 0, 0]);
        assert_eq!(done(&[half, half]), [None, None]);
    }
}

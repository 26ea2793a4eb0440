//! Measures how late this machine wakes up a thread that has the settings of a servo thread.
#![allow(unsafe_code)]

use crate::realtime::{
    Clock, CycleStage, CycleTiming, Distribution, Histograms, MonotonicClock, Priority, RealtimeRefusals, Schedule,
    spawn,
};
use std::io;
use std::thread::JoinHandle;

/// The result of a measurement.
#[derive(Debug)]
pub struct WakeUp {
    /// Time from the scheduled beginning of a period to the thread's first instruction, us.
    pub late: Distribution,
    /// What the system refused to the thread.
    pub refusals: RealtimeRefusals,
    /// Timer slack: how late the kernel may wake an ordinary thread, ns; an error if the system refuses the query.
    pub timer_slack: io::Result<u64>,
}

/// Starts a thread that wakes up `cycles` times, at the times of `schedule`, and does nothing else.
///
/// # Errors
/// Returns the system's error if it cannot start a thread.
pub fn measure_wake_up(priority: Priority, mut schedule: Schedule, cycles: u64) -> io::Result<JoinHandle<WakeUp>> {
    spawn("sun2xp doctor", priority, move |refusals| {
        let mut histograms = Histograms::new();
        for _ in 0..cycles {
            let beginning = schedule.next();
            MonotonicClock.sleep_until(beginning);
            let mut timing = CycleTiming::default();
            timing.note(CycleStage::WakeUp, beginning, MonotonicClock.now());
            histograms.record(&timing);
            schedule.advance(MonotonicClock.now());
        }
        // SAFETY: PR_GET_TIMERSLACK takes no argument, and concerns only the calling thread. A sandbox may refuse the
        // call, which then returns -1.
        let returned = unsafe { libc::prctl(libc::PR_GET_TIMERSLACK) };
        let timer_slack = u64::try_from(returned).map_err(|_| io::Error::last_os_error());
        WakeUp { late: histograms.distribution(CycleStage::WakeUp), refusals, timer_slack }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::realtime::now;

    #[test]
    fn every_wake_up_is_counted_and_timers_are_exact() {
        let schedule = Schedule::new(now(), 200_000);
        let thread = measure_wake_up(Priority::default(), schedule, 50).expect("a thread");
        let measured = thread.join().expect("no panic");
        assert_eq!((measured.late.count, measured.timer_slack.expect("no sandbox refuses it")), (50, 1));
        assert!(measured.late.maximum >= measured.late.median && measured.refusals.scheduling.is_none());
    }
}

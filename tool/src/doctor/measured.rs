//! Measures the wake-up latencies of threads that run like the servo threads, and compares them with the period.

use super::finding::{Finding, Rating, lacking};
use std::time::Duration;
use sun2xp::hand::HandError;
use sun2xp::hand::missing_permissions;
use sun2xp::hand::priority;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{Schedule, WakeUp, measure_wake_up, now};

/// Time for the threads to become ready before the first period begins, ns.
const HEAD_START: u64 = 10_000_000;

/// If the 99 % wake-up latency exceeds this fraction of the period, the time left for the replies becomes short.
const LATE: f64 = 0.1;

/// If the 99 % wake-up latency exceeds this fraction of the period, many periods are lost. If only the worst latency
/// exceeds it, single periods are lost.
const TOO_LATE: f64 = 0.5;

/// Largest acceptable timer slack of a thread that is not real-time, ns. Servo threads request 1 ns. The default of the
/// kernel is 50 us.
const SLACK: u64 = 1000;

/// Measures threads that wake up as the servos would. All threads run at the same time, with the same stagger as the
/// servos.
pub(super) fn wake_ups(configuration: &Configuration, duration: Duration) -> Result<Vec<Finding>, HandError> {
    let period = (1e9 / configuration.hand.rate).round() as u64;
    let cycles = (duration.as_nanos() as u64 / period).max(1);
    let mut threads: Vec<u8> =
        configuration.hand.fingers.members().map(|finger| configuration.thread(finger)).collect();
    threads.sort_unstable();
    threads.dedup();
    let first = now() + HEAD_START;
    let measuring: Result<Vec<_>, _> = threads
        .iter()
        .enumerate()
        .map(|(place, &thread)| {
            let schedule = Schedule::staggered(first, period, place, threads.len());
            measure_wake_up(priority(configuration, thread), schedule, cycles).map(|measuring| (thread, measuring))
        })
        .collect();
    let measuring = measuring.map_err(|source| HandError::System { doing: "start a thread", source })?;
    // A thread that panicked has no result.
    let measured = measuring.into_iter().filter_map(|(thread, measuring)| Some((thread, measuring.join().ok()?)));
    Ok(measured
        .flat_map(|(thread, wake_up)| {
            let slack = judge_slack(thread, priority(configuration, thread).fifo > 0, &wake_up);
            [judge(configuration, thread, wake_up), slack]
        })
        .collect())
}

fn judge(configuration: &Configuration, thread: u8, wake_up: WakeUp) -> Finding {
    let subject = format!("wake-up of servo thread {thread}");
    let WakeUp { late, refusals, .. } = wake_up;
    let period = 1e6 / configuration.hand.rate;
    let periods = late.maximum / period;
    let lost = if periods > 1.0 { format!(" ({periods:.1} periods)") } else { String::new() };
    let found = format!(
        "median {:.0} us, 99 % {:.0} us, worst {:.0} us{lost}; a period is {period:.0} us",
        late.median, late.p99, late.maximum
    );
    let watchdog = f64::from(configuration.hand.watchdog_ms) * 1e3;
    let (verdict, consequence) = match late.p99 / period {
        share if share > TOO_LATE => (Rating::Failure, "Periods are lost again and again."),
        _ if late.maximum > watchdog => (Rating::Failure, "The board's watchdog trips, and the finger faults."),
        share if share > LATE => (Rating::Warning, "The time left for the replies becomes short."),
        _ if periods > TOO_LATE => (Rating::Warning, "The worst wake-up is so late that its period is lost."),
        _ => (Rating::Good, ""),
    };
    let missing = missing_permissions(vec![refusals]).first().map(ToString::to_string);
    if verdict > Rating::Good {
        let only_watchdog = late.maximum > watchdog && late.p99 / period <= TOO_LATE;
        let other = if only_watchdog { "raise hand.watchdog_ms" } else { "lower hand.rate" };
        let cause = match missing {
            Some(missing) => missing,
            None if priority(configuration, thread).fifo == 0 => format!(
                "This thread has no real-time priority, so every busy program delays it. Set hand.real_time to \
                 \"try\" and finger.priority to a number from 1 to 99, or {other}"
            ),
            None => format!(
                "Something keeps this thread from running, for example other real-time threads, a busy or paused \
                 virtual machine, or power saving. Isolate a core for it (finger.core), or {other}"
            ),
        };
        return Finding::new(verdict, subject, found, format!("{consequence} {cause}"));
    }
    match missing {
        Some(missing) => lacking(configuration, &subject, found, missing),
        None => Finding::good(subject, found),
    }
}

/// `asked` says whether a real-time priority was requested for the thread.
fn judge_slack(thread: u8, asked: bool, wake_up: &WakeUp) -> Finding {
    let subject = format!("timer slack of servo thread {thread}");
    let (found, short) = match &wake_up.timer_slack {
        Ok(slack) => (format!("{slack} ns"), *slack <= SLACK),
        Err(refused) => {
            (format!("unknown, because the system refused the query (prctl, PR_GET_TIMERSLACK): {refused}"), false)
        }
    };
    if short {
        return Finding::good(subject, found);
    }
    if asked && wake_up.refusals.scheduling.is_none() {
        return Finding::good(subject, format!("{found}; does not apply to a real-time thread"));
    }
    // If a real-time priority was requested, the system has refused it.
    let other = match asked {
        true => "permit the real-time priority (see the wake-up of this thread)",
        false => "make the thread real-time (hand.real_time = \"try\" and a finger.priority above 0)",
    };
    let advice = match wake_up.timer_slack {
        Err(_) => "The kernel may delay each wake-up of this thread by up to its timer slack. Permit prctl",
        Ok(_) => {
            "The kernel may delay each wake-up of this thread by up to this time, and the system refused to shorten it \
             (prctl, PR_SET_TIMERSLACK). Permit that call"
        }
    };
    Finding::new(Rating::Warning, subject, found, format!("{advice} if a sandbox forbids it, or {other}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::realtime::{Distribution, RealtimeRefusals};

    #[test]
    fn wake_ups_are_judged_by_the_period() {
        let judged_by_worst = |rate, p99, worst, refusals| {
            let mut configuration = Configuration::default();
            configuration.hand.rate = rate;
            let mut late = Distribution::default();
            (late.p99, late.maximum) = (p99, worst);
            judge(&configuration, 1, WakeUp { late, refusals, timer_slack: Ok(1) })
        };
        let judged = |rate, p99, refusals| judged_by_worst(rate, p99, p99, refusals);
        assert_eq!(judged(1000.0, 90.0, RealtimeRefusals::default()).verdict, Rating::Good);
        assert_eq!(judged(1000.0, 110.0, RealtimeRefusals::default()).verdict, Rating::Warning);
        assert_eq!(judged(5000.0, 110.0, RealtimeRefusals::default()).verdict, Rating::Failure);
        // The worst wake-up counts too. The watchdog of the board trips after 18 ms.
        for (worst, verdict, part) in [
            (400.0, Rating::Good, "worst 400 us; a period is 1000 us"),
            (4700.0, Rating::Warning, "worst 4700 us (4.7 periods); a period is 1000 us"),
            (18_100.0, Rating::Failure, "(18.1 periods); a period is 1000 us"),
        ] {
            let finding = judged_by_worst(1000.0, 90.0, worst, RealtimeRefusals::default());
            assert!(finding.verdict == verdict && finding.found.ends_with(part), "{finding:?}");
        }
        let scheduling = Some(std::io::Error::from_raw_os_error(libc::EPERM));
        let refused = judged(1000.0, 90.0, RealtimeRefusals { scheduling, ..RealtimeRefusals::default() });
        assert!(refused.verdict == Rating::Warning && refused.advice.contains("rtprio"), "{refused:?}");
    }

    #[test]
    fn a_late_thread_gets_the_advice_for_its_cause() {
        let advice = |p99, worst, refusals, priority| {
            let mut configuration = Configuration::default();
            configuration.fingers[0].priority = priority;
            let mut late = Distribution::default();
            (late.p99, late.maximum) = (p99, worst);
            judge(&configuration, 1, WakeUp { late, refusals, timer_slack: Ok(1) }).advice
        };
        let (period, watchdog) = (1000.0, 18_000.0);
        let often = advice(0.6 * period, period, RealtimeRefusals::default(), 80);
        assert!(often.contains("finger.core") && often.ends_with("lower hand.rate"), "{often}");
        let once = advice(0.05 * period, 1.1 * watchdog, RealtimeRefusals::default(), 80);
        assert!(once.contains("finger.core") && once.ends_with("raise hand.watchdog_ms"), "{once}");
        let both = advice(0.6 * period, 1.1 * watchdog, RealtimeRefusals::default(), 80);
        assert!(both.ends_with("lower hand.rate"), "{both}");
        let ordinary = advice(0.6 * period, period, RealtimeRefusals::default(), 0);
        assert!(ordinary.contains("finger.priority") && !ordinary.contains("finger.core"), "{ordinary}");
        let scheduling = Some(std::io::Error::from_raw_os_error(libc::EPERM));
        let refused = advice(0.6 * period, period, RealtimeRefusals { scheduling, ..RealtimeRefusals::default() }, 80);
        assert!(refused.contains("Periods are lost") && refused.contains("rtprio"), "{refused}");
    }

    #[test]
    fn timer_slack_counts_for_a_thread_that_is_not_real_time() {
        let judged = |timer_slack, asked, scheduling| {
            let refusals = RealtimeRefusals { scheduling, ..RealtimeRefusals::default() };
            judge_slack(1, asked, &WakeUp { late: Distribution::default(), refusals, timer_slack })
        };
        let refused = || std::io::Error::from_raw_os_error(libc::EPERM);
        assert_eq!(judged(Ok(1), false, None).verdict, Rating::Good);
        assert_eq!(judged(Ok(50_000), true, None).verdict, Rating::Good);
        let without_right = judged(Ok(50_000), true, Some(refused()));
        assert!(without_right.verdict == Rating::Warning && without_right.advice.contains("permit the real-time"));
        let not_requested = judged(Ok(50_000), false, None);
        assert!(not_requested.verdict == Rating::Warning && not_requested.advice.contains("hand.real_time"));
        // A sandbox may refuse the query of the timer slack.
        let unknown = judged(Err(refused()), false, None);
        assert!(unknown.verdict == Rating::Warning && unknown.found.starts_with("unknown"), "{unknown:?}");
        assert!(unknown.found.contains("PR_GET_TIMERSLACK): Operation not permitted"), "{unknown:?}");
        assert_eq!(judged(Err(refused()), true, None).verdict, Rating::Good);
    }
}

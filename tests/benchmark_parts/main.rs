//! Tests parts of the benchmarks: how they go on when other work on the machine disturbs them, which cores `realtime`
//! watches, how it reads the output of cyclictest, and how `handwritten` compares torques.

#[path = "../../benches/handwritten/agreement.rs"]
mod agreement;
#[allow(clippy::duplicate_mod, reason = "`opening` is the root of a benchmark, and has this module too")]
#[path = "../../benches/realtime/attempts.rs"]
mod attempts;
mod beside_other_work;
#[path = "../../benches/realtime/cores.rs"]
mod cores;
#[allow(dead_code, reason = "cyclictest is not run here")]
#[path = "../../benches/realtime/cyclictest.rs"]
mod cyclictest;
#[path = "../../benches/realtime/delays.rs"]
mod delays;
mod disturbed;
#[path = "../../benches/realtime/events.rs"]
mod events;
#[allow(dead_code, reason = "the classes of late cycles are not tested here")]
#[path = "../../benches/realtime/explain.rs"]
mod explain;
#[path = "../../benches/realtime/fingers.rs"]
mod fingers;
#[path = "../../benches/realtime/groups.rs"]
mod groups;
#[allow(dead_code, clippy::duplicate_mod, reason = "the children are programs of their own")]
#[path = "../../benches/opening/main.rs"]
mod opening;
#[allow(dead_code, reason = "not every percentile is tested here")]
#[path = "../../benches/realtime/percentiles.rs"]
mod percentiles;
#[path = "../../benches/realtime/planner.rs"]
mod planner;
#[path = "../../benches/realtime/reactions.rs"]
mod reactions;
#[allow(dead_code, reason = "the readers are processes of their own")]
#[path = "../../benches/realtime/telemetry.rs"]
mod telemetry;
#[path = "../../benches/realtime/throughput.rs"]
mod throughput;
#[path = "../../benches/realtime/turns.rs"]
mod turns;
#[path = "../../benches/realtime/under_control.rs"]
mod under_control;

use agreement::{apart, larger};
use attempts::{Attempts, MOST_FAILED};
use std::error::Error;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The benchmarks expect this name.
type Failure = Box<dyn Error>;

/// Waits for the turn of a test with servo threads. The servos of `throughput` have no rate limit, and would disturb
/// the other tests.
fn turn() -> MutexGuard<'static, ()> {
    static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes measurements that always fail.
fn fails(attempts: &mut Attempts) -> Option<u32> {
    attempts.measure("failing", || Err::<u32, _>("a finger has faulted"))
}

#[test]
fn a_disturbed_measurement_is_repeated() {
    let mut attempts = Attempts::default();
    let mut results = [Err("a finger has faulted"), Err("a finger has faulted"), Ok(7)].into_iter();
    assert_eq!(attempts.measure("some", || results.next().expect("a result")), Some(7));
    assert_eq!((attempts.failed, attempts.skipped), (2, 0));
    let said = "2 measurements failed, and 0 were skipped because too many had failed";
    assert_eq!(attempts.to_string(), said);
    assert_eq!(attempts.check([("some", 1)]), Ok(()));
}

#[test]
fn measurements_that_are_skipped_are_counted_and_a_missing_result_is_an_error() {
    let mut attempts = Attempts::default();
    assert_eq!(fails(&mut attempts), None);
    assert_eq!((attempts.failed, attempts.skipped), (MOST_FAILED, 1));
    let unexpected = || -> Result<u32, &str> { panic!("too many have failed") };
    assert_eq!(attempts.measure("others", unexpected), None);
    assert_eq!((attempts.failed, attempts.skipped), (MOST_FAILED, 2));
    let error = attempts.check([("some", 1), ("failing", 0), ("others", 0)]).expect_err("nothing was measured");
    assert!(error.contains("failing, others: 10 measurements failed, and 2 were skipped"), "{error}");
}

#[test]
fn a_number_that_cyclictest_did_not_print_is_named_with_the_remedy() {
    let printed = "# Histogram\n000002 000001 000000 000002\n# Max Latencies: 00002 00003 00004\n\
                   # Histogram Overflows: 00000 00001 00000\n";
    let measured = cyclictest::measurements(printed).unwrap_or_else(|error| panic!("{error}"));
    let counted: Vec<_> = measured.iter().map(|thread| (thread.count, thread.late, thread.latency.maximum)).collect();
    assert_eq!(counted, [(1, 0, 0.002), (1, 1, 0.003), (2, 0, 0.004)]);
    for (good, wrong) in [("000001 ", "1us "), ("00003 ", "3us "), ("00000 00001", "0us 00001")] {
        let word = wrong.split_whitespace().next().expect("a word");
        let error = cyclictest::measurements(&printed.replace(good, wrong)).err().expect("no number");
        assert!(error.contains(&format!("cyclictest printed \"{word}\" in place of a number")), "{error}");
        assert!(error.contains("install another version of rt-tests"), "{error}");
    }
    let error = cyclictest::measurements("").err().expect("no line");
    assert!(error.starts_with("cyclictest printed no line \"# Histogram Overflows:\""), "{error}");
}

#[test]
fn a_torque_that_is_nan_does_not_agree() {
    let theirs = [1.0, -2.0, 0.5, 0.0];
    assert_eq!(apart(&theirs, &theirs), 0.0);
    assert_eq!(apart(&[1.0, -2.0, 0.5, 0.5], &theirs), 0.25);
    assert_eq!(apart(&[0.0; 4], &[0.0; 4]), 0.0);
    for motor in 0..4 {
        let mut wrong = theirs;
        wrong[motor] = f64::NAN;
        assert!(apart(&wrong, &theirs).is_nan() && apart(&theirs, &wrong).is_nan(), "motor {motor}");
    }
    // If the difference of one cycle is NaN, the largest difference of the run is NaN, whatever follows.
    assert!(larger(larger(0.0, f64::NAN), 1e-12).is_nan() && larger(1e-12, f64::NAN).is_nan());
    assert_eq!((larger(1.0, 2.0), larger(2.0, 1.0)), (2.0, 2.0));
}

#[test]
fn only_the_permitted_cores_are_watched() {
    let last = *cores::permitted().expect("known").last().expect("this thread runs on a core");
    // The thread ends with this test, so no other test gets its affinity.
    let narrowed = std::thread::spawn(move || {
        // SAFETY: a cpu_set_t is plain bits, and all zeros is the empty set. `last` is less than CPU_SETSIZE.
        let refused = unsafe {
            let mut only: libc::cpu_set_t = std::mem::zeroed();
            libc::CPU_SET(last, &mut only);
            libc::sched_setaffinity(0, size_of::<libc::cpu_set_t>(), &only)
        };
        assert_eq!(refused, 0);
        cores::permitted().expect("known")
    });
    assert_eq!(narrowed.join().expect("no panic"), [last]);
}

//! Tests how `cargo bench --bench realtime` counts measurements that other work on the machine disturbs.

#[path = "../benches/realtime/attempts.rs"]
mod attempts;

use attempts::{Attempts, MOST_DISTURBED};

/// Makes measurements that always fail.
fn fails(attempts: &mut Attempts) -> Option<u32> {
    attempts.measure("failing", || Err::<u32, _>("a finger has faulted"))
}

#[test]
fn a_disturbed_measurement_is_repeated() {
    let mut attempts = Attempts::default();
    let mut results = [Err("a finger has faulted"), Err("a finger has faulted"), Ok(7)].into_iter();
    assert_eq!(attempts.measure("some", || results.next().expect("a result")), Some(7));
    assert_eq!((attempts.disturbed, attempts.skipped), (2, 0));
    assert_eq!(attempts.check([("some", 1)]), Ok(()));
}

#[test]
fn measurements_that_are_skipped_are_counted_and_a_missing_result_is_an_error() {
    let mut attempts = Attempts::default();
    assert_eq!(fails(&mut attempts), None);
    assert_eq!((attempts.disturbed, attempts.skipped), (MOST_DISTURBED, 1));
    let unexpected = || -> Result<u32, &str> { panic!("too many have failed") };
    assert_eq!(attempts.measure("others", unexpected), None);
    assert_eq!((attempts.disturbed, attempts.skipped), (MOST_DISTURBED, 2));
    let error = attempts.check([("some", 1), ("failing", 0), ("others", 0)]).expect_err("nothing was measured");
    assert!(error.contains("failing, others: 10 measurements were disturbed, and 2 were skipped"), "{error}");
}

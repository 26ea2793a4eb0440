//! Checks the lock-free code of the library in every order of its threads that [`explore`] tries.

use std::process::Command;
use std::sync::{Arc, Mutex};
use sun2xp_models::{
    block_ring_checks, event_log_checks, explore, group_checks, mailbox_checks, ring_checks, stop_signal_checks,
    triple_buffer_checks, weakened,
};

/// Environment variable of a process that runs one test with every atomic access relaxed.
const WEAKENED: &str = "SUN2XP_TEST_WEAKENED";

/// Runs a check, and runs it again with every atomic access relaxed, as if the code had no memory orderings. The second
/// run must find a data race.
fn holds_and_needs_its_orderings(check: impl Fn() + Send + Sync + 'static) {
    holds_and_fails_without_its_orderings("Causality violation", check);
}

/// Runs a check, and runs it again with every atomic access relaxed, as if the code had no memory orderings. The second
/// run must fail with `message`. The second run is a process of its own, because a data race in a destructor ends the
/// process.
fn holds_and_fails_without_its_orderings(message: &str, check: impl Fn() + Send + Sync + 'static) {
    if std::env::var_os(WEAKENED).is_some() {
        return weakened(|| explore(check));
    }
    explore(check);
    let thread = std::thread::current();
    let name = thread.name().expect("the name of the test");
    let mut test = Command::new(std::env::current_exe().expect("the test's own program"));
    let run = test.args(["--exact", name, "--nocapture"]).env(WEAKENED, "1").output().expect("the test starts");
    let output = String::from_utf8_lossy(&run.stderr);
    assert!(
        !run.status.success() && output.contains(message),
        "without its orderings, the check must fail with {message:?}: {output}"
    );
}

#[test]
fn a_triple_buffer_passes_whole_values_in_order() {
    holds_and_needs_its_orderings(triple_buffer_checks::values_are_whole_and_in_order);
}

#[test]
fn a_value_in_a_triple_buffer_is_new_once() {
    holds_and_needs_its_orderings(triple_buffer_checks::a_value_is_new_once);
}

#[test]
fn a_ring_passes_every_value_once_and_in_order() {
    holds_and_needs_its_orderings(ring_checks::values_arrive_once_and_in_order);
}

#[test]
fn a_ring_drops_what_was_not_taken() {
    holds_and_needs_its_orderings(ring_checks::values_that_were_not_taken_are_dropped);
}

#[test]
fn a_link_is_handed_over_and_back() {
    holds_and_needs_its_orderings(ring_checks::a_link_goes_to_and_fro);
}

#[test]
fn an_order_has_its_data() {
    holds_and_needs_its_orderings(mailbox_checks::an_order_comes_after_its_data);
}

#[test]
fn a_set_point_is_valid_for_one_spring() {
    holds_and_needs_its_orderings(mailbox_checks::a_set_point_is_for_one_spring);
}

/// The places of the log are atomic, so a missing ordering causes no data race. Instead, the reader gets mixed events.
#[test]
fn a_log_passes_whole_events_and_counts_the_lost_ones() {
    let check = event_log_checks::events_are_whole_and_lost_events_are_counted;
    holds_and_fails_without_its_orderings("parts of different events", check);
}

/// The words of the ring are atomic, so a missing ordering causes no data race. Instead, the reader gets mixed blocks.
#[test]
fn a_ring_of_blocks_passes_whole_blocks() {
    let check = block_ring_checks::blocks_are_whole_and_the_newest_arrives;
    holds_and_fails_without_its_orderings("of different blocks", check);
}

#[test]
fn a_log_has_no_later_event_before_its_horizon() {
    let check = event_log_checks::no_later_event_is_before_the_horizon;
    holds_and_fails_without_its_orderings("before the horizon", check);
}

/// The gate passes the decision itself, and no other data, so this check needs no ordering.
#[test]
fn a_group_takes_effect_in_one_period() {
    explore(group_checks::a_group_takes_effect_in_one_period);
}

#[test]
fn a_posted_group_has_its_set_points() {
    explore(group_checks::a_posted_group_has_its_set_points);
}

/// The request to close passes no other data, so this check needs no ordering.
#[test]
fn a_request_to_close_is_answered() {
    explore(mailbox_checks::a_request_to_close_is_answered);
}

/// The counters pass no other data, so this check needs no ordering. The explored orders must give both results: just
/// after the recovery, the finger notices the second stop call, or it does not notice this call yet.
#[test]
fn a_stop_call_during_a_recovery_stops_the_finger() {
    let seen = Arc::new(Mutex::new(Vec::new()));
    let results = seen.clone();
    explore(move || {
        let (at_once, _) = stop_signal_checks::a_stop_call_during_a_recovery_is_not_lost();
        results.lock().expect("no panic").push(at_once.is_some());
    });
    let seen = seen.lock().expect("no panic");
    assert!(seen.contains(&true) && seen.contains(&false), "{seen:?}");
}

#[test]
fn a_fault_stops_the_fingers_that_stop_together() {
    explore(stop_signal_checks::a_fault_stops_the_companion_once);
}

//! Compares the chapters' statements about all calls with the entries of the calls.

use super::c::root;
use super::manual::{HANDLES, Manual, OF_1990, listed};
use std::fs;

/// The names between two parts of a sentence of a chapter.
fn between<'a>(chapter: &'a str, before: &str, after: &str) -> Vec<&'a str> {
    let rest = chapter.split_once(before).unwrap_or_else(|| panic!("no sentence with {before:?}: {chapter}")).1;
    listed(rest.split_once(after).unwrap_or_else(|| panic!("no sentence with {after:?}: {chapter}")).0)
}

fn sorted(mut names: Vec<&str>) -> Vec<&str> {
    names.sort_unstable();
    names
}

#[test]
fn the_calls_that_do_not_return_int_are_listed() {
    let manual = Manual::read(OF_1990);
    let chapter = manual.chapter(2);
    let others = manual.entries.iter().filter(|entry| !entry.declaration.starts_with("int "));
    let others = others.map(|entry| entry.call.as_str()).collect();
    assert_eq!(sorted(between(&chapter, "Every call except ", " returns an int")), sorted(others));
}

#[test]
fn the_calls_that_signal_handlers_may_make_are_named() {
    let manual = Manual::read(HANDLES);
    let chapter = manual.chapter(5);
    let safe = manual.entries.iter().filter(|entry| entry.threads().contains("signal handler"));
    let safe = safe.map(|entry| entry.call.as_str()).collect();
    assert_eq!(sorted(between(&chapter, "A signal handler may call ", ", and no other")), sorted(safe));
}

/// `a_small_stack_is_enough_for_every_call` runs small_stack.c, which tests the sentence about the stack for the calls
/// in its table. This test only searches the text of small_stack.c for the calls. The search suffices: a function that
/// makes a call but is not in the table is unused, so the compiler refuses it.
#[test]
fn the_stack_of_every_call_is_measured() {
    let source = fs::read_to_string(root().join("tests/c/small_stack.c")).expect("a source file");
    let manual = Manual::read(HANDLES);
    let calls = manual.entries.iter().map(|entry| entry.call.as_str());
    let missing: Vec<&str> = calls.filter(|call| !source.contains(&format!("{call}("))).collect();
    assert!(missing.is_empty(), "tests/c/small_stack.c does not make these calls: {missing:?}");
}

/// The entry of sun2xp_identify has no list of errnos: the list of sun2xp_zero applies to it.
#[test]
fn the_calls_that_a_forked_child_may_make_are_named() {
    let manual = Manual::read(HANDLES);
    let chapter = manual.chapter(5);
    let works = manual.entries.iter().filter(|entry| !entry.errnos().contains(&"EPERM"));
    let works = works.map(|entry| entry.call.as_str()).filter(|&call| call != "sun2xp_identify").collect();
    assert_eq!(sorted(between(&chapter, "is refused with EPERM, except ", "; the parent")), sorted(works));
}

/// `a_forked_child_is_refused` runs tests/c/forked.c. This program checks EPERM with REFUSED, and success with WORKS.
#[test]
fn a_forked_child_makes_every_call() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("a file");
    let (source, symbols) = (read("tests/c/forked.c"), read("docs/abi/symbols"));
    let handles = Manual::read(HANDLES).chapter(5);
    let of_1990 = Manual::read(OF_1990).chapter(6);
    let mut works = between(&handles, "is refused with EPERM, except ", "; the parent");
    works.extend(between(&of_1990, "each call but ", " is refused with EPERM"));
    assert!(symbols.lines().count() > 50 && works.iter().all(|call| symbols.lines().any(|symbol| symbol == *call)));
    for call in symbols.lines() {
        let check = if works.contains(&call) { "WORKS(" } else { "REFUSED(" };
        let checks = |line: &str| line.trim_start().starts_with(check) && line.contains(&format!("{call}("));
        assert!(source.lines().any(checks), "tests/c/forked.c should make the call {call} with {check}...)");
    }
}

/// tests/c/locked_memory.c tests that memory_locked stays 1 after munlockall.
#[test]
fn the_member_for_locked_memory_says_what_munlockall_does() {
    let text = Manual::read(HANDLES).member("sun2xp_status", "memory_locked");
    assert!(text.contains("munlockall later, this memory is unlocked too, and this member stays 1"), "{text}");
}

/// Members that count the same events must have the same description. The status counts skipped periods up to now, and
/// the timing counts them up to the last cycle.
#[test]
fn counts_of_the_status_are_those_of_the_timing() {
    let manual = Manual::read(HANDLES);
    let first = |text: String| text.split_once('.').expect("a sentence").0.to_string();
    let status = |member: &str| first(manual.member("sun2xp_status", member));
    let timing = |member: &str| first(manual.member("sun2xp_timing", member));
    assert_eq!(status("lost_replies"), timing("lost_replies"));
    assert_eq!(status("damaged_replies"), timing("damaged_replies"));
    let skipped = status("skipped_periods");
    assert!(skipped.contains("up to now"), "{skipped}");
    assert_eq!(skipped.replace("up to now", "up to the last cycle"), timing("skipped_periods"));
}

/// The author of a planner who does not know the rules below would assume a wrong reason for a result.
#[test]
fn the_entries_say_what_else_a_result_depends_on() {
    let manual = Manual::read(HANDLES);
    for (call, sentence) in [
        ("sun2xp_wait", "If the set point that was sent last has expired, the condition must be true for the pose"),
        ("sun2xp_send_path", "With hand.out_of_range = \"clamp\" joint angles and Kx are clamped"),
        ("sun2xp_zero", "an interpolated motion (finger.motion.interpolate_ms) that it followed has ended"),
        ("sun2xp_recover", "one after the other, up to the first that does not recover"),
        ("sun2xp_install_reflex", "SUN2XP_WHEN_LINK_LOST never becomes true for it"),
        ("sun2xp_install_reflex", "expires when the one that was sent last would have expired"),
        ("sun2xp_adjust", "against the new limits, except those of finger.motion, which apply only to later paths"),
    ] {
        let entry = manual.entry(call);
        assert!(entry.contains(sentence), "{sentence:?} is not in {entry}");
    }
    assert!(
        manual.comment("sun2xp_tip").contains("After a change of Kx, this member has its new value in the next cycle")
    );
}

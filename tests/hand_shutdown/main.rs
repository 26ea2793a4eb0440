//! Random shutdowns: in every stage of a hand, one thread or several threads at once close the hand, end it, or call
//! exit.
//!
//! Each case runs in a process of its own, because a case can end with exit, and because a process with a deadlock can
//! be killed. A run prints its seed. Set `SUN2XP_TEST_SEED` to repeat a run, and also `SUN2XP_TEST_CASE` to repeat only
//! one case of it.

mod case;
mod planners;

use case::Case;
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant, SystemTime};
use std::{env, fs};

const SEED: &str = "SUN2XP_TEST_SEED";
const CASE: &str = "SUN2XP_TEST_CASE";

/// Number of cases: each stage with each way to shut down, four times.
const CASES: u64 = 4 * case::COMBINATIONS as u64;

/// Number of cases that run at the same time. Their threads mostly wait.
const AT_ONCE: usize = 8;

/// Longest time for a case. It normally takes a second.
const LIMIT: Duration = Duration::from_secs(60);

/// Exit status of a case that ends with exit.
const EXITED: i32 = 3;

fn number(variable: &str) -> Option<u64> {
    env::var(variable).ok().map(|number| number.parse().expect("a number"))
}

#[test]
fn a_hand_is_shut_down_in_every_stage() {
    if let (Some(seed), Some(number)) = (number(SEED), number(CASE)) {
        let case = Case::random(seed, number);
        eprintln!("{case:?}");
        return case.run();
    }
    let clock = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).expect("a clock");
    let seed = number(SEED).unwrap_or(clock.as_secs());
    println!("{SEED}={seed}");
    let folder = tempfile::tempdir().expect("a scratch folder");
    let next = AtomicU64::new(0);
    let run = || {
        let numbers = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed)).take_while(|&next| next < CASES);
        numbers.filter_map(|number| shut_down(seed, number, folder.path()).err()).collect::<Vec<_>>()
    };
    let failures = thread::scope(|scope| {
        let threads = [(); AT_ONCE].map(|()| scope.spawn(run));
        threads.map(|thread| thread.join().expect("no panic")).concat()
    });
    assert!(failures.is_empty(), "{SEED}={seed}: {} of {CASES} failed:\n{}", failures.len(), failures.join("\n"));
}

/// Runs a case in a process of its own.
fn shut_down(seed: u64, number: u64, folder: &Path) -> Result<(), String> {
    let case = Case::random(seed, number);
    let configuration = folder.join(format!("{number}.toml"));
    fs::write(&configuration, case.configuration()).expect("a configuration file");
    let mut process = Command::new(env::current_exe().expect("the test's own program"))
        .args(["--exact", "a_hand_is_shut_down_in_every_stage", "--nocapture"])
        .env(SEED, seed.to_string())
        .env(CASE, number.to_string())
        .env("SUN2XP_CONFIG", configuration)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a process");
    let limit = Instant::now() + LIMIT;
    let ended = loop {
        match process.try_wait().expect("a child") {
            None if Instant::now() < limit => thread::sleep(Duration::from_millis(5)),
            ended => break ended,
        }
    };
    if ended.is_none() {
        process.kill().expect("killed");
        process.wait().expect("gone");
    }
    let expected = if case.exits() { EXITED } else { 0 };
    if ended.and_then(|status| status.code()) == Some(expected) {
        return Ok(());
    }
    let mut said = String::new();
    process.stderr.take().expect("its standard error").read_to_string(&mut said).expect("a text");
    let result = ended.map_or(format!("not ended after {LIMIT:?}"), |status| status.to_string());
    Err(format!("{CASE}={number}: {result}\n{said}"))
}

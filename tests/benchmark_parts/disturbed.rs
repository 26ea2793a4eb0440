//! Benchmarks that a fault disturbs: they go on, and print their tables even if nothing could be measured.

use crate::groups::{self, Measured};
use crate::turns::Turns;
use crate::{Failure, events, opening, planner, reactions, telemetry, throughput, turn};
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

/// Environment variable of a process that may open no files.
const NO_FILES: &str = "SUN2XP_TEST_NO_FILES";

/// A benchmark, and the beginning of a row that it prints if it has measured nothing.
type Benchmark = (fn() -> Result<(), Failure>, &'static str);

const BENCHMARKS: [Benchmark; 7] = [
    (|| throughput::run(&throughput::Arguments::default()), "| all | not measured"),
    (|| planner::run(&Turns::default()), "| two threads that call | not measured"),
    (|| groups::run(&groups::Arguments::default()), "Groups of 3 fingers in 3 servo threads: not measured"),
    (
        || reactions::run(&reactions::Arguments::default()),
        "| of the touched finger (goal: 99.9 % within 2 periods) | not",
    ),
    (|| events::run(&Turns::default()), "| 10 000 events a second | not measured"),
    (|| telemetry::run(&Turns::default()), "| three readers | not measured"),
    (|| opening::table(Path::new("libsun2xp.so"), 15), "stages                                       not measured"),
];

/// Runs all benchmarks in this process, which can open no more files, and so no port of a simulated board.
fn measure_nothing() {
    let none = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: a system call on a plain value.
    assert_eq!(unsafe { libc::setrlimit(libc::RLIMIT_NOFILE, &none) }, 0);
    for (run, _) in BENCHMARKS {
        println!("{}", run().expect_err("nothing can be measured"));
    }
}

#[test]
fn a_benchmark_that_can_measure_nothing_prints_its_table_and_the_reason() {
    if std::env::var_os(NO_FILES).is_some() {
        return measure_nothing();
    }
    let mut test = Command::new(std::env::current_exe().expect("the test's own program"));
    let name = "disturbed::a_benchmark_that_can_measure_nothing_prints_its_table_and_the_reason";
    let run = test.args(["--exact", name, "--nocapture"]).env(NO_FILES, "1").output().expect("the test starts");
    let [printed, reasons] = [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    assert!(run.status.success(), "{printed}{reasons}");
    for (_, row) in BENCHMARKS {
        assert!(printed.contains(row), "{row:?} is missing:\n{printed}");
    }
    assert!(!printed.contains("NaN"), "{printed}");
    // `throughput` makes three attempts, and every one of the other benchmarks makes ten.
    let attempts = 3 + 10 * (BENCHMARKS.len() - 1);
    assert_eq!(reasons.matches("Other work on the machine can cause this.").count(), attempts, "{reasons}");
    assert!(reasons.matches("Too many open files").count() >= attempts, "{reasons}");
}

#[test]
fn groups_continue_with_a_new_hand_after_a_fault() {
    let _turn = turn();
    let open = || Hand::open(Configuration::default()).expect("the simulated hand");
    let (hand, mut measured) = (open(), Measured::default());
    measured.send(&hand, 3).expect("three groups");
    hand.stop(2).expect("finger 2");
    let begun = Instant::now();
    while !matches!(hand.report(2).expect("finger 2").stage, Stage::Faulted(_)) {
        assert!(begun.elapsed() < Duration::from_secs(10), "finger 2 does not stop");
        sleep(Duration::from_millis(1));
    }
    let reason = measured.send(&hand, 5).expect_err("finger 2 has stopped").to_string();
    assert!(reason.contains("finger 2"), "{reason}");
    drop(hand);
    assert_eq!(measured.delays.len(), 3, "the earlier groups stay measured");
    measured.send(&open(), 5).expect("two more groups");
    assert_eq!(measured.delays.len(), 5);
}

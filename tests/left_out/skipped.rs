//! Tests on a machine without a tool: they pass and are listed, and with CI=true they fail.

use crate::{c, said, tools, turn, write_program};
use std::path::Path;
use std::process::{Command, Output};

/// This environment variable is set in a child process that runs this test program as on a machine without some tools.
/// Its value lists the compilers that the tests must use there.
const BARE: &str = "SUN2XP_TEST_BARE";

#[test]
fn a_test_that_needs_clang() {
    if std::env::var_os(BARE).is_some() {
        assert!(!tools::available("clang", "under clang"));
    }
}

#[test]
fn a_test_that_needs_every_compiler() {
    if let Ok(used) = std::env::var(BARE) {
        assert_eq!([c::c_compilers(), c::cpp_compilers()].concat().join(" "), used);
    }
}

/// Runs a test of this file with no programs but those in the folder `programs`.
fn run_alone(test: &str, programs: &Path, compilers: &str, ci: &str) -> Output {
    let mut run = Command::new(std::env::current_exe().expect("the test's own program"));
    run.args(["--exact", &format!("skipped::{test}")]).env(BARE, compilers).env("PATH", programs).env("CI", ci);
    run.output().expect("the test starts")
}

#[test]
fn without_a_tool_a_test_passes_and_is_listed_and_with_ci_it_fails() {
    let _turn = turn();
    let run_without_tools = |ci: &str| run_alone("a_test_that_needs_clang", Path::new("/nowhere"), "", ci);
    let run = run_without_tools("");
    let expected = "left_out, skipped::a_test_that_needs_clang, under clang: clang is missing";
    assert!(run.status.success() && said(&run).contains(expected), "{}", said(&run));
    run_without_tools("false");

    // This process is the parent of both runs. It lists the skipped test only once.
    let listed = tools::take_skipped(std::process::id());
    assert!(listed.len() == 1 && listed[0].starts_with(expected), "{listed:?}");
    assert!(listed[0].contains("apt-get install --no-install-recommends clang"), "{listed:?}");
    assert_eq!(tools::take_skipped(std::process::id()), Vec::<String>::new(), "lines of an earlier run");

    let run = run_without_tools("true");
    let output = said(&run);
    assert!(!run.status.success() && output.contains("apt-get install --no-install-recommends clang"), "{output}");
    assert_eq!(tools::take_skipped(std::process::id()), Vec::<String>::new());
}

#[test]
fn each_missing_compiler_is_listed_and_with_ci_it_fails() {
    let _turn = turn();
    for (missing, used) in [
        ("gcc", "cc clang g++ clang++"),
        ("clang", "gcc g++ clang++"),
        ("g++", "gcc clang clang++"),
        ("clang++", "gcc clang g++"),
    ] {
        let folder = tempfile::tempdir().expect("a scratch folder");
        std::os::unix::fs::symlink("/bin/sh", folder.path().join("sh")).expect("a link");
        for compiler in ["gcc", "clang", "g++", "clang++"].into_iter().filter(|&compiler| compiler != missing) {
            write_program(folder.path(), compiler, "exit 0");
        }
        let run = run_alone("a_test_that_needs_every_compiler", folder.path(), used, "");
        assert!(run.status.success(), "{}", said(&run));
        let listed = tools::take_skipped(std::process::id());
        let reason = format!(": {missing} is missing (");
        assert!(listed.len() == 1 && listed[0].contains(&reason), "without {missing}: {listed:?}");

        let run = run_alone("a_test_that_needs_every_compiler", folder.path(), used, "true");
        let reason = format!("{missing} is missing. Nothing may be skipped with CI=true");
        assert!(!run.status.success() && said(&run).contains(&reason), "without {missing}: {}", said(&run));
    }
    assert_eq!(tools::take_skipped(std::process::id()), Vec::<String>::new());
}

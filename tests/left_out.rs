//! Machines without the tools that tests need: what `cargo test` skips and lists, and what `tests/run` installs.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::{Mutex, PoisonError};

/// Environment variable of a process that runs this test program as if on a machine without tools.
const BARE: &str = "SUN2XP_TEST_BARE";

/// The user `nobody`.
const NOBODY: u32 = 65534;

#[test]
fn a_test_that_needs_clang() {
    if std::env::var_os(BARE).is_some() {
        assert!(!tools::available("clang", "under clang"));
    }
}

/// Held by one test at a time. A child that one test forks while another test writes a program inherits the open file,
/// and a program that is open for writing cannot be started.
static TURN: Mutex<()> = Mutex::new(());

/// Runs `a_test_that_needs_clang` in an environment without any program.
fn run_without_tools(ci: &str) -> Output {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let mut test = Command::new(std::env::current_exe().expect("the test's own program"));
    test.args(["--exact", "a_test_that_needs_clang"]).env(BARE, "1").env("PATH", "/nowhere").env("CI", ci);
    test.output().expect("the test starts")
}

fn said(run: &Output) -> String {
    [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text)).concat()
}

#[test]
fn without_a_tool_a_test_passes_and_is_listed_and_with_ci_it_fails() {
    let run = run_without_tools("");
    let expected = "left_out, a_test_that_needs_clang, under clang: clang is missing";
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

/// The list of Python packages of the copies of `tests/run`.
const PYTHON_PACKAGES: &str = "mcap==1\n";

/// Runs `tests/run` in a copy of its own, where the Python packages are installed.
fn run_script(programs: &[(&str, &str)], user: Option<u32>) -> (bool, String) {
    run_script_beside(PYTHON_PACKAGES, programs, user)
}

/// Runs `tests/run` in a copy of its own. Only these programs and a few of the system's are available. The Python
/// packages of the list `installed` are installed.
fn run_script_beside(installed: &str, programs: &[(&str, &str)], user: Option<u32>) -> (bool, String) {
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().expect("a scratch folder");
    let (tests, bin) = (folder.path().join("tests"), folder.path().join("bin"));
    fs::create_dir(&tests).expect("a folder");
    fs::create_dir(&bin).expect("a folder");
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).expect("the folder's mode can be changed");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/run");
    fs::copy(source, tests.join("run")).expect("a copy");
    fs::write(tests.join("tools.txt"), "# name\nhere | not-wanted | true\nclang | clang libc6-dev | looks-for-clang\n")
        .expect("written");
    fs::write(tests.join("requirements.txt"), PYTHON_PACKAGES).expect("written");
    fs::create_dir_all(folder.path().join("target/python")).expect("a folder");
    fs::write(folder.path().join("target/python/requirements.txt"), installed).expect("written");
    let write = |name: &str, text: &str| {
        let file = bin.join(name);
        fs::write(&file, format!("#!/bin/sh\n{text}\n")).expect("written");
        fs::set_permissions(file, fs::Permissions::from_mode(0o755)).expect("executable");
    };
    for (name, text) in programs {
        write(name, text);
    }
    for name in ["dirname", "env", "sh", "bash", "cat", "cp", "mkdir", "chmod"] {
        std::os::unix::fs::symlink(Path::new("/usr/bin").join(name), bin.join(name)).expect("a link");
    }
    let mut script = Command::new("/bin/bash");
    script.arg(tests.join("run")).arg("--test").arg("hand").env("PATH", &bin);
    script.env_remove("CI").env_remove("CARGO_TARGET_DIR");
    if let Some(user) = user {
        script.uid(user);
    }
    let run = script.output().expect("the script starts");
    (run.status.success(), said(&run))
}

const CARGO: (&str, &str) = ("cargo", "echo CI=$CI: cargo $*");
const APT: (&str, &str) = ("apt-get", "echo apt-get $*");
const SUDO: (&str, &str) = ("sudo", "echo sudo; exec \"$@\"");

/// A probe that fails the first time and succeeds afterwards, as it does once packages are installed.
const CLANG_AFTER_APT: (&str, &str) =
    ("looks-for-clang", "if [ -e \"$0.asked\" ]; then exit 0; fi; : > \"$0.asked\"; exit 1");

#[test]
fn nothing_is_installed_if_nothing_is_missing() {
    let (passed, output) = run_script(&[CARGO, APT, SUDO, ("looks-for-clang", "exit 0")], None);
    assert!(passed, "{output}");
    let (fetched, tested) = output.split_once('\n').expect("two lines");
    assert_eq!(fetched, "CI=: cargo fetch --locked --quiet");
    assert_eq!(tested, "CI=true: cargo test --locked --workspace --test hand\n");
}

#[test]
fn missing_programs_are_named_and_installed() {
    let (passed, output) = run_script(&[CARGO, APT, SUDO, CLANG_AFTER_APT], None);
    assert!(passed, "{output}");
    let lines = [
        "missing: clang",
        "installing the Debian packages clang libc6-dev",
        "install --yes --no-install-recommends clang libc6-dev",
        "CI=true: cargo test --locked --workspace --test hand",
    ];
    assert!(lines.iter().all(|line| output.contains(line)) && !output.contains("not-wanted"), "{output}");
}

#[test]
fn a_failed_installation_is_reported_with_the_remedy() {
    let remedy = "Run as root: apt-get install --no-install-recommends clang libc6-dev";
    let never = ("looks-for-clang", "exit 1");
    let failing = ("apt-get", "echo no network; exit 100");
    let without_network = ("cargo", "echo cargo $*; [ $1 != fetch ]");
    let found = ("looks-for-clang", "exit 0");
    for (programs, reason) in [
        (&[CARGO, failing, SUDO, never][..], remedy),
        (&[CARGO, APT, SUDO, never], "still missing after the packages were installed: clang"),
        (&[CARGO, SUDO, never], "apt-get is missing"),
        (&[APT, SUDO, never], "cargo is missing"),
        (&[without_network, APT, SUDO, found], "the crates were not downloaded. Check the network"),
    ] {
        let (passed, output) = run_script(programs, None);
        assert!(!passed && output.contains(reason) && !output.contains("cargo test --locked"), "{output}");
    }
}

#[test]
fn python_packages_of_another_list_are_replaced() {
    let usable = ("looks-for-clang", "exit 0");
    let python = ("python3", r#"mkdir -p $4/bin; echo "echo python \$*" > $4/bin/python; chmod +x $4/bin/python"#);
    let (passed, output) = run_script_beside("mcap==0\n", &[CARGO, usable, python], None);
    let install = "python -m pip install --quiet --disable-pip-version-check --requirement tests/requirements.txt\n";
    assert!(
        passed
            && output.contains(install)
            && output.ends_with("CI=true: cargo test --locked --workspace --test hand\n"),
        "{output}"
    );

    let (passed, output) = run_script_beside("mcap==0\n", &[CARGO, usable, ("python3", "exit 1")], None);
    let reason = "the Python packages were not installed. Check the network";
    assert!(!passed && output.contains(reason) && !output.contains("cargo test --locked"), "{output}");
}

#[test]
fn an_ordinary_user_needs_sudo() {
    // SAFETY: takes no arguments and has no preconditions.
    let user = if unsafe { libc::getuid() } == 0 { Some(NOBODY) } else { None };
    let never = ("looks-for-clang", "exit 1");
    let (passed, output) = run_script(&[CARGO, APT, SUDO, never], user);
    assert!(!passed && output.contains("sudo\napt-get -qq update\nsudo\napt-get -qq install --yes"), "{output}");
    let (passed, output) = run_script(&[CARGO, APT, never], user);
    let reason = "not root, and sudo is missing. Run as root: apt-get install --no-install-recommends clang libc6-dev";
    assert!(!passed && output.contains(reason) && !output.contains("apt-get -qq"), "{output}");
}

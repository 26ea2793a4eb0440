//! `tests/run`: what it installs, and what it says if it cannot install something.

use crate::{said, turn, write_program};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::Command;

/// The user `nobody`.
const NOBODY: u32 = 65534;

/// The list of Python packages beside each copy of `tests/run`.
const PYTHON_PACKAGES: &str = "mcap==1\n";

/// Runs a copy of `tests/run` in a folder of its own. The Python packages of its list count as installed already.
fn run_script(programs: &[(&str, &str)], user: Option<u32>) -> (bool, String) {
    run_script_beside(PYTHON_PACKAGES, programs, user)
}

/// Runs a copy of `tests/run` in a folder of its own. Only these programs and a few of the system's are available. The
/// Python packages of the list `installed` count as installed already.
fn run_script_beside(installed: &str, programs: &[(&str, &str)], user: Option<u32>) -> (bool, String) {
    let _turn = turn();
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
    for (name, text) in programs {
        write_program(&bin, name, text);
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

/// A probe that fails the first time and succeeds afterwards, as a real probe does after the packages were installed.
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

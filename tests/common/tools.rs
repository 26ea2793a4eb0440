//! Checks whether the tools that tests need besides Rust are installed, and lists the tests that are skipped.
//! `tests/tools.txt` names the tools and their Debian packages, and `tests/requirements.txt` the Python packages.
//! Without a tool, the tests that need it pass, and tests/zz_left_out.rs lists them at the end of `cargo test`. With
//! CI=true they fail.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::{env, fs};

const TOOLS: &str = include_str!("../tools.txt");

const PYTHON_PACKAGES: &str = include_str!("../requirements.txt");

/// A line of `tests/tools.txt`.
struct Tool {
    name: &'static str,
    packages: &'static str,
    /// A shell command that succeeds if the tool is usable.
    probe: &'static str,
}

fn tools() -> impl Iterator<Item = Tool> {
    TOOLS.lines().filter(|line| !line.starts_with('#')).filter_map(|line| {
        let mut columns = line.splitn(3, '|').map(str::trim);
        Some(Tool { name: columns.next()?, packages: columns.next()?, probe: columns.next()? })
    })
}

/// Returns whether the tests can use a tool of `tests/tools.txt`. If not, `part` of the current test is listed as
/// skipped. With CI=true the test fails instead.
pub fn available(name: &str, part: &str) -> bool {
    let tool = tools().find(|tool| tool.name == name).expect("tests/tools.txt has a line for the tool");
    let mut probe = Command::new("sh");
    probe.args(["-c", tool.probe]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if probe.status().is_ok_and(|status| status.success()) {
        return true;
    }
    let remedy = format!("apt-get install --no-install-recommends {}", tool.packages);
    assert!(
        env::var("CI").as_deref() != Ok("true"),
        "{name} is missing. Nothing may be skipped with CI=true. Run tests/run, or as root: {remedy}"
    );
    skip(part, &format!("{name} is missing ({remedy})"));
    false
}

/// Returns the Python interpreter that has the packages of `tests/requirements.txt`. If they are not installed, `part`
/// of the current test is listed as skipped. With CI=true the test fails instead.
pub fn python(part: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("python");
    // tests/run copies the list to this folder after it has installed the packages.
    if fs::read_to_string(folder.join("requirements.txt")).is_ok_and(|installed| installed == PYTHON_PACKAGES) {
        return Some(folder.join("bin/python"));
    }
    skip(part, "the Python packages of tests/requirements.txt are not installed (tests/run installs them)");
    None
}

/// Lists `part` of the current test as skipped, with the reason. With CI=true the test fails instead.
pub fn skip(part: &str, reason: &str) {
    assert!(env::var("CI").as_deref() != Ok("true"), "{part}: {reason}. Nothing may be skipped with CI=true");
    not_permitted(part, reason);
}

/// Lists `part` of the current test as skipped because the sandbox or the user forbids what it needs. No tool can
/// change that, so the test does not fail with CI=true either.
pub fn not_permitted(part: &str, reason: &str) {
    let thread = std::thread::current();
    let test = thread.name().filter(|&name| name != "main").unwrap_or("tests");
    note(&format!("{}, {test}, {part}: {reason}", env!("CARGO_CRATE_NAME")));
}

/// Prints a line even where the test's output is captured, and keeps it for the final list. Each line is printed once.
fn note(line: &str) {
    static NOTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    if !NOTED.lock().unwrap_or_else(PoisonError::into_inner).insert(line.to_owned()) {
        return;
    }
    // Only the printing macros are captured, not the functions of the streams.
    let _ = writeln!(std::io::stderr(), "skipped: {line}");
    let folder = folder_of_runs();
    let kept = fs::create_dir_all(&folder).and_then(|()| {
        let file = folder.join(run(std::os::unix::process::parent_id()).expect("the parent waits for this process"));
        // One write for each line, because processes of one run may append at the same time.
        fs::OpenOptions::new().create(true).append(true).open(file)?.write_all(format!("{line}\n").as_bytes())
    });
    if let Err(error) = kept {
        let _ = writeln!(std::io::stderr(), "this line will be missing from the list at the end: {error}");
    }
}

/// Returns what the children of the process `parent` have skipped, in alphabetical order. Deletes the list of these
/// children, and the lists of runs that have ended.
pub fn take_skipped(parent: u32) -> Vec<String> {
    let folder = folder_of_runs();
    let this = run(parent);
    let mut lines: Vec<String> = Vec::new();
    for entry in fs::read_dir(&folder).into_iter().flatten().flatten() {
        let name = entry.file_name().into_string().unwrap_or_default();
        if Some(&name) == this.as_ref() {
            lines.extend(fs::read_to_string(entry.path()).unwrap_or_default().lines().map(str::to_owned));
        } else if name.split_once('-').and_then(|(process, _)| run(process.parse().ok()?)) == Some(name) {
            continue;
        }
        let _ = fs::remove_file(entry.path());
    }
    lines.sort();
    lines.dedup();
    lines
}

fn folder_of_runs() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("skipped")
}

/// Identifies one run of the tests by the ID and the start time of its parent process, because process IDs are reused.
/// Returns `None` if there is no such process.
fn run(parent: u32) -> Option<String> {
    let stat = fs::read_to_string(format!("/proc/{parent}/stat")).ok()?;
    // The program's name is in parentheses and may contain any character. The state behind the name is field 3, and the
    // start time is field 22.
    let start = stat.rsplit_once(')')?.1.split_whitespace().nth(22 - 3)?;
    Some(format!("{parent}-{start}"))
}

//! Tests what `cargo test` skips and lists on a machine without the tools that the tests need, and what `tests/run`
//! installs there.

#[allow(dead_code)]
#[path = "../c/mod.rs"]
mod c;
mod installation;
mod list;
mod skipped;

use c::tools;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Output;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Allows one test at a time. A child that one test forks while another test writes a program inherits the open file,
/// and a program that is open for writing cannot be started. The tests also share the list of what was skipped.
fn turn() -> MutexGuard<'static, ()> {
    static TURN: Mutex<()> = Mutex::new(());
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The output and error texts of a program.
fn said(run: &Output) -> String {
    [&run.stdout, &run.stderr].map(|text| String::from_utf8_lossy(text)).concat()
}

/// Writes a shell script that can be started by its name.
fn write_program(folder: &Path, name: &str, script: &str) {
    let file = folder.join(name);
    fs::write(&file, format!("#!/bin/sh\n{script}\n")).expect("written");
    fs::set_permissions(file, fs::Permissions::from_mode(0o755)).expect("executable");
}

//! Starts processes that run this benchmark's own program, and occupies every core in one of them.

use crate::Failure;
use std::ffi::OsStr;
use std::hint::black_box;
use std::io::Read;
use std::process::{ChildStdout, Command, Stdio};

/// A child process that runs this program. The child ends when its standard input ends. That happens when the value is
/// dropped, or when the parent process dies.
pub struct Child(std::process::Child);

impl Child {
    pub fn start(arguments: &[&OsStr], figure: &str) -> Result<Self, Failure> {
        let mut command = Command::new(std::env::current_exe()?);
        command.arg(figure).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        Ok(Self(command.spawn()?))
    }

    /// Returns the standard output, once.
    pub fn output(&mut self) -> Result<ChildStdout, Failure> {
        self.0.stdout.take().ok_or_else(|| "the output is already taken".into())
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        drop(self.0.stdin.take());
        let _ = self.0.wait();
    }
}

/// Returns when standard input ends.
pub fn wait_for_end() {
    let mut rest = Vec::new();
    // An error is an end too.
    let _ = std::io::stdin().read_to_end(&mut rest);
}

/// Starts a process that occupies every core.
pub fn start() -> Result<Child, Failure> {
    Child::start(&[], "burn")
}

/// Occupies every core until standard input ends.
pub fn burn() -> Result<(), Failure> {
    for _ in 0..std::thread::available_parallelism()?.get() {
        std::thread::spawn(|| {
            let mut number = 1u64;
            loop {
                number = black_box(number.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1));
            }
        });
    }
    wait_for_end();
    Ok(())
}

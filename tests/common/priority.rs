//! The priority that simulated boards have in the library, for boards of the tests: a microcontroller does not wait for
//! compilers.

use std::os::unix::process::CommandExt;
use std::process::Command;

/// Below the servos.
const PRIORITY: libc::c_int = 20;

/// Runs the calling thread, and what it starts, before the rest of a busy machine, where that is permitted.
pub fn run_first() {
    let parameters = libc::sched_param { sched_priority: PRIORITY };
    // SAFETY: the parameters outlive the call.
    unsafe { libc::sched_setscheduler(0, libc::SCHED_FIFO, &parameters) };
}

/// Lets a program run first.
pub fn runs_first(command: &mut Command) -> &mut Command {
    let before_exec = || {
        run_first();
        Ok(())
    };
    // SAFETY: only a system call between fork and exec.
    unsafe { command.pre_exec(before_exec) }
}

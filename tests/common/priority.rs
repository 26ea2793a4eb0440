//! Gives the boards of the tests the priority that simulated boards have in the library: a real microcontroller does
//! not wait for compilers either.

use std::os::unix::process::CommandExt;
use std::process::Command;

/// Below the servos.
const PRIORITY: libc::c_int = 20;

/// Gives the calling thread and its children precedence on a busy machine, if that is permitted.
pub fn run_first() {
    let parameters = libc::sched_param { sched_priority: PRIORITY };
    // SAFETY: the parameters outlive the call.
    unsafe { libc::sched_setscheduler(0, libc::SCHED_FIFO, &parameters) };
}

/// Gives a program precedence.
pub fn runs_first(command: &mut Command) -> &mut Command {
    let before_exec = || {
        run_first();
        Ok(())
    };
    // SAFETY: makes only a system call between fork and exec.
    unsafe { command.pre_exec(before_exec) }
}

//! Gives the boards of the tests the priority that simulated boards have in the library. A busy computer then does not
//! delay these boards, as it does not delay a real microcontroller.

use std::os::unix::process::CommandExt;
use std::process::Command;

/// SCHED_FIFO priority. It is lower than the priority of the servos.
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
    // SAFETY: the closure makes only a system call between fork and exec.
    unsafe { command.pre_exec(before_exec) }
}

/// Keeps a program on one of the processors that it may use. The two threads of an emulator exchange every byte of the
/// line, which takes three times as long between two processors.
#[allow(dead_code)]
pub fn stays_on_processor(index: usize, command: &mut Command) -> &mut Command {
    let before_exec = move || {
        // SAFETY: all zeros are an empty set of processors, the sets outlive the calls, and the system writes no more
        // than the given size.
        unsafe {
            let mut allowed: libc::cpu_set_t = std::mem::zeroed();
            let mut chosen: libc::cpu_set_t = std::mem::zeroed();
            libc::sched_getaffinity(0, size_of_val(&allowed), &mut allowed);
            let count = usize::try_from(libc::CPU_COUNT(&allowed)).unwrap_or(0).max(1);
            let mut processors = (0..libc::CPU_SETSIZE as usize).filter(|&number| libc::CPU_ISSET(number, &allowed));
            if let Some(number) = processors.nth(index % count) {
                libc::CPU_SET(number, &mut chosen);
                libc::sched_setaffinity(0, size_of_val(&chosen), &chosen);
            }
        }
        Ok(())
    };
    // SAFETY: the closure makes only system calls between fork and exec.
    unsafe { command.pre_exec(before_exec) }
}

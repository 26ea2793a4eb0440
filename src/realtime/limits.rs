//! Remedies for cases in which the system refuses a thread, a descriptor or a pseudo-terminal: a limit has been
//! reached, a sandbox or the scheduling policy of the caller forbids the call, or pseudo-terminals are not available.
#![allow(unsafe_code, reason = "the scheduling policy of the calling thread")]

use std::ffi::c_int;
use std::io;

/// SCHED_DEADLINE, which has this value in every Linux.
const DEADLINE: c_int = 6;

/// The remedy for an error of a call that creates a thread, a descriptor or a pseudo-terminal. `None` if no remedy is
/// known for this error.
pub fn remedy(error: &io::Error) -> Option<&'static str> {
    // SAFETY: the call takes no pointer. 0 means the calling thread, whose call was refused.
    remedy_under(unsafe { libc::sched_getscheduler(0) }, error)
}

/// Does the same as [`remedy`] for a calling thread with this scheduling policy.
fn remedy_under(policy: c_int, error: &io::Error) -> Option<&'static str> {
    match error.raw_os_error()? {
        // `policy` has one more bit set if the thread has SCHED_FLAG_RESET_ON_FORK, and then it is not equal to
        // DEADLINE.
        libc::EAGAIN if policy == DEADLINE => Some(
            "the calling thread runs under SCHED_DEADLINE, and the system lets such a thread start others only with \
             SCHED_FLAG_RESET_ON_FORK: set that flag (sched_setattr), or make this call in an ordinary thread",
        ),
        libc::EMFILE => {
            Some("this process has reached its limit of open files: close files, or raise the limit (ulimit -n)")
        }
        libc::ENFILE => {
            Some("the system has reached its limit of open files: end other programs, or raise fs.file-max (sysctl)")
        }
        libc::EAGAIN => Some(
            "a limit of threads or memory has been reached: end other programs; raise the thread limit of the user \
             (ulimit -u), of the service or container (TasksMax, pids.max) or of the system (kernel.threads-max); or \
             raise the memory limits (ulimit -v; ulimit -l too if the program has called mlockall)",
        ),
        // Sandboxes refuse a system call with one of these two errors. The device rules of a container refuse it with
        // EPERM.
        libc::EPERM | libc::ENOSYS => Some(
            "a sandbox (seccomp) or a container forbids a necessary system call: permit it there (strace -f shows \
             which one), or run the program outside it",
        ),
        libc::ENOMEM => {
            Some("there is not enough free memory: end other programs, or raise the limit of this process (ulimit -v)")
        }
        _ => None,
    }
}

/// The text of a system error, followed by its remedy if [`remedy`] has one.
pub fn with_remedy(error: &io::Error) -> String {
    match remedy(error) {
        Some(remedy) => format!("{error}: {remedy}"),
        None => error.to_string(),
    }
}

/// The text of an error of a call that opens a pseudo-terminal, followed by its remedy if there is one.
pub fn with_terminal_remedy(error: &io::Error) -> String {
    match error.raw_os_error() {
        // ENOENT: /dev/ptmx or the terminal under /dev/pts is missing. ENODEV: nothing is mounted on /dev/pts. EACCES:
        // the mount has its default mode, so ordinary users cannot open /dev/pts/ptmx. EINVAL and ENOTTY: /dev/ptmx is
        // another device or a file.
        Some(libc::ENOENT | libc::ENODEV | libc::EACCES | libc::EINVAL | libc::ENOTTY) => format!(
            "{error}: pseudo-terminals are not available here. Mount them (mount -t devpts -o ptmxmode=666 devpts \
             /dev/pts) and make /dev/ptmx a link to /dev/pts/ptmx, or set `finger.port` to a real port"
        ),
        Some(libc::ENOSPC) => format!(
            "{error}: no pseudo-terminal is free: end programs that hold one, such as terminal windows, or raise \
             kernel.pty.max (sysctl)"
        ),
        _ => with_remedy(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_have_a_remedy_and_other_errors_have_none() {
        let text = |errno| with_remedy(&io::Error::from_raw_os_error(errno));
        for (errno, word) in [
            (libc::EMFILE, "ulimit -n"),
            (libc::ENFILE, "fs.file-max"),
            (libc::EAGAIN, "ulimit -u"),
            (libc::ENOMEM, "ulimit -v"),
            (libc::EPERM, "sandbox"),
            (libc::ENOSYS, "sandbox"),
        ] {
            assert!(text(errno).contains(word), "{}", text(errno));
        }
        let refused = io::Error::from_raw_os_error(libc::EAGAIN);
        for (policy, word) in [(DEADLINE, "SCHED_FLAG_RESET_ON_FORK"), (libc::SCHED_FIFO, "ulimit -u")] {
            assert!(remedy_under(policy, &refused).expect("a remedy").contains(word));
        }
        assert_eq!(text(libc::EACCES), "Permission denied (os error 13)");
        assert_eq!(with_remedy(&io::Error::other("no number")), "no number");
        // Files and shared memory can cause ENOSPC too. So only `with_terminal_remedy` explains it by pseudo-terminals.
        let no_space = io::Error::from_raw_os_error(libc::ENOSPC);
        assert_eq!(with_remedy(&no_space), no_space.to_string());
        assert!(with_terminal_remedy(&no_space).contains("kernel.pty.max"));
    }
}

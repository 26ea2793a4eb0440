//! Network namespaces. The threads and programs in a namespace have a network of their own, as on a separate computer.
#![allow(unsafe_code, reason = "namespaces are entered by system calls")]

use std::fs::File;
use std::io;
use std::os::fd::AsRawFd;
use std::process::Command;
use std::thread;

/// A network namespace. The kernel removes it when no thread, program or descriptor uses it any more.
pub struct Namespace(File);

impl Namespace {
    /// Makes a namespace with nothing but a loopback interface.
    ///
    /// # Errors
    /// Returns `PermissionDenied` if this process may not make one.
    pub fn new() -> io::Result<Self> {
        let made = thread::spawn(|| {
            // SAFETY: the call changes only the namespace of this thread, which ends soon.
            if unsafe { libc::unshare(libc::CLONE_NEWNET) } != 0 {
                return Err(io::Error::last_os_error());
            }
            ip(&["link", "set", "lo", "up"])?;
            File::open("/proc/thread-self/ns/net")
        });
        made.join().expect("the thread that makes a namespace").map(Self)
    }

    /// Runs a closure in a thread of this namespace, and returns its result. The threads and programs that it starts
    /// are in this namespace too.
    pub fn run<Returned: Send>(&self, closure: impl FnOnce() -> Returned + Send) -> Returned {
        thread::scope(|scope| {
            let thread = scope.spawn(|| {
                // SAFETY: the call changes only the namespace of this thread.
                let entered = unsafe { libc::setns(self.0.as_raw_fd(), libc::CLONE_NEWNET) };
                assert_eq!(entered, 0, "enter a namespace: {}", io::Error::last_os_error());
                closure()
            });
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    }
}

/// Runs the program `ip` in the namespace of this thread.
///
/// # Errors
/// Returns an error with what the program said.
pub fn ip(arguments: &[&str]) -> io::Result<()> {
    let run = Command::new("ip").args(arguments).output()?;
    if run.status.success() {
        return Ok(());
    }
    Err(io::Error::other(format!("ip {arguments:?}: {}", String::from_utf8_lossy(&run.stderr))))
}

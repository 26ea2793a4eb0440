//! The cores on which this process may run.

use std::io;

/// Returns the numbers of the cores on which the calling thread may run: its affinity, which taskset and cpusets limit.
pub fn permitted() -> io::Result<Vec<usize>> {
    // SAFETY: a cpu_set_t is plain bits, and all zeros is the empty set. The kernel writes at most the given size.
    let (set, refused) = unsafe {
        let mut set: libc::cpu_set_t = std::mem::zeroed();
        let refused = libc::sched_getaffinity(0, size_of::<libc::cpu_set_t>(), &mut set);
        (set, refused)
    };
    if refused != 0 {
        return Err(io::Error::last_os_error());
    }
    // SAFETY: every number is within the set.
    Ok((0..libc::CPU_SETSIZE as usize).filter(|&core| unsafe { libc::CPU_ISSET(core, &set) }).collect())
}

//! The cores on which the calling thread may run.

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
        let error = io::Error::last_os_error();
        let most = libc::CPU_SETSIZE;
        let text = format!(
            "cannot read on which cores this thread may run: {error}. If this machine has more than {most} cores, \
             start Linux with the boot option nr_cpus={most}. Otherwise permit the system call sched_getaffinity"
        );
        return Err(io::Error::new(error.kind(), text));
    }
    // SAFETY: every number is within the set.
    Ok((0..libc::CPU_SETSIZE as usize).filter(|&core| unsafe { libc::CPU_ISSET(core, &set) }).collect())
}

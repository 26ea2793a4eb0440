//! What a process uses, as the kernel counts it.

use std::fs;

/// The resources of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resources {
    pub threads: usize,
    pub descriptors: usize,
    /// Resident memory that belongs to no file, kB.
    pub memory: u64,
}

impl Resources {
    /// Returns what a process uses now.
    pub fn of(process: u32) -> Self {
        let entries = |name: &str| fs::read_dir(format!("/proc/{process}/{name}")).expect("the process runs").count();
        let status = fs::read_to_string(format!("/proc/{process}/status")).expect("the process runs");
        let anonymous = status.lines().find_map(|line| line.strip_prefix("RssAnon:")).expect("a line of memory");
        let memory = anonymous.trim().trim_end_matches(" kB").parse().expect("a number");
        Self { threads: entries("task"), descriptors: entries("fd"), memory }
    }
}

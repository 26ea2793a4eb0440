//! The permissions that a hand's servo threads lack for running in real time.

use crate::realtime::RealtimeRefusals;
use std::io;
use thiserror::Error;

/// A permission that a servo thread needs and does not have. The texts name the remedy.
#[derive(Debug, Error)]
pub enum MissingPermission {
    /// The permission to run under SCHED_FIFO.
    #[error("the servo cannot run under SCHED_FIFO ({0}): grant CAP_SYS_NICE or raise the rtprio limit (ulimit -r)")]
    Scheduling(io::Error),
    /// The permission to lock memory.
    #[error(
        "the servo's memory cannot be locked ({0}): grant CAP_IPC_LOCK or raise the memlock limit to 16 MiB (ulimit -l)"
    )]
    Memory(io::Error),
    /// The permission to run on the configured core.
    #[error(
        "the servo cannot run on its core ({0}): set `finger.core` to a core that this process may use (taskset -cp $$)"
    )]
    Core(io::Error),
}

impl MissingPermission {
    /// The errno of the system's refusal.
    pub fn errno(&self) -> i32 {
        let (Self::Scheduling(source) | Self::Memory(source) | Self::Core(source)) = self;
        source.raw_os_error().unwrap_or(libc::EIO)
    }
}

/// The permissions that at least one of the threads lacks, at most one of each kind.
pub fn missing_permissions(refusals: Vec<RealtimeRefusals>) -> Vec<MissingPermission> {
    let (mut scheduling, mut memory, mut core) = (None, None, None);
    for refused in refusals {
        scheduling = scheduling.or(refused.scheduling);
        memory = memory.or(refused.memory);
        core = core.or(refused.core);
    }
    let kinds = [
        scheduling.map(MissingPermission::Scheduling),
        memory.map(MissingPermission::Memory),
        core.map(MissingPermission::Core),
    ];
    kinds.into_iter().flatten().collect()
}

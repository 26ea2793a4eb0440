//! The thread that collects timings and records from the servos, so that nothing is lost while no planner calls. When a
//! finger faults and a folder is configured, this thread starts another one that writes the finger's black box. The
//! collecting thread also publishes what it collects to readers of telemetry. While the planner runs, the collecting
//! thread allocates memory only for a black box and when a reader attaches, so that the hand keeps working if the
//! planner is out of memory.

use crate::finger::Recording;
use crate::hand::black_box_file::save_at_fault;
use crate::hand::dispatcher::collected::Collected;
use crate::hand::dispatcher::publishing::Publishing;
use crate::realtime::{Mutex, PlannerWatch, Priority, Severity, is_memory_free, report, spawn};
use crossbeam_channel::{Receiver, RecvTimeoutError};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

/// Interval at which timings and black boxes are collected. The rings of a servo hold many times what arrives in one
/// interval.
const COLLECTING_INTERVAL: Duration = Duration::from_millis(50);

/// Memory for a copy of a black box and the thread that writes it, bytes.
const MEMORY_OF_BLACK_BOX: usize = 4 << 20;

/// Runs until `stopped` is disconnected. Black boxes are written into `folder`, if there is one. What is collected is
/// published, if `publishing` is given and has a reader.
pub(super) fn collect(
    fingers: &[Mutex<Collected>],
    folder: Option<&Path>,
    mut publishing: Option<Publishing>,
    stopped: &Receiver<()>,
) {
    if folder.is_some() {
        // A finger may recover before this thread has seen its fault. The records after a fault therefore wait until
        // this thread has written the recording.
        fingers.iter().for_each(|collected| collected.lock().black_box.wait_at_faults());
    }
    let mut ended = false;
    let mut writing = Vec::new();
    let mut planner = PlannerWatch::default();
    while !ended {
        // The loop runs once more after `stopped` is disconnected, because a finger may just have faulted.
        ended = stopped.recv_timeout(COLLECTING_INTERVAL) != Err(RecvTimeoutError::Timeout);
        planner.check();
        for collected in fingers {
            let mut collected = collected.lock();
            collected.collect();
            let Some(folder) = folder.filter(|_| collected.black_box.faulted()) else { continue };
            if !is_memory_free(MEMORY_OF_BLACK_BOX) {
                // The report may call a function of the program, which may wait for a call that needs the lock.
                drop(collected);
                report(
                    Severity::Warning,
                    "a finger faulted, but its black box was not written, because there is not enough free memory: end \
                     other programs, or raise the memory limit of this process (ulimit -v). Then request the black \
                     box of the finger before you recover it",
                );
                continue;
            }
            let recording = collected.black_box.recording();
            drop(collected);
            // The memory of a thread that has ended is free only when nobody can join the thread any more.
            writing.retain(|thread: &JoinHandle<()>| !thread.is_finished());
            writing.extend(recording.and_then(|recording| write(recording, folder.to_path_buf())));
        }
        publishing.iter_mut().for_each(|publishing| publishing.publish(fingers));
    }
    for thread in writing {
        // A panic in such a thread loses only its file.
        let _ = thread.join();
    }
}

/// Writes a black box in a separate thread. A disk may take so long to confirm a file that the rings of the other
/// fingers would overflow.
fn write(recording: Recording, folder: PathBuf) -> Option<JoinHandle<()>> {
    let shared = Arc::new((recording, folder));
    let for_thread = shared.clone();
    match spawn("sun2xp writer", Priority::default(), move |_| save_at_fault(&for_thread.0, &for_thread.1)) {
        Ok(thread) => Some(thread),
        Err(_) => {
            save_at_fault(&shared.0, &shared.1);
            None
        }
    }
}

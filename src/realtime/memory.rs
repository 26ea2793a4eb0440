//! Locking of the memory that a real-time thread uses, so that it has no page faults.
//!
//! A library must not call `mlockall`. With MCL_FUTURE, later allocations of the planner would fail as soon as its
//! memory exceeds its memlock limit.
#![allow(unsafe_code, reason = "locks of pages")]

use super::pages::{Pages, SharedPages};
use std::io;
use std::ops::Range;

/// Memory ranges that are locked together.
///
/// Each range consists of whole pages that hold one value and nothing else. It stays locked until that value is
/// dropped. Locks do not nest: in a page shared with the planner's data, unlocking would also unlock the planner's
/// data.
#[derive(Clone, Debug, Default)]
pub struct LockedMemory(Vec<Range<usize>>);

impl LockedMemory {
    /// Adds the pages of a value. Memory that the value owns elsewhere is not included.
    pub fn add<T: ?Sized>(&mut self, pages: &Pages<T>) {
        self.0.push(pages.range());
    }

    /// Adds the pages of a value with several owners. They are unlocked when the last owner drops it.
    pub fn add_shared<T: ?Sized>(&mut self, pages: &SharedPages<T>) {
        self.0.push(pages.range());
    }

    /// Adds all ranges of `other`.
    pub fn append(&mut self, other: &LockedMemory) {
        self.0.extend_from_slice(&other.0);
    }

    /// Returns the ranges. Each is mapped as long as its value exists. A range occurs several times if several fingers
    /// have added the same shared value.
    pub fn ranges(&self) -> &[Range<usize>] {
        &self.0
    }

    /// Loads the pages of every range into memory, and locks them.
    ///
    /// # Errors
    /// Returns the system's error: EPERM if the process may not lock memory, ENOMEM if the memory exceeds the memlock
    /// limit. Some ranges may be locked already.
    pub fn lock(&self) -> io::Result<()> {
        self.0.iter().try_for_each(lock)
    }
}

/// Whether the planner has locked all future pages (mlockall with MCL_FUTURE). In that case a servo thread does not
/// unlock its stack when it ends. If the system has no page for the test, the answer is yes: a stack that stays locked
/// does less harm than the loss of a lock of the planner.
pub(super) fn every_page_is_locked() -> bool {
    let Some(new) = Pages::try_new(0u8) else { return true };
    let place = new.range();
    // SAFETY: the page holds only `new`, which is not used any more. The system refuses MADV_DONTNEED for a locked
    // page.
    let dropped =
        unsafe { libc::madvise(std::ptr::without_provenance_mut(place.start), place.len(), libc::MADV_DONTNEED) };
    dropped != 0
}

fn lock(place: &Range<usize>) -> io::Result<()> {
    // SAFETY: locking does not change the contents. The system refuses a range that is not mapped.
    let refused = unsafe { libc::mlock(std::ptr::without_provenance(place.start), place.len()) };
    if refused == 0 { Ok(()) } else { Err(io::Error::last_os_error()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// VmLck of this process, kB.
    fn locked_kilobytes() -> u64 {
        let status = std::fs::read_to_string("/proc/self/status").expect("readable");
        let line = status.lines().find_map(|line| line.strip_prefix("VmLck:")).expect("VmLck");
        line.trim().trim_end_matches(" kB").parse().expect("a number")
    }

    #[test]
    fn added_ranges_are_locked_until_their_values_are_dropped() {
        let room = Pages::new([0u8; 1 << 20]);
        let mut memory = LockedMemory::default();
        memory.add(&room);
        let before = locked_kilobytes();
        memory.lock().expect("one mebibyte is within the limit of locked memory (ulimit -l)");
        // No other test of this process locks or unlocks.
        assert_eq!(locked_kilobytes(), before + 1024);
        drop(room);
        assert_eq!(locked_kilobytes(), before);
    }

    #[test]
    fn a_range_that_is_not_mapped_is_refused() {
        assert!(LockedMemory(vec![Range { start: 4096, end: 8192 }]).lock().is_err());
    }
}

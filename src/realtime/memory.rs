//! Memory that a thread touches in real time: there before the first period, and kept from being taken away.
//!
//! `mlockall` is not for a library: with MCL_FUTURE every later allocation of a planner with a small memlock limit
//! would fail.
#![allow(unsafe_code, reason = "locks of pages")]

use super::pages::{Pages, SharedPages};
use std::io;
use std::ops::Range;

/// Places in memory, to be locked together.
///
/// Each has pages of its own, and stays locked until the value is dropped. Locks do not nest: what shared a page with
/// the planner's data could not be unlocked without unlocking those.
#[derive(Clone, Debug, Default)]
pub struct LockedMemory(Vec<Range<usize>>);

impl LockedMemory {
    /// Adds the pages of a value. What that owns elsewhere is not in them.
    pub fn add<T: ?Sized>(&mut self, pages: &Pages<T>) {
        self.0.push(pages.range());
    }

    /// The same for a value with several owners. It is unlocked when the last one is gone.
    pub fn add_shared<T: ?Sized>(&mut self, pages: &SharedPages<T>) {
        self.0.push(pages.range());
    }

    /// Adds all places of another.
    pub fn append(&mut self, other: &LockedMemory) {
        self.0.extend_from_slice(&other.0);
    }

    /// Faults the pages of every place in and locks them.
    ///
    /// # Errors
    /// What the system says: EPERM without any right to lock, ENOMEM beyond the memlock limit. Some may be locked then.
    pub fn lock(&self) -> io::Result<()> {
        self.0.iter().try_for_each(lock)
    }
}

/// Whether the planner has every page locked that comes (mlockall with MCL_FUTURE).
pub(super) fn every_page_is_locked() -> bool {
    let new = Pages::new(0u8);
    let place = new.range();
    // SAFETY: the page of a value that is not used any more. The system refuses to drop the contents of a locked page.
    let dropped =
        unsafe { libc::madvise(std::ptr::without_provenance_mut(place.start), place.len(), libc::MADV_DONTNEED) };
    dropped != 0
}

fn lock(place: &Range<usize>) -> io::Result<()> {
    // SAFETY: locking changes no contents; a place that is not mapped is refused.
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
    fn what_was_added_is_locked_until_it_is_dropped() {
        let room = Pages::new([0u8; 1 << 20]);
        let mut memory = LockedMemory::default();
        memory.add(&room);
        let before = locked_kilobytes();
        memory.lock().expect("a mebibyte is within every usual limit");
        // No other test of this process locks or unlocks.
        assert_eq!(locked_kilobytes(), before + 1024);
        drop(room);
        assert_eq!(locked_kilobytes(), before);
    }

    #[test]
    fn what_is_not_mapped_is_refused() {
        assert!(LockedMemory(vec![Range { start: 4096, end: 8192 }]).lock().is_err());
    }
}

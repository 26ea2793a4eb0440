//! Memory that a thread touches in real time: there before the first period, and kept from being taken away.
//!
//! `mlockall` is not for a library: with MCL_FUTURE every later allocation of a planner with a small memlock limit would fail.
#![allow(unsafe_code)]

use std::io;
use std::ops::Range;

/// Places in memory, to be locked together.
///
/// They stay locked as long as they are mapped. Locks do not nest, and what a page holds besides may be the planner's, who may have
/// locked it too: to unlock it would be to unlock that.
#[derive(Clone, Debug, Default)]
pub struct Memory(Vec<Range<usize>>);

impl Memory {
    /// Adds what `place` refers to. What that owns on the heap is not in it.
    pub fn add<T: ?Sized>(&mut self, place: &T) {
        let start = std::ptr::from_ref(place).addr();
        self.0.push(start..start + size_of_val(place));
    }

    /// Adds all places of another.
    pub fn append(&mut self, other: &Memory) {
        self.0.extend_from_slice(&other.0);
    }

    /// Faults the pages of every place in and locks them.
    ///
    /// # Errors
    /// What the system says: EPERM without any right to lock, ENOMEM beyond the memlock limit. Some may be locked then.
    pub fn lock(&self) -> io::Result<()> {
        self.0.iter().filter(|place| !place.is_empty()).try_for_each(lock)
    }
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
    fn what_was_added_is_locked() {
        let room = vec![0u8; 1 << 20];
        let mut memory = Memory::default();
        memory.add(&room[..]);
        memory.add(&[0u8; 0]);
        memory.lock().expect("a mebibyte is within every usual limit");
        // Other tests lock too, but none unlocks.
        assert!(locked_kilobytes() >= 1024);
    }

    #[test]
    fn what_is_not_mapped_is_refused() {
        assert!(Memory(vec![Range { start: 4096, end: 8192 }]).lock().is_err());
    }
}

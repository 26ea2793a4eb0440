//! The memory that a hand shares with its readers: an anonymous file, which the system removes when no process uses it
//! any more.
#![allow(unsafe_code, reason = "memory is mapped and passed to other processes")]

use crate::board::descriptor::{Descriptor, check};
use crate::realtime::atomics::AtomicU64;
use std::io;
use std::ptr::NonNull;

/// The seals of the file: it keeps its size, and a mapping that is made later cannot be written.
const SEALS: libc::c_int = libc::F_SEAL_SHRINK | libc::F_SEAL_GROW | libc::F_SEAL_FUTURE_WRITE | libc::F_SEAL_SEAL;

/// A mapping of a memory file.
pub(super) struct Mapping {
    start: NonNull<AtomicU64>,
    words: usize,
    /// The process that has the mapping. A forked child does not have it.
    process: u32,
}

// SAFETY: the mapping consists of atomic words, and stays mapped as long as this value exists.
unsafe impl Send for Mapping {}
// SAFETY: as above.
unsafe impl Sync for Mapping {}

impl Mapping {
    fn new(file: &Descriptor, words: usize, protection: libc::c_int) -> io::Result<Self> {
        let bytes = words * size_of::<AtomicU64>();
        // SAFETY: the mapping is new, and the system chooses its address.
        let start = unsafe { libc::mmap(std::ptr::null_mut(), bytes, protection, libc::MAP_SHARED, file.number(), 0) };
        if start == libc::MAP_FAILED {
            return Err(io::Error::last_os_error());
        }
        let Some(start) = NonNull::new(start.cast::<AtomicU64>()) else {
            return Err(io::ErrorKind::AddrNotAvailable.into());
        };
        // A forked child of a planner must not be able to write into the readers' memory.
        // SAFETY: the range is the new mapping. A refusal changes nothing.
        unsafe { libc::madvise(start.as_ptr().cast(), bytes, libc::MADV_DONTFORK) };
        Ok(Self { start, words, process: std::process::id() })
    }
}

impl AsRef<[AtomicU64]> for Mapping {
    fn as_ref(&self) -> &[AtomicU64] {
        // SAFETY: the mapping has this number of words. It cannot shrink, because the file is sealed. This library
        // accesses the words only atomically. Another program might not do so, so every value is checked before it is
        // used.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.words) }
    }
}

impl Drop for Mapping {
    fn drop(&mut self) {
        if self.process == std::process::id() {
            // SAFETY: nothing refers to this mapping any more.
            unsafe { libc::munmap(self.start.as_ptr().cast(), self.words * size_of::<AtomicU64>()) };
        }
    }
}

/// Creates a file with this number of words, which are 0, and maps it. The result is the only mapping that can be
/// written.
///
/// # Errors
/// Returns the error that the system reports, for example if there is not enough memory.
pub(super) fn create(words: usize) -> io::Result<(Descriptor, Mapping)> {
    let name = c"sun2xp telemetry";
    let flags = libc::MFD_CLOEXEC | libc::MFD_ALLOW_SEALING;
    // SAFETY: the name is a C string.
    let file = Descriptor::opened(unsafe { libc::memfd_create(name.as_ptr(), flags) })?;
    let bytes = libc::off_t::try_from(words * size_of::<AtomicU64>()).map_err(io::Error::other)?;
    // The memory is taken now. If it were taken at the first write and none were free, the system would send SIGBUS.
    // SAFETY: the descriptor is open, and the arguments are numbers.
    check(unsafe { libc::ftruncate(file.number(), bytes) })?;
    // SAFETY: as above.
    check(unsafe { libc::fallocate(file.number(), 0, 0, bytes) })?;
    let mapping = Mapping::new(&file, words, libc::PROT_READ | libc::PROT_WRITE)?;
    // SAFETY: as above.
    check(unsafe { libc::fcntl(file.number(), libc::F_ADD_SEALS, SEALS) })?;
    Ok((file, mapping))
}

/// Maps a file that another process has created, for reading.
///
/// # Errors
/// Returns an error if the file has another size, or lacks a seal that [`create`] gives it. Reading a file that another
/// process can shrink could end this process.
pub(super) fn open(file: &Descriptor, words: usize) -> io::Result<Mapping> {
    let foreign = || io::Error::new(io::ErrorKind::InvalidData, "the memory file has a wrong size or wrong seals");
    // SAFETY: the descriptor is open, and the command takes no argument.
    let seals = check(unsafe { libc::fcntl(file.number(), libc::F_GET_SEALS) })?;
    // SAFETY: all zeros are a valid value of this plain structure.
    let mut status: libc::stat = unsafe { std::mem::zeroed() };
    // SAFETY: `status` is writable.
    check(unsafe { libc::fstat(file.number(), &mut status) })?;
    let bytes = words.checked_mul(size_of::<AtomicU64>()).ok_or_else(foreign)?;
    if seals & SEALS != SEALS || u64::try_from(status.st_size).ok() != u64::try_from(bytes).ok() {
        return Err(foreign());
    }
    Mapping::new(file, words, libc::PROT_READ)
}

//! Distinguishes the process that has opened a hand from the children forked from it.

use std::sync::atomic::{AtomicPtr, AtomicU8, Ordering};

/// Value of the mark in a process that is not a forked child. In a forked child the mark is 0.
const OWN: u8 = 1;

static BEFORE_OPENING: AtomicU8 = AtomicU8::new(OWN);
static IN_CHILD: AtomicU8 = AtomicU8::new(0);

/// Points to the mark of this process. The first call that opens a hand moves the mark to a byte that the system sets
/// to 0 in every child with a memory of its own, before any handler of pthread_atfork runs. The system does so whether
/// fork, _Fork or a raw system call has created the child. Reading the mark takes 1 ns; a comparison of process numbers
/// takes 200 ns.
static MARK: AtomicPtr<AtomicU8> = AtomicPtr::new((&raw const BEFORE_OPENING).cast_mut());

/// Whether this process was forked from a process that has opened a hand, or has tried to open one.
pub(super) fn is_forked_child() -> bool {
    // SAFETY: the atomic exists as long as the process, and nothing writes to it after it was published.
    let mark = unsafe { &*MARK.load(Ordering::Acquire) };
    mark.load(Ordering::Relaxed) != OWN
}

/// Marks this process. The caller must call this function only once. Linux before 4.14 has no MADV_WIPEONFORK: there
/// only the handler of pthread_atfork marks a child.
pub(super) fn mark_this_process() {
    let protection = libc::PROT_READ | libc::PROT_WRITE;
    // SAFETY: the mapping is new. The system rounds its size up to a page. A published mark is never unmapped.
    let page =
        unsafe { libc::mmap(std::ptr::null_mut(), 1, protection, libc::MAP_PRIVATE | libc::MAP_ANONYMOUS, -1, 0) };
    if page == libc::MAP_FAILED {
        return;
    }
    // SAFETY: the address is that of the mapping.
    if unsafe { libc::madvise(page, 1, libc::MADV_WIPEONFORK) } != 0 {
        // SAFETY: nothing refers to the mapping.
        unsafe { libc::munmap(page, 1) };
        return;
    }
    let mark = page.cast::<AtomicU8>();
    // SAFETY: the mapping has room for a byte, and zero is a valid atomic.
    unsafe { &*mark }.store(OWN, Ordering::Relaxed);
    MARK.store(mark, Ordering::Release);
}

/// Treats this process as a forked child from now on.
pub(super) fn mark_forked_child() {
    MARK.store((&raw const IN_CHILD).cast_mut(), Ordering::Release);
}

//! Stores values in memory pages of their own, so that the pages can be locked. A lock acts on whole pages. If a value
//! were in a page of the heap, locking the value would also lock the planner's data in that page. Unlocking the value
//! would also unlock data that the planner has locked. Dropping a value of this module unmaps its pages, which unlocks
//! them.
#![allow(unsafe_code, reason = "pages are mapped and unmapped")]

use std::alloc::{Layout, handle_alloc_error};
use std::ops::{Deref, DerefMut, Range};
use std::ptr::NonNull;
use std::sync::Arc;

/// A value, or a slice of values, in pages of its own. All pages are present from the beginning, so that no access
/// causes a page fault.
pub struct Pages<T: ?Sized> {
    place: NonNull<T>,
    mapping: Mapping,
}

/// [`Pages`] with several owners. The reference count is on the heap, in a page that is not locked. An access to the
/// value does not touch that page.
pub struct SharedPages<T: ?Sized> {
    place: NonNull<T>,
    owner: Arc<Pages<T>>,
}

// SAFETY: `Pages` owns its value as a `Box` does.
unsafe impl<T: ?Sized + Send> Send for Pages<T> {}
// SAFETY: `Pages` owns its value as a `Box` does.
unsafe impl<T: ?Sized + Sync> Sync for Pages<T> {}
// SAFETY: `SharedPages` shares its value as an `Arc` does.
unsafe impl<T: ?Sized + Send + Sync> Send for SharedPages<T> {}
// SAFETY: `SharedPages` shares its value as an `Arc` does.
unsafe impl<T: ?Sized + Send + Sync> Sync for SharedPages<T> {}

impl<T> Pages<T> {
    /// Moves a value into pages of its own.
    pub fn new(value: T) -> Self {
        Self::try_new(value).unwrap_or_else(|| handle_alloc_error(Layout::new::<T>()))
    }

    /// Does the same as [`Pages::new`], but returns none if the system has no memory.
    pub(super) fn try_new(value: T) -> Option<Self> {
        let mapping = Mapping::new(Layout::new::<T>())?;
        let place = mapping.start.cast();
        // SAFETY: the mapping has room for the value and is empty.
        unsafe { place.write(value) };
        Some(Self { place, mapping })
    }
}

impl<T> Pages<[T]> {
    /// Creates a slice of `count` values in pages of its own. `make(index)` returns the value at `index`.
    pub fn from_fn(count: usize, mut make: impl FnMut(usize) -> T) -> Self {
        let mapping = Mapping::for_many::<T>(count);
        let first: NonNull<T> = mapping.start.cast();
        // If `make` panics, the earlier values are not dropped, but their pages are unmapped.
        for index in 0..count {
            // SAFETY: the mapping has room for `count` values, and this place is empty.
            unsafe { first.add(index).write(make(index)) };
        }
        Self { place: NonNull::slice_from_raw_parts(first, count), mapping }
    }
}

impl<T> From<Vec<T>> for Pages<[T]> {
    fn from(mut values: Vec<T>) -> Self {
        let count = values.len();
        let mapping = Mapping::for_many::<T>(count);
        let first: NonNull<T> = mapping.start.cast();
        // SAFETY: the mapping has room for `count` values and is empty. After `set_len` the vector owns none of them.
        unsafe {
            first.copy_from_nonoverlapping(NonNull::from(&mut values[..]).cast(), count);
            values.set_len(0);
        }
        Self { place: NonNull::slice_from_raw_parts(first, count), mapping }
    }
}

impl<T: ?Sized> Pages<T> {
    /// The addresses of the pages.
    pub(super) fn range(&self) -> Range<usize> {
        let start = self.mapping.start.addr().get();
        start..start + self.mapping.bytes
    }
}

impl<T: ?Sized> Deref for Pages<T> {
    type Target = T;

    fn deref(&self) -> &T {
        // SAFETY: the value lives as long as this owner, which the returned reference borrows.
        unsafe { self.place.as_ref() }
    }
}

impl<T: ?Sized> DerefMut for Pages<T> {
    fn deref_mut(&mut self) -> &mut T {
        // SAFETY: the value lives as long as this owner, which the returned reference borrows mutably.
        unsafe { self.place.as_mut() }
    }
}

impl<T: ?Sized> Drop for Pages<T> {
    fn drop(&mut self) {
        // SAFETY: the value exists and is not used again. Its mapping is dropped after it.
        unsafe { self.place.drop_in_place() };
    }
}

impl<T: ?Sized> SharedPages<T> {
    /// Whether this is the only owner.
    pub(super) fn is_alone(&self) -> bool {
        Arc::strong_count(&self.owner) == 1
    }

    /// The addresses of the pages.
    pub(super) fn range(&self) -> Range<usize> {
        self.owner.range()
    }
}

impl<T: ?Sized> From<Pages<T>> for SharedPages<T> {
    fn from(pages: Pages<T>) -> Self {
        Self { place: pages.place, owner: Arc::new(pages) }
    }
}

impl<T: ?Sized> Clone for SharedPages<T> {
    fn clone(&self) -> Self {
        Self { place: self.place, owner: self.owner.clone() }
    }
}

impl<T: ?Sized> Deref for SharedPages<T> {
    type Target = T;

    fn deref(&self) -> &T {
        // SAFETY: the owner keeps the value alive, and there is no mutable reference to it.
        unsafe { self.place.as_ref() }
    }
}

/// A mapping of anonymous pages.
struct Mapping {
    start: NonNull<u8>,
    bytes: usize,
}

impl Mapping {
    fn for_many<T>(count: usize) -> Self {
        let layout = Layout::array::<T>(count).unwrap_or_else(|_| handle_alloc_error(Layout::new::<T>()));
        Self::new(layout).unwrap_or_else(|| handle_alloc_error(layout))
    }

    /// Maps enough pages for a value of this layout. MAP_POPULATE makes every page present. Returns none if the system
    /// has no memory.
    fn new(layout: Layout) -> Option<Self> {
        let bytes = layout.size().max(1).next_multiple_of(page_size());
        assert!(layout.align() <= page_size(), "the alignment of a value must not exceed the page size");
        let protection = libc::PROT_READ | libc::PROT_WRITE;
        let kind = libc::MAP_PRIVATE | libc::MAP_ANONYMOUS | libc::MAP_POPULATE;
        // SAFETY: the mapping is new, and the system chooses its address.
        let start = unsafe { libc::mmap(std::ptr::null_mut(), bytes, protection, kind, -1, 0) };
        let start = NonNull::new(start.cast()).filter(|_| start != libc::MAP_FAILED)?;
        Some(Self { start, bytes })
    }
}

impl Drop for Mapping {
    fn drop(&mut self) {
        // SAFETY: nothing refers to this mapping any more.
        unsafe { libc::munmap(self.start.as_ptr().cast(), self.bytes) };
    }
}

fn page_size() -> usize {
    // SAFETY: the call takes no pointer. Every system has a page size.
    usize::try_from(unsafe { libc::sysconf(libc::_SC_PAGESIZE) }).unwrap_or(4096)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::rc::Rc;

    #[test]
    fn values_are_dropped_with_their_pages() {
        let witness = Rc::new(());
        let one = Pages::new(witness.clone());
        let several: Pages<[Rc<()>]> = vec![witness.clone(); 1000].into();
        assert_eq!((several.len(), Rc::strong_count(&one)), (1000, 1002));
        drop((one, several));
        assert_eq!(Rc::strong_count(&witness), 1);
    }

    #[test]
    fn pages_are_shared_until_the_last_owner_goes() {
        let first: SharedPages<[usize]> = Pages::from_fn(3, |index| 10 * index).into();
        let second = first.clone();
        assert!(!first.is_alone());
        assert_eq!(first.range(), second.range());
        drop(first);
        assert!(second.is_alone());
        assert_eq!(*second, [0, 10, 20]);
    }

    #[test]
    fn an_empty_slice_has_pages_too() {
        let nothing: Pages<[u64]> = Vec::new().into();
        assert!(nothing.is_empty() && nothing.range().len() == page_size());
    }
}

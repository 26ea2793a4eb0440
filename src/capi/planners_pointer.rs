//! Pointers of the planner that the library only passes back.

use std::ffi::c_void;

/// The argument that a planner wants back in a callback.
#[derive(Clone, Copy)]
pub(super) struct PlannersPointer(pub *mut c_void);

// SAFETY: the library does not access what the pointer points to.
unsafe impl Send for PlannersPointer {}

// SAFETY: as above.
unsafe impl Sync for PlannersPointer {}

//! Access to the memory of the caller.

use crate::capi::refusal::{Refusal, Wanted};

pub(super) fn non_null<T>(pointer: *const T, name: &'static str, wanted: Wanted) -> Result<(), Refusal> {
    if pointer.is_null() { Err(Refusal::Null { name, wanted }) } else { Ok(()) }
}

/// Copies an array of the caller. It may be unaligned, because a planner may keep it in a packed message.
///
/// # Safety
/// `array` is null or points to `N` entries.
pub(super) unsafe fn load<T, const N: usize>(array: *const T, name: &'static str) -> Result<[T; N], Refusal> {
    non_null(array, name, Wanted::Array(N))?;
    // SAFETY: `array` is not null, as checked above, and by the contract of this function it has `N` entries.
    Ok(unsafe { array.cast::<[T; N]>().read_unaligned() })
}

/// Copies a matrix of the caller in row-major order. Like the array of [`load`], it may be unaligned.
///
/// # Safety
/// `matrix` is null or points to three rows of three entries.
pub(super) unsafe fn load_rows<T>(matrix: *const T, name: &'static str) -> Result<[[T; 3]; 3], Refusal> {
    non_null(matrix, name, Wanted::Array(9))?;
    // SAFETY: `matrix` is not null, as checked above, and by the contract of this function it has nine entries.
    Ok(unsafe { matrix.cast::<[[T; 3]; 3]>().read_unaligned() })
}

/// Refuses a null pointer. Otherwise writes the values that `read` returns into the caller's array.
///
/// # Safety
/// `array` is null or has room for `N` entries.
pub(super) unsafe fn store<T, const N: usize>(
    array: *mut T,
    name: &'static str,
    read: impl FnOnce() -> Result<[T; N], Refusal>,
) -> Result<(), Refusal> {
    non_null(array, name, Wanted::Array(N))?;
    let values = read()?;
    // SAFETY: `array` is not null, as checked above, and by the contract of this function it has room.
    unsafe { array.cast::<[T; N]>().write_unaligned(values) };
    Ok(())
}

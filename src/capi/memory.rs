//! Access to the memory of the caller.

use crate::capi::default_hand;
use crate::capi::refusal::{Refusal, Wanted};
use crate::hand::{Hand, HandError};
use std::any::type_name;
use std::ffi::c_uint;

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

/// Copies a matrix of the caller, row by row, as [`load`] copies an array.
///
/// # Safety
/// `matrix` is null or points to three rows of three entries.
pub(super) unsafe fn load_rows<T>(matrix: *const T, name: &'static str) -> Result<[[T; 3]; 3], Refusal> {
    non_null(matrix, name, Wanted::Array(9))?;
    // SAFETY: `matrix` is not null, as checked above, and by the contract of this function it has nine entries.
    Ok(unsafe { matrix.cast::<[[T; 3]; 3]>().read_unaligned() })
}

/// Size of a struct up to and including a member. If the member is the last one of the struct's first version, this is
/// the size of that version. No program was compiled with a smaller struct.
macro_rules! size_up_to {
    ($Struct:ty, $Member:ident: $Type:ty) => {
        std::mem::offset_of!($Struct, $Member) + size_of::<$Type>()
    };
}
pub(super) use size_up_to;

/// Fills a struct of the caller with values of the open hand. The first member, Size, gives the number of bytes that
/// the caller has. The function writes at most this number, and sets Size to the number of bytes written. `least` is
/// the smallest accepted Size; see [`size_up_to`].
///
/// # Safety
/// `T` is `repr(C)` and begins with a Size of type `c_uint`. `out` is null, or points to as many bytes as its Size
/// gives, and at least to a Size.
pub(super) unsafe fn fill<T>(
    out: *mut T,
    name: &'static str,
    least: usize,
    read: impl FnOnce(&Hand) -> Result<T, HandError>,
) -> Result<(), Refusal> {
    // SAFETY: the contract of this function.
    let size = unsafe { size_given(out, name) }?;
    let whole = default_hand::with(|hand| {
        refuse_below(size, name, least)?;
        Ok::<T, Refusal>(read(hand)?)
    })?;
    // SAFETY: the contract of this function, and `out` is not null.
    unsafe { copy_out(whole, out, size) };
    Ok(())
}

/// Fills a struct of the caller with the next of several values, if there is one. Returns whether there was one.
/// `source` finds the place from which `next` takes the value. Nothing is taken if Size is too small. Otherwise like
/// [`fill`].
///
/// # Safety
/// As for [`fill`].
pub(super) unsafe fn fill_next<T, S>(
    out: *mut T,
    name: &'static str,
    least: usize,
    source: impl FnOnce() -> Result<S, Refusal>,
    next: impl FnOnce(S) -> Option<T>,
) -> Result<bool, Refusal> {
    // SAFETY: the contract of this function.
    let size = unsafe { size_given(out, name) }?;
    let source = source()?;
    refuse_below(size, name, least)?;
    let Some(whole) = next(source) else { return Ok(false) };
    // SAFETY: the contract of this function, and `out` is not null.
    unsafe { copy_out(whole, out, size) };
    Ok(true)
}

/// Returns the Size of a struct of the caller.
///
/// # Safety
/// `out` is null, or points to at least a Size.
unsafe fn size_given<T>(out: *mut T, name: &'static str) -> Result<usize, Refusal> {
    // The type name contains the path of its module.
    let of_type = type_name::<T>().rsplit("::").next().unwrap_or_default();
    non_null(out, name, Wanted::Struct(of_type))?;
    // SAFETY: `out` is not null, as checked above. By the contract its first member exists; the others may not.
    Ok(unsafe { out.cast::<c_uint>().read_unaligned() } as usize)
}

fn refuse_below(size: usize, name: &'static str, least: usize) -> Result<(), Refusal> {
    if size < least { Err(Refusal::SmallStruct { name, size, least }) } else { Ok(()) }
}

/// Copies a struct to the caller, up to `size` bytes.
///
/// # Safety
/// `T` is `repr(C)` and begins with a Size of type `c_uint`. `out` points to `size` bytes.
unsafe fn copy_out<T>(mut whole: T, out: *mut T, size: usize) {
    let filled = size.min(size_of::<T>());
    let from = (&raw mut whole).cast::<u8>();
    // SAFETY: `whole` begins with its Size. `filled` exceeds neither the caller's room nor the size of `whole`.
    unsafe {
        from.cast::<c_uint>().write(filled as c_uint);
        from.copy_to_nonoverlapping(out.cast(), filled);
    }
}

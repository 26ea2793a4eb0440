//! What a call reads from the caller's memory and writes there.

use crate::capi::default_hand;
use crate::capi::refusal::{Refusal, Wanted};
use crate::hand::{Hand, HandError};
use std::any::type_name;
use std::ffi::c_uint;

pub(super) fn non_null<T>(pointer: *const T, name: &'static str, wanted: Wanted) -> Result<(), Refusal> {
    if pointer.is_null() { Err(Refusal::Null { name, wanted }) } else { Ok(()) }
}

/// Copies an array of the caller's. Unaligned, because a planner may keep it in a
/// packed message.
///
/// # Safety
/// `array` is null or points to `N` entries.
pub(super) unsafe fn load<T, const N: usize>(array: *const T, name: &'static str) -> Result<[T; N], Refusal> {
    non_null(array, name, Wanted::Array(N))?;
    // SAFETY: not null, and `N` entries by the contract of this function.
    Ok(unsafe { array.cast::<[T; N]>().read_unaligned() })
}

/// Copies a matrix of the caller's, row by row, as [`load`] copies an array.
///
/// # Safety
/// `matrix` is null or points to three rows of three entries.
pub(super) unsafe fn load_rows<T>(matrix: *const T, name: &'static str) -> Result<[[T; 3]; 3], Refusal> {
    non_null(matrix, name, Wanted::Array(9))?;
    // SAFETY: not null, and nine entries by the contract of this function.
    Ok(unsafe { matrix.cast::<[[T; 3]; 3]>().read_unaligned() })
}

/// The size of a struct up to and with a member: the smallest that a program can have been compiled with, where that
/// member was the last of the first version.
macro_rules! size_up_to {
    ($Struct:ty, $Member:ident: $Type:ty) => {
        std::mem::offset_of!($Struct, $Member) + size_of::<$Type>()
    };
}
pub(super) use size_up_to;

/// Fills a struct of the caller's with what the open hand tells: at most as much as its first member, Size, says that
/// there is room for, and leaves in Size how much that is. `least`: see [`size_up_to`].
///
/// # Safety
/// `T` is `repr(C)` and begins with a Size of type `c_uint`. `out` is null, or points to a Size and to as many bytes as
/// that says.
pub(super) unsafe fn fill<T>(
    out: *mut T,
    name: &'static str,
    least: usize,
    tell: impl FnOnce(&Hand) -> Result<T, HandError>,
) -> Result<(), Refusal> {
    // With the path of its module in front.
    let of_type = type_name::<T>().rsplit("::").next().unwrap_or_default();
    non_null(out, name, Wanted::Struct(of_type))?;
    // SAFETY: not null; the first member is there by the contract. Only it: a program may have less room.
    let size = unsafe { out.cast::<c_uint>().read_unaligned() } as usize;
    let mut whole = default_hand::with(|hand| match size < least {
        true => Err(Refusal::SmallStruct { name, size, least }),
        false => Ok(tell(hand)?),
    })?;
    let filled = size.min(size_of::<T>());
    let from = (&raw mut whole).cast::<u8>();
    // SAFETY: `whole` begins with its Size; `filled` is at most the caller's room and at most the size of `whole`.
    unsafe {
        from.cast::<c_uint>().write(filled as c_uint);
        from.copy_to_nonoverlapping(out.cast(), filled);
    }
    Ok(())
}

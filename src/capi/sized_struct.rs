//! Structs of the caller that begin with their size, so that later versions of the library can add members at the end.
//! `size` is the size of the struct in the header with which the caller was compiled. A size below that of this
//! library's struct is refused. No older program has such a size, because no struct has gained a member yet. If the
//! size is larger, the program was compiled with a newer header: the members that this library does not know are set to
//! zero in a result, and ignored in an argument.

use crate::capi::hand_table;
use crate::capi::handle::Handle;
use crate::capi::memory::non_null;
use crate::capi::refusal::{Refusal, Wanted};
use crate::capi::remote_hand::{RemoteHand, RemoteRefusal};
use crate::hand::{Hand, HandError};
use std::any::type_name;
use std::ffi::c_int;

/// Upper bound of the size of a struct in any version, bytes. A larger size means that the caller has not set it.
const LARGEST: usize = 4096;

/// A struct of the caller.
pub(super) struct SizedStruct<T> {
    place: *mut T,
    size: usize,
    name: &'static str,
}

impl<T: Copy> SizedStruct<T> {
    /// Reads the size. It is checked later, because a call reports other reasons first.
    ///
    /// # Safety
    /// `T` is `repr(C)` and begins with a size of type `usize`. `place` is null, or points to memory that begins with
    /// such a size and has at least as many bytes as it says. This memory stays valid while the result exists.
    pub unsafe fn new(place: *const T, name: &'static str) -> Result<Self, Refusal> {
        // The type name contains the path of its module.
        let of_type = type_name::<T>().rsplit("::").next().unwrap_or_default();
        non_null(place, name, Wanted::Struct(of_type))?;
        // SAFETY: `place` is not null, as checked above. By the contract its first member exists. Other members may be
        // missing.
        let size = unsafe { place.cast::<usize>().read_unaligned() };
        Ok(Self { place: place.cast_mut(), size, name })
    }

    /// Reads the first struct of an array of `count` structs. Refuses a `count` below 1, then a null pointer, then a
    /// wrong size, then a `count` above `most`. Returns the first struct and the number of structs.
    ///
    /// # Safety
    /// As for [`Self::new`], if `count` is positive.
    pub unsafe fn array(
        place: *const T,
        name: &'static str,
        count: c_int,
        most: usize,
        wrong_number: impl Fn() -> HandError,
    ) -> Result<(Self, usize), Refusal> {
        let number = usize::try_from(count).unwrap_or(0);
        if number == 0 {
            // There is no first struct from which a size could be read.
            return Err(wrong_number().into());
        }
        // SAFETY: the contract of this function.
        let first = unsafe { Self::new(place, name) }?;
        first.check()?;
        if number > most { Err(wrong_number().into()) } else { Ok((first, number)) }
    }

    /// Refuses a size that is too small, or that was not set.
    pub fn check(&self) -> Result<(), Refusal> {
        let Self { size, name, .. } = *self;
        let least = size_of::<T>();
        if (least..=LARGEST).contains(&size) { Ok(()) } else { Err(Refusal::WrongSize { name, size, least }) }
    }

    /// Copies one struct of an array. `self` is the first struct of the array, and `index` selects the copied one.
    ///
    /// # Safety
    /// [`Self::check`] has succeeded, and the array has this index.
    pub unsafe fn load(&self, index: usize) -> T {
        // SAFETY: the contracts of this function and of `new`. The caller may keep the struct in a packed message.
        unsafe { self.place.byte_add(index * self.size).read_unaligned() }
    }

    /// Writes all members except `size`.
    ///
    /// # Safety
    /// [`Self::check`] has succeeded, and the caller may write to the struct.
    unsafe fn write(self, value: T) {
        let rest = self.size - size_of::<T>();
        let size_member = size_of::<usize>();
        // SAFETY: the contracts of this function and of `new`: the memory has `size` bytes, at least as many as `T`,
        // and `T` begins with the member `size`.
        unsafe {
            let from = (&raw const value).cast::<u8>().add(size_member);
            let to = self.place.cast::<u8>();
            from.copy_to_nonoverlapping(to.add(size_member), size_of::<T>() - size_member);
            to.add(size_of::<T>()).write_bytes(0, rest);
        }
    }
}

/// Fills a struct of the caller.
///
/// # Safety
/// As for [`SizedStruct::new`], and the caller may write to the struct.
pub(super) unsafe fn fill<T: Copy>(
    out: *mut T,
    name: &'static str,
    read: impl FnOnce() -> Result<T, Refusal>,
) -> Result<(), Refusal> {
    // SAFETY: the contract of this function, here and below.
    let out = unsafe { SizedStruct::new(out, name) }?;
    out.check()?;
    let value = read()?;
    unsafe { out.write(value) };
    Ok(())
}

/// Fills a struct of the caller with values of a hand, which is on this machine or on another one.
///
/// # Safety
/// As for [`fill`].
pub(super) unsafe fn fill_from_either<T: Copy>(
    handle: Handle,
    out: *mut T,
    name: &'static str,
    local: impl FnOnce(&Hand) -> Result<T, HandError>,
    remote: impl FnOnce(&dyn RemoteHand) -> Result<T, RemoteRefusal>,
) -> Result<(), Refusal> {
    // SAFETY: the contract of this function, here and below.
    let out = unsafe { SizedStruct::new(out, name) }?;
    let local = |hand: &Hand| out.check().and_then(|()| Ok::<T, Refusal>(local(hand)?));
    let remote = |hand: &dyn RemoteHand| out.check().and_then(|()| Ok::<T, Refusal>(remote(hand)?));
    let value = hand_table::with_either(handle, local, remote)?;
    unsafe { out.write(value) };
    Ok(())
}

/// Fills a struct of the caller with values of a hand on this machine.
///
/// # Safety
/// As for [`fill`].
pub(super) unsafe fn fill_from<T: Copy>(
    handle: Handle,
    out: *mut T,
    name: &'static str,
    read: impl FnOnce(&Hand) -> Result<T, HandError>,
) -> Result<(), Refusal> {
    // SAFETY: the contract of this function, here and below.
    let out = unsafe { SizedStruct::new(out, name) }?;
    let value = hand_table::with(handle, |hand| {
        out.check()?;
        Ok::<T, Refusal>(read(hand)?)
    })?;
    unsafe { out.write(value) };
    Ok(())
}

/// Fills a struct of the caller with the next of several values, if there is one. Returns whether there was one.
/// `source` finds the place from which `next` takes the value. Nothing is taken if the size is wrong.
///
/// # Safety
/// As for [`fill`].
pub(super) unsafe fn fill_next<T: Copy, S>(
    out: *mut T,
    name: &'static str,
    source: impl FnOnce() -> Result<S, Refusal>,
    next: impl FnOnce(S) -> Result<Option<T>, Refusal>,
) -> Result<bool, Refusal> {
    // SAFETY: the contract of this function, here and below.
    let out = unsafe { SizedStruct::new(out, name) }?;
    let source = source()?;
    out.check()?;
    let Some(value) = next(source)? else { return Ok(false) };
    unsafe { out.write(value) };
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Old {
        size: usize,
        value: u64,
    }

    #[repr(C)]
    struct New {
        size: usize,
        value: u64,
        later: u64,
    }

    fn filled(out: *mut Old) -> Result<(), Refusal> {
        // SAFETY: every caller passes a struct with its true size, or one that is refused.
        unsafe { fill(out, "out", || Ok(Old { size: 0, value: 5 })) }
    }

    #[test]
    fn members_of_a_newer_program_are_zero_and_sizes_that_were_not_set_are_refused() {
        let mut new = New { size: size_of::<New>(), value: 1, later: 2 };
        filled((&raw mut new).cast()).expect("a larger struct is filled");
        assert_eq!((new.size, new.value, new.later), (size_of::<New>(), 5, 0));
        for size in [0, size_of::<Old>() - 1, usize::MAX] {
            let mut old = Old { size, value: 1 };
            assert!(matches!(filled(&mut old), Err(Refusal::WrongSize { .. })));
            assert_eq!(old, Old { size, value: 1 });
        }
        assert!(matches!(filled(std::ptr::null_mut()), Err(Refusal::Null { .. })));
    }
}

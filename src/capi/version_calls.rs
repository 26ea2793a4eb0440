//! The versions of the library. The doc comments are the C manual, as in `calls.rs`.

use crate::capi::boundary::uncancelled;
use std::ffi::{CStr, c_char, c_uint};

/// This number rises only when programs must be compiled again.
pub const SUN2XP_ABI_VERSION: c_uint = 0;

/// The version, ended by a zero byte.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");

/// sun2xp_version - the version of the library that runs
///
/// Returns a text such as "0.1.0", which stays valid. SUN2XP_VERSION is the version of the header.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_version() -> *const c_char {
    uncancelled(|| CStr::from_bytes_with_nul(VERSION.as_bytes()).unwrap_or_default().as_ptr())
}

/// sun2xp_version_number - the version as a number that increases with each version
///
/// Returns 10000 times the major, plus 100 times the minor, plus the patch number.
/// SUN2XP_VERSION_NUMBER is the same number for the header.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_version_number() -> c_uint {
    uncancelled(version_number)
}

/// sun2xp_abi_version - the number of the binary interface
///
/// A program must not use the library if this number differs from the program's SUN2XP_ABI_VERSION. The number is part
/// of the name of the shared library, so only a program that loads the library by dlopen needs this comparison.
///
/// Threads: any. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn sun2xp_abi_version() -> c_uint {
    uncancelled(|| SUN2XP_ABI_VERSION)
}

pub(super) fn version_number() -> c_uint {
    let parts = env!("CARGO_PKG_VERSION").split(['.', '-', '+']).take(3);
    parts.fold(0, |number, part| number * 100 + part.parse::<c_uint>().unwrap_or(0))
}

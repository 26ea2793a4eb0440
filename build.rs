//! Names the shared library and keeps it loaded. The header is not made here: it is committed, and `tests/header.rs`
//! compares it with the exports.

/// Rises when a program built against an older library must be compiled again; not with each release.
const ABI: u32 = 0;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Without a soname a program that is linked by path remembers the path of the build.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libsun2xp.so.{ABI}");
    // Servo threads run in the library's code: dlclose must not unmap it.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
}

//! Names the shared library and keeps it loaded. The header is not generated here: it is committed, and
//! `tests/header/main.rs` compares it with the exports.

/// ABI number. It rises only when programs built with an older library must be compiled again, and not with each
/// release.
const ABI: u32 = 0;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    // Without a soname, a program that is linked by path stores the path of the build.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libsun2xp.so.{ABI}");
    // Servo threads run code of the library, so dlclose must not unmap it.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
}

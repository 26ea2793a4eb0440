//! Names the shared library, keeps it loaded and makes it small. The header is not generated here: it is committed, and
//! `tests/header/main.rs` compares it with the exports.

use std::env;
use std::ffi::CStr;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// ABI number. It rises only when programs built with an older library must be compiled again, and not with each
/// release.
const ABI: u32 = 0;

/// The smallest crate that rustc can build into a shared library.
const EMPTY: &str = "#![no_std]\n#[panic_handler]\nfn panicked(_: &core::panic::PanicInfo) -> ! {\n    loop {}\n}\n";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=RUSTFLAGS");
    println!("cargo::rerun-if-env-changed=CARGO_ENCODED_RUSTFLAGS");
    // If the library had no soname, a program that is linked with the path of the library would store this path, which
    // is in the folder of the build.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-soname,libsun2xp.so.{ABI}");
    // Servo threads run code of the library, so dlclose must not unmap it.
    println!("cargo::rustc-cdylib-link-arg=-Wl,-z,nodelete");
    if env::var("PROFILE").as_deref() != Ok("release") {
        return;
    }
    // Equal functions are stored once.
    let icf = "-Wl,--icf=all";
    // The relative relocations for the loader are stored as a bit map (DT_RELR).
    let packed = "-Wl,-z,pack-relative-relocs";
    for argument in [Some(icf), loader_unpacks().then_some(packed)].into_iter().flatten() {
        if linker_accepts(argument) {
            println!("cargo::rustc-cdylib-link-arg={argument}");
        }
    }
}

/// Whether the loader of the C library supports packed relative relocations (DT_RELR). The loader of glibc supports
/// them from version 2.36 on. A library for another target is not packed.
fn loader_unpacks() -> bool {
    let native = env::var("TARGET").is_ok_and(|target| Ok(target) == env::var("HOST"));
    native && glibc().is_some_and(|version| version >= (2, 36))
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn glibc() -> Option<(u32, u32)> {
    unsafe extern "C" {
        safe fn gnu_get_libc_version() -> *const std::ffi::c_char;
    }
    // SAFETY: the function returns a text of the C library that does not change.
    let version = unsafe { CStr::from_ptr(gnu_get_libc_version()) }.to_str().ok()?;
    let (major, minor) = version.split_once('.')?;
    Some((major.parse().ok()?, minor.split('.').next()?.parse().ok()?))
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn glibc() -> Option<(u32, u32)> {
    None
}

/// Whether the linker that rustc uses accepts an argument. Not every linker knows every argument.
fn linker_accepts(argument: &str) -> bool {
    let variable = |name| env::var(name).unwrap_or_default();
    let folder = PathBuf::from(variable("OUT_DIR"));
    let source = folder.join("empty.rs");
    if fs::write(&source, EMPTY).is_err() {
        return false;
    }
    let mut rustc = Command::new(variable("RUSTC"));
    rustc.args(["--crate-type=cdylib", "-Cpanic=abort", "--target", &variable("TARGET")]);
    rustc.args(variable("CARGO_ENCODED_RUSTFLAGS").split('\x1f').filter(|flag| !flag.is_empty()));
    if let Ok(linker) = env::var("RUSTC_LINKER") {
        rustc.arg(format!("-Clinker={linker}"));
    }
    rustc.arg(format!("-Clink-arg={argument}")).arg("-o").arg(folder.join("empty.so")).arg(source);
    rustc.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

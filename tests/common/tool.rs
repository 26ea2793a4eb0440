//! The tool `sun2xp` is a package of its own. Each test program of the library builds it at most once, in the same way
//! as cargo builds it for the tool's own tests.

#[path = "cargo.rs"]
mod cargo;

use cargo::cargo;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Builds the tool if it is out of date, and returns its path.
pub fn tool() -> &'static Path {
    static TOOL: OnceLock<PathBuf> = OnceLock::new();
    TOOL.get_or_init(|| {
        let test = std::env::current_exe().expect("the test has a path");
        // Test programs are in `deps` of the profile's folder.
        let folder = test.parent().and_then(Path::parent).expect("the profile's folder");
        let mut cargo = cargo();
        cargo.args(["build", "--quiet", "--locked", "--manifest-path"]);
        cargo.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"));
        match std::env::var_os("CI") {
            // tests/run has built the whole workspace. `--example spring` makes Cargo select the same features as for
            // `cargo test --workspace`, so the tool is up to date.
            Some(_) => cargo.args(["--workspace", "--bin", "sun2xp", "--example", "spring"]),
            None => cargo.args(["--package", "sun2xp-tool"]),
        };
        cargo.arg("--target-dir").arg(folder.parent().expect("the target folder"));
        if folder.ends_with("release") {
            cargo.arg("--release");
        }
        assert!(cargo.status().expect("cargo runs").success(), "cargo has not built the tool: see its messages");
        folder.join("sun2xp")
    })
}

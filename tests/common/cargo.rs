//! Cargo, called by a test.

use std::process::Command;

/// Returns a command that runs cargo.
pub fn cargo() -> Command {
    let mut cargo = Command::new(env!("CARGO"));
    without_package(&mut cargo);
    cargo
}

/// Removes the variables in which cargo describes the package of this test. The build script of `ring` depends on them.
/// With these variables, cargo would recompile `ring` and everything that uses `ring`, and would do so once more when
/// the tests are built the next time.
pub fn without_package(command: &mut Command) {
    for (name, _) in std::env::vars_os() {
        let text = name.to_string_lossy();
        if text.starts_with("CARGO_MANIFEST_") || text.starts_with("CARGO_PKG_") || text == "OUT_DIR" {
            command.env_remove(&name);
        }
    }
}

//! The paths of the source folder and of the build folder may contain spaces.

#[allow(dead_code)]
#[path = "common/tools.rs"]
mod tools;

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// A program in place of cargo and of maturin. It prints the flags for rustc, one on each line, as cargo splits them.
const CARGO: &str = "#!/bin/sh
if [ -n \"${CARGO_ENCODED_RUSTFLAGS+set}\" ]; then
    printf '%s\\n' \"$CARGO_ENCODED_RUSTFLAGS\" | tr '\\037' '\\n'
else
    printf '%s\\n' ${RUSTFLAGS-}
fi
";

/// A part of the source in a folder with a space in its name.
struct Source {
    folder: TempDir,
    root: PathBuf,
    /// Lets the tests take turns. Otherwise a process that another test starts could have the program of this test open
    /// for writing, and the system would refuse to execute the program (ETXTBSY).
    _turn: MutexGuard<'static, ()>,
}

impl Source {
    fn new() -> Self {
        static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let folder = tempfile::tempdir().expect("a folder");
        let root = fs::canonicalize(folder.path()).expect("the folder exists").join("a source");
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        for name in ["packaging", "c_examples"] {
            fs::create_dir_all(root.join(name)).expect("a folder");
        }
        for script in fs::read_dir(here.join("packaging")).expect("the folder exists") {
            let script = script.expect("an entry");
            fs::copy(script.path(), root.join("packaging").join(script.file_name())).expect("a copy");
        }
        for file in ["Makefile", "c_examples/Makefile"] {
            fs::copy(here.join(file), root.join(file)).expect("a copy");
        }
        let cargo = folder.path().join("cargo");
        fs::write(&cargo, CARGO).expect("a program");
        fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).expect("executable");
        Self { folder, root, _turn: turn }
    }

    /// Runs a program that finds [`CARGO`] in place of cargo and of maturin. Returns whether the program succeeded, and
    /// what it printed.
    fn run(&self, command: &mut Command) -> (bool, String) {
        let path = std::env::var("PATH").unwrap_or_default();
        command.env("PATH", format!("{}:{path}", self.folder.path().display())).env("HOME", self.folder.path());
        command.env("MATURIN", self.folder.path().join("cargo")).env("RUSTFLAGS", "-C target-cpu=native");
        for name in ["BUILT", "CARGO_ENCODED_RUSTFLAGS", "CARGO_HOME", "MAKEFLAGS", "PROFILE"] {
            command.env_remove(name);
        }
        let run = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
        let said = [run.stdout, run.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
        (run.status.success(), said)
    }
}

#[test]
fn a_build_passes_whole_flags_to_the_compiler() {
    let source = Source::new();
    for (script, name) in
        [("build-library", "sun2xp"), ("build", "sun2xp"), ("build-remote", "sun2xp"), ("wheel", "/sun2xp")]
    {
        let mut build = Command::new(source.root.join("packaging").join(script));
        // The scripts miss what cargo would have built, so most of them fail at their ends.
        let (_, said) = source.run(build.env_remove("CARGO_TARGET_DIR"));
        let mapped = format!("--remap-path-prefix={}={name}", source.root.display());
        for flag in ["-C", "target-cpu=native", mapped.as_str()] {
            assert!(said.lines().any(|line| line == flag), "{script}: {flag} is missing in\n{said}");
        }
    }
}

#[test]
fn make_clean_removes_nothing_but_what_was_built() {
    if !tools::available("make", "make clean") {
        return;
    }
    let source = Source::new();
    let (other, target) = (source.folder.path().join("my"), source.folder.path().join("my target"));
    fs::create_dir_all(&other).expect("a folder");
    fs::create_dir_all(target.join("dist/man")).expect("a folder");
    let mut clean = Command::new("make");
    let (done, said) = source.run(clean.arg("-C").arg(&source.root).arg("clean").env("CARGO_TARGET_DIR", &target));
    assert!(done, "{said}");
    assert!(other.exists() && target.exists() && !target.join("dist").exists(), "{said}");
}

#[test]
fn the_examples_are_linked_to_the_library_of_the_source() {
    if !tools::available("make", "links of the examples") {
        return;
    }
    let source = Source::new();
    let examples = source.root.join("c_examples");
    for target in [None, Some(source.root.join("my target"))] {
        let mut links = Command::new("make");
        links.arg("-C").arg(&examples).arg("links").env_remove("CARGO_TARGET_DIR");
        if let Some(target) = &target {
            links.env("CARGO_TARGET_DIR", target);
        }
        let (done, said) = source.run(&mut links);
        assert!(done, "{said}");
        let built = target.unwrap_or_else(|| source.root.join("target")).join("release");
        for (link, file) in [("build/sun2xp", "sun2xp"), ("build/lib/libsun2xp.so.0", "libsun2xp.so")] {
            assert_eq!(fs::read_link(examples.join(link)).expect("a link"), built.join(file));
        }
    }
}

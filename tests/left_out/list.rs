//! The list of skipped tests at the end of `cargo test`: tests/zz_left_out.rs.

use crate::{said, turn};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// The program that prints the list.
const LIST: &str = "zz_left_out";

/// The lines that declare the program, without its path.
const DECLARATION: &str = "[[test]]\nname = \"zz_left_out\"\nharness = false\n";

/// A test program whose only test skips a part, because a tool is missing.
fn skipping(part: &str) -> String {
    format!(
        "#[path = \"common/tools.rs\"]\n#[allow(dead_code)]\nmod tools;\n\n#[test]\nfn needs_a_tool() {{\n    \
         assert!(!tools::available(\"no-such-tool\", \"{part}\"));\n}}\n"
    )
}

/// A package with the program that prints the list, and with tests that skip something.
fn package() -> TempDir {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let copy = |name: &str| fs::read_to_string(Path::new(ROOT).join(name)).expect("a source file");
    for (name, text) in [
        (
            "Cargo.toml",
            format!(
                "[package]\nname = \"bare\"\nedition = \"2024\"\n\n[lib]\ndoctest = false\n\n{DECLARATION}\n\
                 [workspace]\n"
            ),
        ),
        ("src/lib.rs", "#[test]\nfn passes() {}\n".into()),
        ("tests/alpha.rs", skipping("a part")),
        ("tests/zulu.rs", skipping("another part")),
        ("tests/zz_left_out.rs", copy("tests/zz_left_out.rs")),
        ("tests/common/tools.rs", copy("tests/common/tools.rs")),
        ("tests/tools.txt", "no-such-tool | its-package | false\n".into()),
        ("tests/requirements.txt", String::new()),
    ] {
        let file = folder.path().join(name);
        fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
        fs::write(file, text).expect("written");
    }
    folder
}

/// Runs `cargo test` in a package. Returns what the test programs print.
fn cargo_test(package: &Path, arguments: &[&str]) -> String {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["test", "--offline", "--target-dir"]).arg(package.join("target")).args(arguments);
    let run = cargo.current_dir(package).env_remove("CI").output().expect("cargo starts");
    assert!(run.status.success(), "{}", said(&run));
    String::from_utf8_lossy(&run.stdout).into_owned()
}

#[test]
fn the_list_is_the_last_output_of_cargo_test() {
    let _turn = turn();
    let package = package();
    let printed = cargo_test(package.path(), &[]);
    assert_eq!(printed.matches("test result: ok. 1 passed").count(), 3, "{printed}");
    let reason = "no-such-tool is missing (apt-get install --no-install-recommends its-package)";
    let list = format!(
        "\nSkipped in bare (tests/run installs missing tools):\n\n    alpha, needs_a_tool, a part: {reason}\n    zulu, \
         needs_a_tool, another part: {reason}\n\n"
    );
    assert!(printed.ends_with(&list), "{printed}");

    // Arguments for the test programs do not disable the list. It has nothing of the earlier run.
    let printed = cargo_test(package.path(), &["no_test_has_this_name"]);
    assert!(printed.ends_with("\nNo test of bare was skipped.\n\n"), "{printed}");
}

/// The test programs of a package: files and folders in its folder `tests`.
fn test_programs(package: &Path) -> Vec<String> {
    let entries = fs::read_dir(package.join("tests")).expect("a folder").map(|entry| entry.expect("an entry").path());
    let is_program = |path: &PathBuf| path.extension().is_some_and(|end| end == "rs") || path.join("main.rs").is_file();
    let name = |path: PathBuf| path.file_stem().expect("a name").to_string_lossy().into_owned();
    entries.filter(is_program).map(name).collect()
}

#[test]
fn the_list_is_the_last_program_of_the_library_and_of_the_tool() {
    for name in ["", "tool"] {
        let package = Path::new(ROOT).join(name);
        let manifest = fs::read_to_string(package.join("Cargo.toml")).expect("the manifest");
        let declared = manifest.replace("path = \"../tests/zz_left_out.rs\"\n", "");
        assert!(declared.contains(DECLARATION), "{}/Cargo.toml must have\n{DECLARATION}", package.display());
        let programs = test_programs(&package);
        assert!(programs.len() > 10, "{programs:?}");
        let later: Vec<_> = programs.iter().filter(|program| program.as_str() > LIST).collect();
        assert!(later.is_empty(), "cargo runs {later:?} after {LIST}. Choose names that come before it");
    }
}

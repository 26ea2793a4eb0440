//! libsun2xp_remote.so exports the same symbols as libsun2xp.so. It also has the same SONAME, by which programs find
//! libsun2xp.so.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn built(name: &str) -> PathBuf {
    let library = std::env::current_exe().expect("the test has a path").with_file_name(name);
    assert!(library.exists(), "{} is missing: cargo test builds it", library.display());
    library
}

fn said(command: &mut Command) -> String {
    let run = command.output().expect("the program runs");
    assert!(run.status.success(), "{command:?}: {}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8(run.stdout).expect("text")
}

fn exported(library: &Path) -> BTreeSet<String> {
    let listing = said(Command::new("nm").args(["-D", "--defined-only"]).arg(library));
    listing.lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect()
}

#[test]
fn both_libraries_export_the_same_names() {
    let (local, remote) = (exported(&built("libsun2xp.so")), exported(&built("libsun2xp_remote.so")));
    assert!(local.contains("OpenHand") && local.contains("sun2xp_zero"), "{local:?}");
    assert_eq!(local, remote);
    let listed = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/abi/symbols"));
    assert_eq!(remote.into_iter().collect::<Vec<_>>(), listed.expect("the list").lines().collect::<Vec<_>>());
}

#[test]
fn the_library_calls_none_of_its_own_names_through_the_loader() {
    // In a process that has also loaded libsun2xp, the loader would bind such a call to the function of libsun2xp.
    let remote = built("libsun2xp_remote.so");
    let relocations = said(Command::new("readelf").args(["-r", "-W"]).arg(&remote));
    let words: BTreeSet<&str> = relocations.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect();
    assert!(words.contains("pthread_create") || words.contains("memcpy"), "{relocations}");
    for name in exported(&remote) {
        assert!(!words.contains(name.as_str()), "{name}");
    }
}

/// The loader accepts libsun2xp_remote in place of libsun2xp, and dlclose unmaps neither of them.
#[test]
fn both_libraries_have_one_name_and_stay_loaded() {
    let lines = |name: &str| -> Vec<String> {
        let sections = said(Command::new("readelf").args(["-d", "-W"]).arg(built(name)));
        let wanted = sections.lines().filter(|line| line.contains("(SONAME)") || line.contains("(FLAGS_1)"));
        wanted.map(|line| line.split_once(')').expect("a tag").1.trim().to_owned()).collect()
    };
    let local = lines("libsun2xp.so");
    assert!(local.iter().any(|line| line.contains("libsun2xp.so.0")), "{local:?}");
    assert!(local.iter().any(|line| line.contains("NODELETE")), "{local:?}");
    assert_eq!(local, lines("libsun2xp_remote.so"));
}

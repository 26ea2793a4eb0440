//! The list of the licences of other people's code is complete.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace")
}

/// The crates that are linked into these packages of the workspace.
fn linked(packages: &[&str]) -> BTreeSet<String> {
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}"]);
    tree.args(["--target", "x86_64-unknown-linux-gnu", "--manifest-path"]).arg(root().join("Cargo.toml"));
    tree.args(packages.iter().flat_map(|package| ["--package", package]));
    let tree = tree.output().expect("cargo runs");
    assert!(tree.status.success(), "{tree:?}");
    let tree = String::from_utf8(tree.stdout).expect("names");
    // A line is a name and a version such as v1.0.0, and sometimes remarks. The packages of the workspace are not
    // third-party. A crate that the workspace replaces by its own copy is third-party.
    tree.lines()
        .filter(|line| !line.starts_with("sun2xp"))
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some(format!("{} {}", words.next()?, words.next()?.strip_prefix('v')?))
        })
        .collect()
}

/// The crates of a list.
fn listed(file: &str) -> BTreeSet<String> {
    let list = std::fs::read_to_string(root().join("packaging").join(file)).expect("the list");
    let lines = list.lines().skip(2).take_while(|line| !line.is_empty());
    lines.filter_map(|line| line.split_once(':').map(|(name, _)| name.to_owned())).collect()
}

#[test]
fn every_crate_that_is_linked_has_its_licence_in_the_list() {
    let linked = linked(&["sun2xp", "sun2xp-tool", "sun2xp-python"]);
    assert!(linked.len() > 100, "{linked:?}");
    assert_eq!(
        linked,
        listed("third-party-licences.txt"),
        "run packaging/licences.py, and look at the licences of new crates"
    );
}

#[test]
fn the_other_crates_of_the_remote_service_are_in_a_second_list() {
    let local = linked(&["sun2xp", "sun2xp-tool", "sun2xp-python"]);
    let remote = linked(&["sun2xp-serve", "sun2xp-remote-library"]);
    let others: BTreeSet<String> = remote.difference(&local).cloned().collect();
    assert!(others.iter().any(|name| name.starts_with("zenoh ")), "{others:?}");
    assert_eq!(
        others,
        listed("third-party-licences-remote.txt"),
        "run packaging/licences.py, and look at the licences of new crates"
    );
}

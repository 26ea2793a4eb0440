//! The list of the licences of other people's code is complete.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

#[test]
fn every_crate_that_is_linked_has_its_licence_in_the_list() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let mut tree = Command::new(env!("CARGO"));
    tree.args(["tree", "--locked", "--edges", "normal", "--prefix", "none", "--format", "{p}", "--package", "sun2xp"]);
    tree.args([
        "--package",
        "sun2xp-tool",
        "--package",
        "sun2xp-python",
        "--target",
        "x86_64-unknown-linux-gnu",
        "--manifest-path",
    ]);
    let tree = tree.arg(root.join("Cargo.toml")).output().expect("cargo runs");
    assert!(tree.status.success(), "{tree:?}");
    let tree = String::from_utf8(tree.stdout).expect("names");
    // A line is a name and a version such as v1.0.0, and sometimes remarks. A package of the workspace has its path.
    let linked: BTreeSet<String> = tree
        .lines()
        .filter(|line| !line.contains("(/"))
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some(format!("{} {}", words.next()?, words.next()?.strip_prefix('v')?))
        })
        .collect();
    assert!(linked.len() > 100, "{linked:?}");

    let list = std::fs::read_to_string(root.join("packaging/third-party-licences.txt")).expect("the list");
    let listed: BTreeSet<String> = list
        .lines()
        .skip(2)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_once(':').map(|(name, _)| name.to_owned()))
        .collect();
    assert_eq!(linked, listed, "run packaging/licences.py, and look at the licences of new crates");
}

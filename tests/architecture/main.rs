//! The architecture that docs/architecture.md shows: imports run downward only, and no circle hides behind a
//! re-export.

mod circles;
mod crate_tree;
mod imports;

use crate_tree::CrateTree;
use std::collections::BTreeSet;
use std::path::Path;

/// The folders of the library from the top down. A file imports from its own folder and from lower ones.
const FLOORS: [&[&str]; 9] = [
    &["capi"],
    &["hand"],
    &["finger"],
    &["calibration", "simulated", "stability"],
    &["board", "control"],
    &["plant"],
    &["realtime"],
    &["files"],
    &["model"],
];

fn library() -> CrateTree {
    CrateTree::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"))
}

#[test]
fn every_folder_has_a_floor() {
    let tree = library();
    let folders: BTreeSet<&str> = tree.files().filter_map(|file| file.module.first().map(String::as_str)).collect();
    assert_eq!(folders, FLOORS.concat().into_iter().collect());
}

#[test]
fn imports_run_downward() {
    let floor = |folder: &str| FLOORS.iter().position(|floor| floor.contains(&folder)).expect("it has a floor");
    let upward: Vec<String> = imports::all(&library())
        .into_iter()
        .filter_map(|import| {
            let (from, to) = (import.from.split("::").next()?, import.to.split("::").next()?);
            let allowed = from.is_empty() || to.is_empty() || from == to || floor(from) < floor(to);
            (!allowed).then(|| import.to_string())
        })
        .collect();
    assert!(upward.is_empty(), "imports that do not run downward:\n{}", upward.join("\n"));
}

#[test]
fn no_files_import_each_other_in_a_circle() {
    let found = circles::find(&imports::all(&library()));
    assert!(found.is_empty(), "circles of files:\n{}", found.join("\n\n"));
}

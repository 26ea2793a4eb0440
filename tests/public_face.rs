//! The public face of the crate: few names without the feature `internals`, and an example that runs.

use std::path::Path;
use syn::{Item, UseTree, Visibility};

/// Largest number of names that the crate exports without the feature `internals`.
const NAMES: usize = 60;

/// Largest number of names that a public module of one topic exports.
const NAMES_OF_TOPIC: usize = 15;

/// The names that an item of a topic's module exports.
fn names_of_topic(item: &Item) -> usize {
    match item {
        Item::Use(item) => names(&item.tree),
        _ => panic!("a module of a topic only re-exports names"),
    }
}

fn names(tree: &UseTree) -> usize {
    match tree {
        UseTree::Path(path) => names(&path.tree),
        UseTree::Group(group) => group.items.iter().map(names).sum(),
        UseTree::Name(_) | UseTree::Rename(_) => 1,
        UseTree::Glob(_) => panic!("what a glob exports cannot be counted"),
    }
}

#[test]
fn the_face_is_small() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lib.rs");
    let syntax = syn::parse_file(&std::fs::read_to_string(path).expect("the crate's page")).expect("Rust");
    let exported = syntax.items.iter().map(|item| match item {
        Item::Use(item) if matches!(item.vis, Visibility::Public(_)) => names(&item.tree),
        // A module with a file of its own is public only with the feature. A module in the file re-exports the names of
        // one topic.
        Item::Mod(item) if matches!(item.vis, Visibility::Public(_)) => {
            match &item.content {
                None => assert!(
                    item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg")),
                    "{} is exported",
                    item.ident
                ),
                Some((_, items)) => {
                    let exported: usize = items.iter().map(names_of_topic).sum();
                    assert!((1..=NAMES_OF_TOPIC).contains(&exported), "{}: {exported} names", item.ident);
                }
            }
            0
        }
        _ => 0,
    });
    let exported: usize = exported.sum();
    assert!((20..=NAMES).contains(&exported), "{exported} names");
}

mod spring {
    include!("../examples/spring.rs");

    pub fn run() -> Result<(), Box<dyn Error>> {
        main()
    }
}

#[test]
fn the_example_of_the_crate_page_runs() {
    spring::run().expect("the simulated hand moves");
}

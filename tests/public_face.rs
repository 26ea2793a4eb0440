//! The public face of the crate: few names without the feature `internals`, and an example that runs.

use std::path::Path;
use syn::{Item, UseTree, Visibility};

/// Largest number of names that the crate exports without the feature `internals`.
const NAMES: usize = 60;

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
        // A module is public only with the feature.
        Item::Mod(item) if matches!(item.vis, Visibility::Public(_)) => {
            assert!(item.attrs.iter().any(|attribute| attribute.path().is_ident("cfg")), "{} is exported", item.ident);
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
